#include "jobs/sphere_light.h"

#include "kernel/gauss.h"

#include <algorithm>
#include <cmath>
#include <umov/scene/pose.h>

namespace umov::jobs {

std::optional<SphereLight> sphere_light(const Surface &surface, std::size_t band,
                                        double phase_rad) {
  if (surface.is_anisotropic())
    return {};
  const double half = phase_rad / 2, l_v = std::cos(phase_rad);
  const Vec3<Facet> l{std::sin(half), 0, std::cos(half)}, v{-l.x, 0, l.z};
  const FresnelFactors f =
      surface.material().measured ? FresnelFactors{} : surface.fresnel(band, l_v);
  const double mirror = surface.mirror_part(band, std::cos(half));
  SphereLight out{mirror * f.a / 4, mirror * f.b / 4};
  constexpr int azimuths = 32;
  const auto ring = [&](double theta) { // normals at an angle from the bisector
    SphereLight sum;
    for (int j = 0; j < azimuths / 2; ++j) { // symmetric about the plane of Sun and observer
      const double phi = 2 * pi * (j + 0.5) / azimuths;
      const Vec3<Facet> n{std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi),
                          std::cos(theta)};
      const double n_l = dot(n, l), n_v = dot(n, v);
      if (!(n_l > 0 && n_v > 0))
        continue;
      const SurfaceDirections at = directions_from_cosines(n_l, n_v, l_v);
      const double w = surface.has_mirror() ? 0 : surface.specular(band, at);
      const auto s = surface.diffuse(band, at, {1, 0, 0, 0});
      sum.i += (f.a * w + s.i) * 2 * (2 * pi / azimuths);
      sum.q += (f.b * w + s.q) * 2 * (2 * pi / azimuths);
    }
    return sum;
  };
  double from = 0; // panels grow away from the lobe's peak
  for (double to = std::clamp(surface.half_width_rad(), 1e-4, 0.3); from < pi / 2;
       to = std::min(2.2 * to, pi / 2)) {
    const auto &rule = gauss_rule<12>();
    for (std::size_t k = 0; k < rule.x.size(); ++k) {
      const double theta = 0.5 * (from + to) + 0.5 * (to - from) * rule.x[k];
      const double weight = 0.5 * (to - from) * rule.w[k] * std::sin(theta);
      const SphereLight light = ring(theta);
      out.i += weight * light.i;
      out.q += weight * light.q;
    }
    from = to;
  }
  return out;
}

} // namespace umov::jobs
