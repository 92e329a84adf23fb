// Orbit ephemeris messages, KVN and XML, and the orbits that they hold.

#include "fuzz/ccsds.h"

#include <umov/io/trajectory_file.h>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
  using namespace umov;
  if (const auto message = fuzz::message_of(fuzz::text_of(data, size), ccsds::Kind::Oem))
    fuzz::is_read(ephemeris_from_oem(*message));
  return 0;
}
