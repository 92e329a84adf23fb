#pragma once
#include <memory>
#include <string>
#include <umov/core/quantity.h>
#include <umov/core/result.h>
#include <umov/optics/passband.h>
#include <vector>

namespace umov {

/// A band as the scenario spells it: one wavelength ("nm:550"), or a curve ("Bessell.V").
struct Band {
  std::string name;
  Wavelength wavelength;                           ///< of a curve the effective one in sunlight
  std::shared_ptr<const Passband> curve = nullptr; ///< null: one wavelength
};

/// Some of the bands have a curve.
bool has_curve(const std::vector<Band> &bands);

/// A band of a curve. BadInput outside the solar spectrum.
Result<Band> band_of(Passband curve);

/// Bands of a scenario's `set` without curves: "paper_rgb" (nm:425, nm:550, nm:650: Table 1 of the
/// paper) or a list of "nm:NUMBER". Anything else is BadInput with the forms that are known.
Result<std::vector<Band>> bands_from(const std::vector<std::string> &set);
/// BadInput where a name stands twice or there is no band.
Result<void> check_band_set(const std::vector<Band> &bands);

/// Solar spectral irradiance at 1 au [W m-2 nm-1] (ASTM E490-00a, linear between its points);
/// outside the table BadInput.
Result<double> solar_irradiance(Wavelength wavelength);
/// The same for a band: the photon-weighted mean of a curve.
Result<double> solar_irradiance(const Band &band);
/// `zero_irradiance` of its curve; of one wavelength AB and ST alone, else BadInput.
Result<double> zero_irradiance(const Band &band, MagnitudeSystem system);

} // namespace umov
