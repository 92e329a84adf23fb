#pragma once
// Axes of polarized beams between surfaces.

#include <cmath>
#include <umov/core/quantity.h>
#include <umov/core/vec3.h>
#include <umov/optics/stokes.h>

namespace umov {

/// Axis +Q of a beam that leaves towards `out` and came from direction `in`: the normal of the
/// plane.
inline Vec3<Body> plane_normal(Vec3<Body> out, Vec3<Body> in) {
  const Vec3<Body> s = cross(out, in);
  return norm(s) > 1e-14 ? normalized(s) : any_perpendicular(out);
}

/// Light that travels along k, from axes s to axes t.
inline Stokes<ScatteringPlane> turned(const Stokes<ScatteringPlane> &light, Vec3<Body> s,
                                      Vec3<Body> t, Vec3<Body> k) {
  return rotate_to<ScatteringPlane>(light,
                                    Angle::radians(std::atan2(dot(t, cross(k, s)), dot(t, s))));
}

} // namespace umov
