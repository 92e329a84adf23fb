// Stars of a field (CSV, ECSV): what is accepted stands somewhere on the sky.

#include "fuzz/target.h"

#include <umov/io/stars_file.h>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
  using namespace umov;
  Diagnostics diagnostics;
  const auto read = read_stars_text(fuzz::text_of(data, size), "input", diagnostics);
  if (!fuzz::is_read(read))
    return 0;
  for (const FieldStar &star : *read) {
    fuzz::require(star.ra_deg >= 0 && star.ra_deg <= 360, "a right ascension");
    fuzz::require(star.dec_deg >= -90 && star.dec_deg <= 90, "a declination");
    fuzz::require(star.mag >= -30 && star.mag <= 40, "a magnitude");
  }
  return 0;
}
