// Calibrations of polarimeters (TOML): what is accepted is written and read again as the same.

#include "fuzz/target.h"

#include <umov/io/calibration_file.h>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
  using namespace umov;
  const auto read = read_calibration_text(std::string(fuzz::text_of(data, size)), "input");
  if (!fuzz::is_read(read))
    return 0;
  fuzz::require(read->calibration || read->photometry, "it tells something");
  fuzz::require(!read->calibration || std::abs(read->calibration->factor) > 0,
                "it can be taken out");
  fuzz::must(read_calibration_text(calibration_as_toml(*read), "input"), "we read what we write");
  return 0;
}
