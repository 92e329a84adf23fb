// A site by name or by numbers.

#include "fuzz/target.h"

#include <umov/io/sites.h>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
  using namespace umov;
  fuzz::is_read(site_from(std::string(fuzz::text_of(data, size))));
  return 0;
}
