// The mean of lobes over the Sun's disk against brute force, at every phase and width.

#include "kernel/disk_lobe.h"
#include "kernel/facet.inl.h"

#include <cmath>
#include <gtest/gtest.h>
#include <umov/core/quantity.h>
#include <umov/core/vec3.h>
#include <vector>

namespace umov {
namespace {

constexpr double degree = pi / 180, radius = 0.2665 * degree; // the Sun from 1 au

struct Lobe {
  LobeKind kind;
  double shape;
};

/// D, written anew.
double density(const Lobe &lobe, double n_h) {
  const double c2 = n_h * n_h, a2 = lobe.shape * lobe.shape;
  if (lobe.kind == LobeKind::BlinnPhong)
    return (lobe.shape + 2) / (2 * pi) * std::pow(n_h, lobe.shape);
  if (lobe.kind == LobeKind::Beckmann)
    return std::exp(-(1 - c2) / (c2 * a2)) / (pi * a2 * c2 * c2);
  return a2 / (pi * std::pow(1 - c2 + a2 * c2, 2));
}

/// Sun and observer in the x z plane, their half vector along z.
struct Plane {
  Vec3<Body> sun, observer;
  std::vector<Vec3<Body>> half; ///< of an even grid on the disk, rings of equal area
  explicit Plane(double phase)
      : sun{std::sin(phase / 2), 0, std::cos(phase / 2)}, observer{-sun.x, 0, sun.z} {
    constexpr int rings = 80, spokes = 160;
    const Vec3<Body> e2{0, 1, 0}, e1 = cross(e2, sun);
    for (int i = 0; i < rings; ++i)
      for (int k = 0; k < spokes; ++k) {
        const double r = std::sin(radius) * std::sqrt((i + 0.5) / rings),
                     at = 2 * pi * (k + 0.5 * (i % 2)) / spokes;
        half.push_back(normalized(std::sqrt(1 - r * r) * sun + r * std::cos(at) * e1 +
                                  r * std::sin(at) * e2 + observer));
      }
  }
  [[nodiscard]] double mean(const Lobe &lobe, Vec3<Body> n) const {
    double sum = 0;
    for (const Vec3<Body> &h : half)
      sum += density(lobe, dot(n, h));
    return sum / static_cast<double>(half.size());
  }
};

kernel::LobeConstants<double> constants(const Lobe &lobe) {
  kernel::LobeConstants<double> out;
  out.kind = lobe.kind;
  out.shape = lobe.shape;
  if (lobe.kind == LobeKind::BlinnPhong)
    out.peak = kernel::blinn_phong_peak(lobe.shape);
  return out;
}

double by_kernel(const Lobe &lobe, const Plane &plane, Vec3<Body> n) {
  const double l_v = dot(plane.sun, plane.observer), apart = norm(plane.sun - plane.observer);
  const kernel::DiskImage disk = kernel::disk_image(radius, l_v);
  kernel::FacetPose<double> pose;
  pose.along_scale = 1 / apart;
  pose.half_shift = disk.shift();
  const Vec3<Body> half =
      kernel::mean_half_vector(plane.sun, plane.observer, {0, 1, 0}, apart, disk);
  pose.half[0] = half.x;
  pose.half[2] = half.z;
  kernel::LobeAtPose<double> at;
  kernel::put_lobe_at_pose(constants(lobe), disk, at);
  return kernel::lobe_density(constants(lobe), at, pose,
                              kernel::from_half(pose, kernel::apart_from_half(pose, n.x, n.y, n.z),
                                                dot(n, plane.sun), dot(n, plane.observer)));
}

/// Standard deviation of the slope; of GGX the core's.
double width(const Lobe &lobe) {
  return lobe.kind == LobeKind::BlinnPhong ? 1 / std::sqrt(lobe.shape)
                                           : lobe.shape / std::numbers::sqrt2;
}

/// Largest difference over normals around the lobe and the disk's image, in parts of the peak.
double worst(const Lobe &lobe, double phase) {
  const Plane plane(phase);
  const double peak = plane.mean(lobe, {0, 0, 1});
  const double along = 4 * width(lobe) + radius / 2,
               across = 4 * width(lobe) + radius / 2 / std::cos(phase / 2);
  double out = 0;
  for (int i = 0; i <= 8; ++i)
    for (int j = 0; j <= 6; ++j) {
      const Vec3<Body> n = normalized(Vec3<Body>{along * (i - 4) / 4, across * j / 6, 1});
      out = std::max(out, std::abs(by_kernel(lobe, plane, n) - plane.mean(lobe, n)) / peak);
    }
  return out;
}

TEST(DiskLobe, MeansOverTheDiskAgreeWithBruteForce) {
  const Lobe lobes[] = {
      {LobeKind::BlinnPhong, 50},  {LobeKind::BlinnPhong, 3000}, {LobeKind::BlinnPhong, 2e4},
      {LobeKind::BlinnPhong, 2e5}, {LobeKind::Beckmann, 0.1},    {LobeKind::Beckmann, 0.03},
      {LobeKind::Beckmann, 0.01},  {LobeKind::Beckmann, 0.003},  {LobeKind::Ggx, 0.2},
      {LobeKind::Ggx, 0.03},       {LobeKind::Ggx, 0.01},        {LobeKind::Ggx, 0.003}};
  std::size_t closed = 0, cut = 0;
  for (const double phase : {0.5, 20., 60., 100., 130., 148., 160., 170.})
    for (const Lobe &lobe : lobes) {
      const kernel::DiskImage disk = kernel::disk_image(radius, std::cos(phase * degree));
      kernel::LobeAtPose<double> at;
      kernel::put_lobe_at_pose(constants(lobe), disk, at);
      ++(at.uses_chords ? cut : closed);
      // kernel/disk_lobe.h and .inl.h state these; the image is some 5 lobe widths long at q = 1.6.
      const double q = disk.across / (width(lobe) * width(lobe));
      const double allowed = !at.uses_chords ? 6e-4 : q < 1.6 ? 2e-3 : 2e-2;
      EXPECT_LT(worst(lobe, phase * degree), allowed)
          << static_cast<int>(lobe.kind) << " " << lobe.shape << " at " << phase << ", q " << q;
    }
  EXPECT_GT(closed, 30u);
  EXPECT_GT(cut, 20u);
}

TEST(DiskLobe, APointSourceSeesTheLobeItself) {
  const Plane plane(70 * degree);
  for (const Lobe &lobe :
       {Lobe{LobeKind::BlinnPhong, 300}, Lobe{LobeKind::Beckmann, 0.2}, Lobe{LobeKind::Ggx, 0.1}}) {
    kernel::LobeAtPose<double> at;
    kernel::put_lobe_at_pose(constants(lobe), kernel::disk_image(0, 0.3), at);
    for (const double tilt : {0., 0.05, 0.3}) {
      kernel::FacetPose<double> pose;
      pose.half[2] = 1;
      const auto from = kernel::from_half(
          pose, kernel::apart_from_half(pose, std::sin(tilt), 0.0, std::cos(tilt)), 0.0, 0.0);
      const double exact = density(lobe, std::cos(tilt));
      EXPECT_NEAR(kernel::lobe_density(constants(lobe), at, pose, from), exact, 1e-12 * exact);
    }
  }
}

TEST(DiskLobe, TheMeanOverAllNormalsIsThatOfTheLobe) {
  // A sphere under a disk reflects what it does under a point: the integral over normals of D is
  // the same, whichever way the mean is taken; across both switches. Steps of a tenth of a width.
  for (const double alpha : {0.2, 0.05, 0.02, 0.012, 0.006, 0.003})
    for (const double phase : {60., 148., 165.}) {
      const Lobe lobe{LobeKind::Beckmann, alpha};
      const Plane plane(phase * degree);
      const double along = 7 * width(lobe) + radius / 2,
                   across = 7 * width(lobe) + radius / 2 / std::cos(phase * degree / 2);
      constexpr int steps = 160;
      double sum = 0;
      for (int i = 0; i < steps; ++i)
        for (int j = 0; j < steps; ++j) { // even in slopes: dw = cos^3 dx dy
          const double x = along * (2 * (i + 0.5) / steps - 1), y = across * (j + 0.5) / steps,
                       c = 1 / std::sqrt(1 + x * x + y * y);
          sum += by_kernel(lobe, plane, c * Vec3<Body>{x, y, 1}) * c * c * c * c;
        }
      const double integral = sum * 2 * (2 * along / steps) * (across / steps);
      EXPECT_NEAR(integral, 1, 3e-3) << alpha << " " << phase; // int D (n.h) dw = 1
    }
}

} // namespace
} // namespace umov
