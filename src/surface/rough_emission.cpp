#include <umov/surface/rough_emission.h>

#include "kernel/gauss.h"

#include <algorithm>
#include <cmath>

namespace umov {

Emissivity rough_emissivity(const Surface &surface, std::size_t band, double theta_rad) {
  const Stokes<ScatteringPlane> sunlight{1, 0, 0, 0};
  double i = 0, q = 0;
  // Over microfacet normals in the frame of the surface: dw_l = 4 (h.v) dw_h, as smooth as D.
  const double reach = std::min(pi / 2, 9 * std::max(surface.width(), 1e-6));
  const double c_v = std::cos(theta_rad), s_v = std::sin(theta_rad);
  const auto term = [&](double tilt, double phi, double &sum_i, double &sum_q, double weight) {
    const double s = std::sin(tilt), c = std::cos(tilt);
    const Vec3<Facet> v{s_v, 0, c_v}, h{s * std::cos(phi), s * std::sin(phi), c};
    const double h_v = dot(h, v);
    const Vec3<Facet> l = 2 * h_v * h - v;
    if (h_v <= 0 || l.z <= 0)
      return;
    SurfaceDirections at{l, v, std::min(1.0, 2 * h_v * h_v - 1), 0};
    const FresnelFactors f = surface.fresnel(band, at.l_v);
    // specular = w (n.l)(n.v): divided by n.v it is M (n.l) without Fresnel.
    const double w = surface.specular(band, at) / c_v * 4 * h_v * s * weight;
    sum_i += f.a * w;
    // From s of the scattering plane, v x l, to s = n x v of the emission plane, as v sees them.
    const Vec3<Facet> plane = cross(v, l), wanted{0, 1, 0}; // n x v for v in the xz plane
    const double size = norm(plane);
    if (size < 1e-12)
      return;
    const double cosine = dot(plane, wanted) / size;
    sum_q += f.b * w * (2 * cosine * cosine - 1);
  };
  const double inner = std::min({reach, (pi / 2 - theta_rad) / 2});
  const auto panel = [&](double from, double to) {
    if (!(to > from))
      return;
    const auto &rule = gauss_rule<48>();
    constexpr int azimuths = 128;
    for (std::size_t k = 0; k < rule.x.size(); ++k) {
      const double tilt = 0.5 * (from + to) + 0.5 * (to - from) * rule.x[k];
      for (int j = 0; j < azimuths; ++j)
        term(tilt, 2 * pi * (j + 0.5) / azimuths, i, q,
             rule.w[k] * 0.5 * (to - from) * 2 * pi / azimuths);
    }
  };
  panel(0, inner);
  panel(inner, reach);
  // Diffuse lobes over the hemisphere: unpolarized or p-polarized about n x v.
  double diffuse_i = 0, diffuse_q = 0;
  if (surface.has_diffuse()) {
    const auto &rule = gauss_rule<32>();
    constexpr int azimuths = 32;
    for (std::size_t k = 0; k < rule.x.size(); ++k)
      for (int j = 0; j < azimuths; ++j) {
        const double theta = pi / 4 * (1 + rule.x[k]), phi = 2 * pi * (j + 0.5) / azimuths;
        SurfaceDirections at = directions_from_angles(theta, theta_rad, -phi, phi);
        const auto s = surface.diffuse(band, at, sunlight);
        const double w = rule.w[k] * pi / 4 * 2 * pi / azimuths * std::sin(theta) / c_v;
        diffuse_i += s.i * w;
        const Vec3<Facet> plane = cross(at.v, at.l), wanted{0, 1, 0};
        const double size = norm(plane);
        if (size < 1e-12)
          continue;
        const double cosine = dot(plane, wanted) / size;
        const double sine = dot(cross(plane, wanted), at.v) / size;
        // Q' = Q cos 2x + U sin 2x with x from the old axis to the new, seen along -k.
        diffuse_q += w * (s.q * (2 * cosine * cosine - 1) + s.u * 2 * cosine * sine);
      }
  }
  // What leaves as from a mirror is not in the lobe: it needs a source with a size.
  const double share = surface.clear_share() * surface.mirror_part(band, c_v);
  const Emissivity smooth =
      share > 0 ? smooth_emissivity(surface.interface(band), c_v) : Emissivity{};
  return {1 - i - diffuse_i - share * (1 - smooth.i), -q - diffuse_q + share * smooth.q};
}

} // namespace umov
