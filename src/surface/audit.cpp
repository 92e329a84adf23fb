#include <umov/surface/audit.h>

#include "kernel/gauss.h"

#include <algorithm>
#include <cmath>
#include <umov/core/random.h>
#include <umov/optics/realisable.h>

namespace umov {
namespace {

constexpr std::uint32_t stream_of_audit = 0x61756474; // "audt"

Vec3<Facet> direction(double u, double w) {
  const double s = std::sqrt((1 - u) * (1 + u));
  return {s * std::cos(2 * pi * w), s * std::sin(2 * pi * w), u};
}

/// int of the diffuse light over all directions of the observer, per unit irradiance on the
/// surface.
double diffuse_albedo(const Surface &surface, std::size_t band, double theta) {
  double sum = 0;
  constexpr int azimuths = 16;
  for (int j = 0; j < azimuths; ++j) {
    const double phi = 2 * pi * (j + 0.5) / azimuths;
    // In sqrt(mu), where albedos are smooth at grazing.
    sum += gauss_integral<48>(0, 1, [&](double root) {
      const double mu = root * root;
      SurfaceDirections at = directions_from_angles(theta, std::acos(mu), phi);
      return 2 * root * surface.diffuse(band, at, {1, 0, 0, 0}).i;
    });
  }
  return sum * 2 * pi / azimuths / std::cos(theta);
}

void look_at_pair(const Surface &surface, std::size_t band, Vec3<Facet> l, Vec3<Facet> v,
                  SurfaceAudit &out) {
  const double l_v = std::clamp(dot(l, v), -1.0, 1.0);
  const auto there = surface.brdf(band, {l, v, l_v, 0}).m,
             back = surface.brdf(band, {v, l, l_v, 0}).m;
  const double scale = there[0][0];
  // Deep in the tail of a narrow lobe numbers are denormal and have few digits left.
  if (!(scale > 1e-280))
    return;
  for (std::size_t r = 0; r < 4; ++r)
    for (std::size_t c = 0; c < 4; ++c) {
      const double sign = (r == 2) != (c == 2) ? -1 : 1;
      out.reciprocity =
          std::max(out.reciprocity, std::abs(back[r][c] - sign * there[c][r]) / scale);
    }
  out.cloude_min = std::min(out.cloude_min, cloude_eigenvalues(there)[0] / scale);
  out.polarization_max =
      std::max(out.polarization_max, std::hypot(there[1][0], there[2][0]) / scale);
}

} // namespace

bool SurfaceAudit::is_fine() const {
  return reciprocity <= 1e-12 && cloude_min >= -1e-9 && albedo_max <= 1 + 1e-4 &&
         (!promises_energy || energy_gap <= 1e-3);
}

SurfaceAudit audit_surface(const Surface &surface, std::uint64_t geometries, std::uint64_t seed) {
  SurfaceAudit out;
  const Material &material = surface.material();
  out.promises_energy = !material.measured && surface.has_diffuse();
  for (std::size_t b = 0; b < surface.band_count(); ++b) {
    for (std::uint64_t i = 0; i < geometries; ++i) {
      const auto u = uniform4(seed, stream_of_audit, i);
      look_at_pair(surface, b, direction(u[0], u[1]), direction(u[2], u[3]), out);
    }
    for (const double deg : {0., 20., 40., 60., 75., 85., 89.}) {
      const double theta = deg * pi / 180;
      for (const double azimuth : {0., 0.8, pi / 2}) {
        const Vec3<Facet> k{std::sin(theta) * std::cos(azimuth),
                            std::sin(theta) * std::sin(azimuth), std::cos(theta)};
        out.albedo_max = std::max(out.albedo_max, surface.albedo(b, k));
        if (out.promises_energy && azimuth == 0)
          out.energy_gap = std::max(
              out.energy_gap, std::abs(diffuse_albedo(surface, b, theta) -
                                       (surface.albedo(b, k) - surface.specular_albedo(b, k))));
        if (!surface.is_anisotropic())
          break;
      }
    }
  }
  return out;
}

} // namespace umov
