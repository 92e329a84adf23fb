#pragma once
#include <umov/core/quantity.h>
#include <umov/core/vec3.h>

namespace umov {

/// Linear polarization of the clear sky in a direction.
struct SkyPolarization {
  double degree = 0; ///< >= 0
  Angle axis;        ///< from the zenith direction, counter-clockwise as seen, [0, 180) deg
};

/// Unit vector of a direction over the horizon; azimuth from north through east.
Vec3<Enu> horizontal_direction(Angle azimuth, Angle altitude);

/// Single scattering by air (depolarization 0.0279: Young 1980, Appl. Opt. 19, 3427) of light of
/// `source`, times `dilution` for what is scattered more often. The axis is the normal of the plane
/// of source, sky and observer: for the Sun the very plane in which an object at that place
/// scatters, so that an error of the sky looks like a property of the object.
SkyPolarization scattered_sky(Vec3<Enu> to_source, Vec3<Enu> to_sky, double dilution);

} // namespace umov
