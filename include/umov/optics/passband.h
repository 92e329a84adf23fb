#pragma once
// Bands with a width: a response over wavelengths and the zero points that belong to it
// (docs/theory/bands.md).

#include <string>
#include <umov/core/result.h>
#include <vector>

namespace umov {

/// Values at increasing wavelengths, linear in between.
struct Spectrum {
  std::vector<double> wavelength_nm, value;
};
/// Value at a wavelength; 0 outside.
double value_at(const Spectrum &spectrum, double wavelength_nm);

/// Solar spectral irradiance at 1 au [W m-2 nm-1] (ASTM E490-00a).
const Spectrum &sunlight();

/// What a curve multiplies: the rate of photons, or the power of the light.
enum class DetectorKind { Photon, Energy };

/// Response of a detector behind a filter to photons (whatever the file's convention was), at
/// increasing wavelengths, linear in between and 0 outside.
struct Passband {
  std::string name;
  std::vector<double> wavelength_nm, response;
  /// Spectral irradiance of magnitude 0 in the Vega system [W m-2 nm-1]; 0: none is known.
  double vega_zero = 0;
  std::string vega_source; ///< of that number
  std::string source;      ///< of the curve
  bool operator==(const Passband &) const = default;
};

/// A passband from a curve: checked, one of an energy detector divided by wavelength (Eq. 1), with
/// at most one zero kept at either end. BadInput for a single point, wavelengths that do not
/// increase, and a response below 0, above 1.5, that is none or is 0 everywhere.
Result<Passband> make_passband(std::string name, std::vector<double> wavelength_nm,
                               std::vector<double> response, DetectorKind kind);

/// A Gaussian by its full width at half maximum, sampled every fortieth of it out to 1.25 widths
/// on both sides (response .013 there).
Passband gaussian_passband(std::string name, double centre_nm, double full_width_nm);

/// The band behind something that lets a part of the light through (a filter, the air, a quantum
/// efficiency), on the points of both; 0 outside either.
Passband multiplied(const Passband &band, const Spectrum &transmission);

/// Pivot wavelength [nm] (Eq. 5).
double pivot_nm(const Passband &band);

/// A spectrum through a band.
struct BandMean {
  double value = 0;        ///< photon-weighted mean of the spectrum (Eq. 2)
  double effective_nm = 0; ///< mean wavelength of the detected photons (Eq. 5)
  double spread_nm = 0;    ///< standard deviation of their wavelengths
};
/// BadInput where the spectrum does not cover the band; `what` names it in the message.
Result<BandMean> mean_in(const Passband &band, const Spectrum &spectrum, const std::string &what);
/// The same for sunlight at 1 au [W m-2 nm-1].
Result<BandMean> sunlight_in(const Passband &band);

/// Zero of a magnitude scale.
enum class MagnitudeSystem { AB, ST, Vega };
/// "AB", "ST" or "Vega".
const char *name_of(MagnitudeSystem system);

/// Photon-weighted mean irradiance of magnitude 0 [W m-2 nm-1] (Eq. 3 and 4). BadInput for Vega
/// where the band has no such number.
Result<double> zero_irradiance(const Passband &band, MagnitudeSystem system);
/// Photons of AB magnitude 0 that a detector of unit area counts [s-1 m-2].
double ab_zero_photons(const Passband &band);

} // namespace umov
