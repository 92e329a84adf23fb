// Tables of standard stars (CSV, ECSV): what is accepted is physical.

#include "fuzz/target.h"

#include <umov/io/standards_file.h>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
  using namespace umov;
  const auto read = read_standards_text(fuzz::text_of(data, size), "input");
  if (!fuzz::is_read(read))
    return 0;
  for (const StandardStar &star : *read)
    fuzz::require(!(star.p < 0 || star.p > 1), "a degree of polarization");
  return 0;
}
