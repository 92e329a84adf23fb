#pragma once
// From the object's intensity to what arrives at the observer.

#include <umov/core/quantity.h>
#include <umov/core/result.h>
#include <umov/optics/band.h>
#include <vector>

namespace umov {

/// A band as magnitudes need it.
struct PhotometricBand {
  Band band;
  MagnitudeSystem system = MagnitudeSystem::AB;
  double solar = 0; ///< irradiance at 1 au [W m-2 nm-1], the photon-weighted mean of a curve
  double zero = 0;  ///< irradiance of magnitude 0 [W m-2 nm-1]
};
/// The bands of a magnitude system. BadInput outside the solar spectrum, and where a band has no
/// zero in the system.
Result<std::vector<PhotometricBand>> photometric_bands(const std::vector<Band> &bands,
                                                       MagnitudeSystem system);
/// Magnitude of a spectral irradiance [W m-2 nm-1], the photon-weighted mean of a curve. NaN where
/// it is not positive.
double magnitude_of(double irradiance, const PhotometricBand &band);

/// Spectral irradiance at the observer [W m-2 nm-1] of an object with `intensity` [m2/sr] per unit
/// solar irradiance: E_sun (1 au / d)^2 sunlit J / range^2.
/// solar_irradiance: at 1 au [W m-2 nm-1]; sun_distance_km: Sun to object; range_km > 0.
double irradiance_at_observer(double intensity, double solar_irradiance, double sun_distance_km,
                              double sunlit, double range_km);

/// AB magnitude of a spectral irradiance [W m-2 nm-1]: -2.5 log10(f_nu / 3631 Jy) (Oke & Gunn
/// 1983). NaN where the irradiance is not positive.
double ab_magnitude(double irradiance, Wavelength wavelength);

/// Fainter than this a magnitude is given as a limit: no telescope tells such light from none, and
/// what a model gives there is the far tail of a lobe.
constexpr double faintest_magnitude = 30;

/// What arrives at an observer in one band.
struct ObservedLight {
  double irradiance = 0; ///< [W m-2 nm-1] above the atmosphere
  double magnitude = 0;  ///< of the band's system; NaN where the irradiance is not positive
};

/// How far the light has come, and how much of the Sun there was.
struct LightPath {
  double sun_distance_km = 0; ///< Sun to object
  double range_km = 0;        ///< object to observer, > 0
  double sunlit = 1;          ///< sunlight at the object in parts of that outside all shadows
};

/// Intensity [m2/sr] of an object in a band as irradiance and magnitude at the observer, by
/// `irradiance_at_observer` and `magnitude_of`.
ObservedLight observed_light(double intensity, const PhotometricBand &band, const LightPath &path);

/// Relative air mass at an altitude above the horizon (Kasten & Young 1989, Eq. 3); NaN below it.
double airmass(Angle altitude);

} // namespace umov
