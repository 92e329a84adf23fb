#pragma once
#include <umov/core/quantity.h>

namespace umov {

/// Sunlight at an object near the edge of the Earth's shadow, in parts of that outside it, with
/// refraction, spreading and Rayleigh extinction in a clear exponential atmosphere (Link 1969,
/// Eclipse Phenomena in Astronomy, chapter 2; no ozone, no clouds or dust). Surface brightness
/// along a ray is kept but for extinction, so each apparent height above the limb is asked where on
/// the Sun it comes from. sun_radius: angular, of the disk; limb_radius_km, distance_km: of the
/// Earth at the limb and of the object from its centre; sun_from_nadir: angle between the Sun's and
/// the Earth's centre.
double refracted_sunlight(Angle sun_radius, double limb_radius_km, double distance_km,
                          Angle sun_from_nadir, Wavelength wavelength);

} // namespace umov
