// Attitude ephemeris messages, KVN and XML, and the attitudes that they hold.

#include "fuzz/ccsds.h"

#include <umov/io/attitude_file.h>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
  using namespace umov;
  const std::string_view text = fuzz::text_of(data, size);
  Diagnostics diagnostics;
  fuzz::is_read(read_attitude_table(text, "input", diagnostics));
  fuzz::message_of(text, ccsds::Kind::Aem);
  return 0;
}
