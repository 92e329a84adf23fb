// Instruments (TOML): what is accepted is written and read again as the same.

#include "fuzz/target.h"

#include <umov/io/observation.h>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
  using namespace umov;
  const auto read = read_instrument_text(std::string(fuzz::text_of(data, size)), "input.toml");
  if (!fuzz::is_read(read))
    return 0;
  const std::string text = instrument_as_toml(*read);
  const auto again = fuzz::must(read_instrument_text(text, "input.toml"), "we read what we write");
  fuzz::require(instrument_as_toml(again) == text, "an instrument comes back as it was");
  return 0;
}
