#pragma once
// Directions on the sky.

#include <umov/core/quantity.h>
#include <umov/core/vec3.h>

namespace umov {

/// A direction among the stars, GCRS axes.
struct SkyDirection {
  Angle right_ascension; ///< [0, 360) deg
  Angle declination;
};
/// Of a non-zero vector.
SkyDirection sky_direction(Vec3<Gcrs> v);
/// Unit vector towards a direction.
Vec3<Gcrs> unit_vector(SkyDirection direction);

/// Position angle [0, 180) deg of the axis `s` as seen by the observer, from `north` through east.
/// v: unit vector from the object to the observer. N = north - (north.v) v, E = v x N, angle =
/// atan2(s.E, s.N): counter-clockwise on the sky (IAU 1973). If v is parallel to `north`, any fixed
/// axis serves for N.
Angle position_angle(Vec3<Gcrs> s, Vec3<Gcrs> north, Vec3<Gcrs> v);

/// Normal of the scattering plane (v x l)/|v x l|; where the plane is undefined (phase 0 or 180)
/// any fixed perpendicular of v.
Vec3<Gcrs> scattering_normal(Vec3<Gcrs> v, Vec3<Gcrs> l);

} // namespace umov
