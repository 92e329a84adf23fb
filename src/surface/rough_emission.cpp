#include <umov/surface/rough_emission.h>

#include "kernel/gauss.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace umov {

namespace {

/// Sums of what a surface reflects of light from all directions: I, and Q to s = n x v.
struct Reflected {
  double i = 0, q = 0;
};

/// A microfacet whose normal has a tilt and an azimuth. dw_l = 4 (h.v) dw_h, as smooth as D.
void add_facet(const Surface &surface, std::size_t band, const Vec3<Facet> &v, double tilt,
               double phi, double weight, Reflected &sum) {
  const double s = std::sin(tilt), c = std::cos(tilt);
  const Vec3<Facet> h{s * std::cos(phi), s * std::sin(phi), c};
  const double h_v = dot(h, v);
  const Vec3<Facet> l = 2 * h_v * h - v;
  if (h_v <= 0 || l.z <= 0)
    return;
  SurfaceDirections at{l, v, std::min(1.0, 2 * h_v * h_v - 1), 0};
  const FresnelFactors f = surface.fresnel(band, at.l_v);
  // specular = w (n.l)(n.v): divided by n.v it is M (n.l) without Fresnel.
  const double w = surface.specular(band, at) / v.z * 4 * h_v * s * weight;
  sum.i += f.a * w;
  // From s of the scattering plane, v x l, to s = n x v of the emission plane, as v sees them.
  const Vec3<Facet> plane = cross(v, l), wanted{0, 1, 0}; // n x v for v in the xz plane
  const double size = norm(plane);
  if (size < 1e-12)
    return;
  const double cosine = dot(plane, wanted) / size;
  sum.q += f.b * w * (2 * cosine * cosine - 1);
}

/// The specular lobe, over microfacet normals in the frame of the surface.
Reflected lobe_sum(const Surface &surface, std::size_t band, double theta_rad) {
  const double reach = std::min(pi / 2, 9 * std::max(surface.width(), 1e-6));
  const double inner = std::min({reach, (pi / 2 - theta_rad) / 2});
  const Vec3<Facet> v{std::sin(theta_rad), 0, std::cos(theta_rad)};
  Reflected out;
  for (const auto &[from, to] : {std::pair{0.0, inner}, std::pair{inner, reach}}) {
    if (!(to > from))
      continue;
    const auto &rule = gauss_rule<48>();
    constexpr int azimuths = 128;
    for (std::size_t k = 0; k < rule.x.size(); ++k) {
      const double tilt = 0.5 * (from + to) + 0.5 * (to - from) * rule.x[k];
      for (int j = 0; j < azimuths; ++j)
        add_facet(surface, band, v, tilt, 2 * pi * (j + 0.5) / azimuths,
                  rule.w[k] * 0.5 * (to - from) * 2 * pi / azimuths, out);
    }
  }
  return out;
}

/// Diffuse lobes over the hemisphere: unpolarized or p-polarized about n x v.
Reflected diffuse_sum(const Surface &surface, std::size_t band, double theta_rad) {
  Reflected out;
  if (!surface.has_diffuse())
    return out;
  const Stokes<ScatteringPlane> sunlight{1, 0, 0, 0};
  const double c_v = std::cos(theta_rad);
  const auto &rule = gauss_rule<32>();
  constexpr int azimuths = 32;
  for (std::size_t k = 0; k < rule.x.size(); ++k)
    for (int j = 0; j < azimuths; ++j) {
      const double theta = pi / 4 * (1 + rule.x[k]), phi = 2 * pi * (j + 0.5) / azimuths;
      SurfaceDirections at = directions_from_angles(theta, theta_rad, -phi, phi);
      const auto s = surface.diffuse(band, at, sunlight);
      const double w = rule.w[k] * pi / 4 * 2 * pi / azimuths * std::sin(theta) / c_v;
      out.i += s.i * w;
      const Vec3<Facet> plane = cross(at.v, at.l), wanted{0, 1, 0};
      const double size = norm(plane);
      if (size < 1e-12)
        continue;
      const double cosine = dot(plane, wanted) / size;
      const double sine = dot(cross(plane, wanted), at.v) / size;
      // Q' = Q cos 2x + U sin 2x with x from the old axis to the new, seen along -k.
      out.q += w * (s.q * (2 * cosine * cosine - 1) + s.u * 2 * cosine * sine);
    }
  return out;
}

} // namespace

Emissivity rough_emissivity(const Surface &surface, std::size_t band, double theta_rad) {
  const Reflected lobe = lobe_sum(surface, band, theta_rad),
                  diffuse = diffuse_sum(surface, band, theta_rad);
  // What leaves as from a mirror is not in the lobe: it needs a source with a size.
  const double c_v = std::cos(theta_rad);
  const double share = surface.clear_share() * surface.mirror_part(band, c_v);
  const Emissivity smooth =
      share > 0 ? smooth_emissivity(surface.interface(band), c_v) : Emissivity{};
  return {1 - lobe.i - diffuse.i - share * (1 - smooth.i), -lobe.q - diffuse.q + share * smooth.q};
}

} // namespace umov
