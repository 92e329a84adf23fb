#pragma once
// Private: the light of a sphere of one material, all lobes together.

#include <optional>
#include <umov/surface/surface.h>

namespace umov::jobs {

/// Intensity and Q [m2/sr] of a sphere of radius 1 m.
struct SphereLight {
  double i = 0, q = 0;
};
/// By quadrature over its normals, for a point Sun; empty for anisotropic surfaces, whose sphere
/// has no one curve.
std::optional<SphereLight> sphere_light(const Surface &surface, std::size_t band, double phase_rad);

} // namespace umov::jobs
