#include <umov/inverse/symmetry.h>

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <umov/inverse/attitude_grid.h>
#include <umov/light/poses.h>

namespace umov {
namespace {

constexpr std::size_t trials = 60;

std::vector<Pose> turned_poses(const std::vector<Pose> &poses, Vec3<Body> turn) {
  const Quaternion q = turned({}, turn);
  const auto r = rotation_from<Body, Body>(q);
  std::vector<Pose> out = poses;
  for (Pose &pose : out) {
    pose.sun = normalized(r * pose.sun);
    pose.observer = normalized(r * pose.observer);
  }
  return out;
}

/// Nine of ten poses alike within 1 %, in all bands.
bool is_alike(const StokesTable &a, const StokesTable &b) {
  std::vector<double> off;
  for (std::size_t band = 0; band < a.bands; ++band) {
    std::vector<double> bright;
    for (std::size_t k = 0; k < trials; ++k)
      bright.push_back(a.i[k * a.bands + band]);
    std::nth_element(bright.begin(), bright.begin() + trials / 2, bright.end());
    for (std::size_t k = 0; k < trials; ++k) {
      const std::size_t at = k * a.bands + band;
      const double base = a.i[at] + bright[trials / 2] + 1e-30;
      off.push_back(std::max(std::abs(a.i[at] - b.i[at]), std::abs(a.q[at] - b.q[at])) / base);
    }
  }
  const auto ninth = off.begin() + static_cast<std::ptrdiff_t>(off.size() * 9 / 10);
  std::nth_element(off.begin(), ninth, off.end());
  return *ninth < 0.01;
}

} // namespace

Quaternion twin_of(Quaternion attitude, const BodySymmetry &symmetry, double angle_rad) {
  return turned(attitude, symmetry.axis * angle_rad);
}

std::vector<BodySymmetry> find_symmetries(const PoseLighting &light, std::uint64_t seed) {
  std::vector<Pose> poses;
  for (std::size_t k = 0; k < trials; ++k)
    poses.push_back(
        random_pose(seed, k, Angle::degrees(30 + 120 * static_cast<double>(k) / trials)));
  StokesTable own, other;
  if (!light(poses, own))
    return {};
  std::vector<BodySymmetry> out;
  const Vec3<Body> axes[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (std::size_t a = 0; a < 3; ++a) {
    const auto holds = [&](double angle) {
      return light(turned_poses(poses, axes[a] * angle), other) && is_alike(own, other);
    };
    const char name = static_cast<char>('X' + a);
    constexpr double odd = 1.0; // [rad]: no part of a turn
    if (holds(odd)) {
      out.push_back({axes[a], 0, fmt::format("any turn about +{}", name)});
      continue;
    }
    for (const auto &[parts, word] : {std::pair{4, "quarter"}, {3, "third of a"}, {2, "half"}}) {
      if (!holds(2 * pi / parts))
        continue;
      for (int k = 1; k < parts; ++k)
        out.push_back({axes[a], 2 * pi * k / parts,
                       k * 2 == parts ? fmt::format("half turn about +{}", name)
                                      : fmt::format("{} {} turn{} about +{}", k, word,
                                                    k > 1 ? "s" : "", name)});
      break;
    }
  }
  return out;
}

} // namespace umov
