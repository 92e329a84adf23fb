// Curves of bands: columns and VOTables. What is accepted has zero points and a grid of weights.

#include "fuzz/target.h"

#include <cmath>
#include <umov/io/passband_file.h>
#include <umov/optics/band_grid.h>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
  using namespace umov;
  const std::string text(fuzz::text_of(data, size));
  for (const PassbandForm &form : {PassbandForm{}, PassbandForm{"nm", DetectorKind::Photon}}) {
    const auto read = read_passband_text(text, "input", form);
    if (!fuzz::is_read(read))
      continue;
    fuzz::require(pivot_nm(*read) > 0, "a curve has a pivot wavelength");
    for (const MagnitudeSystem system :
         {MagnitudeSystem::AB, MagnitudeSystem::ST, MagnitudeSystem::Vega}) {
      const auto zero = zero_irradiance(*read, system);
      fuzz::require(!fuzz::is_read(zero) || *zero > 0, "a zero point is positive");
    }
    const auto band = band_of(*read);
    if (!fuzz::is_read(band))
      continue;
    const auto grid = BandGrid::make({*band});
    if (!fuzz::is_read(grid))
      continue;
    double sum = 0;
    for (const BandTerm &term : grid->terms()[0])
      sum += term.weight;
    fuzz::require(std::abs(sum - 1) < 1e-6, "the weights of a band add up to 1");
  }
  return 0;
}
