#pragma once
#include <string>
#include <umov/core/quantity.h>
#include <umov/core/result.h>
#include <vector>

namespace umov {

/// A monochromatic band, spelled as in the scenario ("nm:550").
struct Band {
  std::string name;
  Wavelength wavelength;
};

/// Bands of a scenario's `set`: "paper_rgb" (nm:425, nm:550, nm:650: Table 1 of the paper) or a
/// list of "nm:NUMBER". Anything else is BadInput with the forms that are known.
Result<std::vector<Band>> bands_from(const std::vector<std::string> &set);

/// Solar spectral irradiance at 1 au [W m-2 nm-1] (ASTM E490-00a, linear between its points);
/// outside the table BadInput.
Result<double> solar_irradiance(Wavelength wavelength);

} // namespace umov
