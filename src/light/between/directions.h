#pragma once
// How paths choose where to go at a surface.

#include "kernel/microfacet.inl.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <umov/surface/distribution.h>
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

/// At a cosine from a normal, a part v of a turn about it.
inline Vec3<Body> about(Vec3<Body> normal, double cosine, double v) {
  const Vec3<Body> x = any_perpendicular(normal), y = cross(normal, x);
  const double s = std::sqrt(std::max(0.0, 1 - cosine * cosine)), azimuth = 2 * pi * v;
  return normal * cosine + x * (s * std::cos(azimuth)) + y * (s * std::sin(azimuth));
}

/// Normals drawn in proportion to D(h) (n.h) of one of the forms that the facet kernels know.
struct NormalSampler {
  KernelForm form;
  /// [1/sr] of normals at a cosine from the mean one.
  [[nodiscard]] double density(double n_h) const {
    switch (form.kind) {
    case LobeKind::BlinnPhong:
      return kernel::blinn_phong(n_h, form.shape) * n_h;
    case LobeKind::Beckmann:
      return kernel::beckmann(n_h, form.shape) * n_h;
    case LobeKind::Ggx:
      break;
    }
    return kernel::ggx(n_h, form.shape) * n_h;
  }
  /// The cosine that a part u of them stays beyond (Walter et al. 2007, Eq. 28, 35).
  [[nodiscard]] double cosine(double u) const {
    const double a2 = form.shape * form.shape;
    switch (form.kind) {
    case LobeKind::BlinnPhong:
      return std::pow(1 - u, 1 / (form.shape + 2));
    case LobeKind::Beckmann:
      return 1 / std::sqrt(1 - a2 * std::log(1 - u));
    case LobeKind::Ggx:
      break;
    }
    return std::sqrt((1 - u) / (1 - u + a2 * u));
  }
};

/// That of a surface; of a distribution without such a form, a Gaussian as wide.
inline NormalSampler normal_sampler(const Distribution &normals) {
  const auto form = normals.kernel_form();
  const double slope = std::clamp(normals.width(), 1e-3, 1.0);
  return {form ? *form : KernelForm{LobeKind::Beckmann, slope * std::numbers::sqrt2}};
}

/// How directions are drawn at a surface: the one of a mirror, Lambert's cosine, or the mirror
/// image about a normal of the surface's lobe.
struct Sampler {
  double mirror_share; ///< 0 without a mirror, 1 of a mirror alone
  double cosine_share;
  NormalSampler normals{{LobeKind::BlinnPhong, 0}};
  explicit Sampler(const Surface &surface) {
    const Distribution *lobe = surface.normals(0);
    const bool has_lobe = lobe != nullptr && !lobe->is_mirror();
    const bool has_more = has_lobe || surface.has_diffuse();
    mirror_share = surface.has_mirror() ? (has_more ? 0.5 : 1) : 0;
    cosine_share = !has_lobe ? 1 : surface.has_diffuse() ? 0.5 : 0.1;
    if (has_lobe)
      normals = normal_sampler(*lobe);
  }
  [[nodiscard]] bool is_mirror() const { return mirror_share == 1; }
  [[nodiscard]] double density(Vec3<Body> normal, Vec3<Body> from, Vec3<Body> to) const {
    const double cosine = dot(normal, to);
    if (!(cosine > 0))
      return 0;
    const Vec3<Body> sum = from + to;
    const double length = norm(sum);
    double lobe = 0;
    if (cosine_share < 1 && length > 1e-12) {
      const double n_h = dot(normal, sum) / length, f_h = dot(from, sum) / length;
      if (n_h > 0 && f_h > 0)
        lobe = normals.density(std::min(n_h, 1.0)) / (4 * f_h);
    }
    return (1 - mirror_share) * (cosine_share * cosine / pi + (1 - cosine_share) * lobe);
  }
  [[nodiscard]] Direction draw(Vec3<Body> normal, Vec3<Body> from, double choice, double u,
                               double v) const {
    if (choice < mirror_share)
      return {mirrored(from, normal), mirror_share, true};
    choice = (choice - mirror_share) / (1 - mirror_share);
    const Vec3<Body> to = choice < cosine_share
                              ? about(normal, std::sqrt(u), v)
                              : mirrored(from, about(normal, normals.cosine(u), v));
    return {to, density(normal, from, to)};
  }
};

} // namespace umov
