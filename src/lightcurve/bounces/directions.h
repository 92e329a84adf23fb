#pragma once
// How paths choose where to go at a surface.

#include <algorithm>
#include <cmath>
#include <umov/surface/surface.h>

namespace umov {

/// A direction and how likely it was drawn.
struct Direction {
  Vec3<Body> to{};
  double density = 0; ///< [1/sr]; of a mirror's one direction, its probability
  bool is_by_mirror = false;
};

inline Vec3<Body> mirrored(Vec3<Body> direction, Vec3<Body> normal) {
  return normalized(normal * (2 * dot(direction, normal)) - direction);
}

/// How directions are drawn at a surface: the one of a mirror, Lambert's cosine, or the mirror
/// image about a normal drawn from a lobe as wide as the surface's.
struct Sampler {
  double mirror_share; ///< 0 without a mirror, 1 of a mirror alone
  double cosine_share, exponent;
  explicit Sampler(const Surface &surface) {
    const Distribution *normals = surface.normals(0);
    const bool has_lobe = normals != nullptr && !normals->is_mirror();
    const bool has_more = has_lobe || surface.has_diffuse();
    mirror_share = surface.has_mirror() ? (has_more ? 0.5 : 1) : 0;
    const double slope = has_lobe ? std::clamp(normals->width(), 1e-3, 1.0) : 1;
    exponent = std::clamp(1 / (slope * slope) - 2, 0.0, 1e6);
    cosine_share = !has_lobe ? 1 : surface.has_diffuse() ? 0.5 : 0.2;
  }
  [[nodiscard]] bool is_mirror() const { return mirror_share == 1; }
  [[nodiscard]] double density(Vec3<Body> normal, Vec3<Body> from, Vec3<Body> to) const {
    const double cosine = dot(normal, to);
    if (!(cosine > 0))
      return 0;
    const Vec3<Body> sum = from + to;
    const double length = norm(sum);
    double lobe = 0;
    if (length > 1e-12) {
      const double n_h = dot(normal, sum) / length, f_h = dot(from, sum) / length;
      if (n_h > 0 && f_h > 0)
        lobe = (exponent + 1) / (2 * pi) * std::pow(n_h, exponent) / (4 * f_h);
    }
    return (1 - mirror_share) * (cosine_share * cosine / pi + (1 - cosine_share) * lobe);
  }
  [[nodiscard]] Direction draw(Vec3<Body> normal, Vec3<Body> from, double choice, double u,
                               double v) const {
    if (choice < mirror_share)
      return {mirrored(from, normal), mirror_share, true};
    choice = (choice - mirror_share) / (1 - mirror_share);
    const Vec3<Body> x = any_perpendicular(normal), y = cross(normal, x);
    const double azimuth = 2 * pi * v;
    const auto about_normal = [&](double c) {
      const double s = std::sqrt(std::max(0.0, 1 - c * c));
      return normal * c + x * (s * std::cos(azimuth)) + y * (s * std::sin(azimuth));
    };
    Vec3<Body> to;
    if (choice < cosine_share) {
      to = about_normal(std::sqrt(u));
    } else {
      const Vec3<Body> h = about_normal(std::pow(u, 1 / (exponent + 1)));
      to = mirrored(from, h);
    }
    return {to, density(normal, from, to)};
  }
};

} // namespace umov
