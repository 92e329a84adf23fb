#pragma once
// From the object's intensity to what arrives at the observer.

#include <umov/core/quantity.h>

namespace umov {

/// Spectral irradiance at the observer [W m-2 nm-1] of an object with `intensity` [m2/sr] per unit
/// solar irradiance: E_sun (1 au / d)^2 sunlit J / range^2.
/// solar_irradiance: at 1 au [W m-2 nm-1]; sun_distance_km: Sun to object; range_km > 0.
double irradiance_at_observer(double intensity, double solar_irradiance, double sun_distance_km,
                              double sunlit, double range_km);

/// AB magnitude of a spectral irradiance [W m-2 nm-1]: -2.5 log10(f_nu / 3631 Jy) (Oke & Gunn
/// 1983). NaN where the irradiance is not positive.
double ab_magnitude(double irradiance, Wavelength wavelength);

/// Relative air mass at an altitude above the horizon (Kasten & Young 1989, Eq. 3); NaN below it.
double airmass(Angle altitude);

} // namespace umov
