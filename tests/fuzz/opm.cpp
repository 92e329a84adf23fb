// Orbit parameter messages, KVN and XML, and the states that they hold.

#include "fuzz/ccsds.h"

#include <umov/io/trajectory_file.h>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
  using namespace umov;
  if (const auto message = fuzz::message_of(fuzz::text_of(data, size), ccsds::Kind::Opm))
    fuzz::is_read(state_from_opm(*message));
  return 0;
}
