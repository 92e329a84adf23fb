#pragma once
// What the tests of the fast engine share.

#include "backend/scene_data.h"
#include "light/tests/integrator_cases.h"

#include <algorithm>
#include <umov/light/engine.h>

namespace umov::cases {

/// The benchmark's materials: foil, cells, white paint, metal.
inline std::vector<Material> four_materials() {
  std::vector<Material> out;
  const char *names[] = {"paper_au", "paper_asi", "paper_spectralon", "paper_al"};
  const double exponents[] = {200, 1000, 20, 50};
  for (std::size_t i = 0; i < 4; ++i) {
    out.push_back(builtin_material(names[i]).value());
    out.back().distribution = blinn_phong(exponents[i]);
  }
  return out;
}

inline Engine engine_of(const Scene &scene, Visibility visibility, bool is_double = false) {
  EngineOptions options;
  options.visibility = visibility;
  options.masks = {20'000, 24, 24, 0};
  options.is_double = is_double;
  return Engine(scene, options);
}

inline StokesTable evaluated(const Engine &engine, const std::vector<Pose> &poses,
                             unsigned threads = 2) {
  StokesTable out;
  engine.evaluate(poses, out, threads);
  return out;
}

inline std::vector<Pose> random_poses(std::size_t count, double sun_radius_rad = 0) {
  std::vector<Pose> out;
  for (std::size_t i = 0; i < count; ++i) {
    out.push_back(random_pose(i, 15, 150));
    out.back().sun_radius_rad = sun_radius_rad;
  }
  return out;
}

inline constexpr double solar_radius = 0.2665 * pi / 180;

/// The half vector from the side of a shape's glint to the other, at an azimuth that moves along.
inline std::vector<Pose> through_glint(double polar, double reach, std::size_t count) {
  std::vector<Pose> out;
  for (std::size_t k = 0; k < count; ++k) {
    const double along = 2.0 * static_cast<double>(k) / static_cast<double>(count - 1) - 1;
    const double theta = polar + reach * along, phi = 0.2 + 0.6 * reach * along, half = 0.6;
    const Vec3<Body> h{std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi),
                       std::cos(theta)};
    const Vec3<Body> e = any_perpendicular(h);
    Pose &pose = out.emplace_back(
        Pose{std::cos(half) * h + std::sin(half) * e, std::cos(half) * h - std::sin(half) * e});
    pose.sun_radius_rad = solar_radius;
  }
  return out;
}

inline double quantile(std::vector<double> v, double share) {
  std::sort(v.begin(), v.end());
  return v[std::min(v.size() - 1, static_cast<std::size_t>(share * static_cast<double>(v.size())))];
}

} // namespace umov::cases
