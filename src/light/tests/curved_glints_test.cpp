// Glints of curved parts: lobes that are narrower than the elements of a mesh, against quadrature
// over the true surface, and along light curves.

#include "engine_cases.h"
#include "light/reference/elements_lit.h"

#include <fstream>
#include <map>
#include <sstream>
#include <umov/core/text.h>

namespace umov::cases {
namespace {

/// A row of tests/data/surfaces/curved_glints.csv (tools/oracles/curved_glints.py).
struct Row {
  std::string shape, model;
  double parameter;
  Vec3<Body> sun, observer;
  double j, peak;
};

std::vector<Row> rows() {
  std::ifstream file(UMOV_SOURCE_DIR "/tests/data/surfaces/curved_glints.csv");
  std::vector<Row> out;
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with('#') || line.starts_with("shape"))
      continue;
    std::istringstream cells(line);
    Row row;
    std::getline(cells, row.shape, ',');
    std::getline(cells, row.model, ',');
    double n[9];
    for (double &number : n) {
      std::string cell;
      std::getline(cells, cell, ',');
      number = parse_number(cell).value();
    }
    row.parameter = n[0];
    row.sun = {n[1], n[2], n[3]};
    row.observer = {n[4], n[5], n[6]};
    row.j = n[7];
    row.peak = n[8];
    out.push_back(row);
  }
  return out;
}

Material polished(const std::string &model, double parameter) {
  Material out = interface_of("paper_au", 1);
  out.distribution = {model, {{model == "blinn_phong" ? "m" : "alpha", parameter}}, {}, {}, {}};
  out.shadowing = Shadowing::Smith;
  return out;
}
/// Reflects nothing.
Material void_material() {
  Material out = white_lambert();
  out.body.reset();
  return out;
}

/// Radius 1 at z = -1, .4 at z = 1, caps of a group of their own. In rings, so that triangles of a
/// side that narrows are of nearly equal area: normals turn evenly over each of them, which over
/// the two halves of a trapezoid they do not.
Mesh cone(std::uint32_t sides, std::uint32_t rings) {
  Mesh mesh;
  mesh.groups = {"side", "caps"};
  const double slant = std::hypot(2, 0.6);
  const auto add = [&](std::uint32_t group, std::array<Vec3<Body>, 3> p,
                       std::array<Vec3<Body>, 3> n) {
    Triangle t;
    t.front = t.back = group;
    for (std::size_t k = 0; k < 3; ++k) {
      t.vertex[k] = static_cast<std::uint32_t>(mesh.positions.size());
      t.normal[k] = static_cast<std::uint32_t>(mesh.normals.size());
      mesh.positions.push_back(p[k]);
      mesh.normals.push_back(n[k]);
    }
    mesh.triangles.push_back(t);
  };
  const auto at = [&](std::uint32_t ring, std::uint32_t side) {
    const double z = -1 + 2.0 * ring / rings, r = 1 - 0.3 * (z + 1),
                 phi = 2 * pi * (side % sides) / sides;
    return Vec3<Body>{r * std::cos(phi), r * std::sin(phi), z};
  };
  const auto normal = [&](std::uint32_t side) {
    const double phi = 2 * pi * (side % sides) / sides;
    return Vec3<Body>{2 / slant * std::cos(phi), 2 / slant * std::sin(phi), 0.6 / slant};
  };
  const Vec3<Body> up{0, 0, 1}, top = up, bottom = -up;
  for (std::uint32_t s = 0; s < sides; ++s) {
    const Vec3<Body> left = normal(s), right = normal(s + 1);
    for (std::uint32_t r = 0; r < rings; ++r) {
      add(0, {at(r, s), at(r, s + 1), at(r + 1, s + 1)}, {left, right, right});
      add(0, {at(r, s), at(r + 1, s + 1), at(r + 1, s)}, {left, right, left});
    }
    add(1, {top, at(rings, s), at(rings, s + 1)}, {up, up, up});
    add(1, {bottom, at(0, s + 1), at(0, s)}, {bottom, bottom, bottom});
  }
  return mesh;
}

/// The narrower the lobe, the better it sees that the two halves of a trapezoid are not alike.
Mesh mesh_of(const std::string &shape, bool is_wide) {
  return shape == "cylinder" ? make_cylinder(1, 2, 48)
         : shape == "cone"   ? cone(is_wide ? 768 : 1536, 12)
                             : make_sphere(1, 5000);
}

Vec3<Body> turned(Vec3<Body> v, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {c * v.x - s * v.y, s * v.x + c * v.y, v.z};
}

/// The pose of a row, the body turned about z.
std::vector<Pose> turned_poses(const Row &row, std::size_t count) {
  std::vector<Pose> out;
  for (std::size_t k = 0; k < count; ++k) {
    const double angle = 0.37 * static_cast<double>(k);
    Pose &pose = out.emplace_back(Pose{turned(row.sun, angle), turned(row.observer, angle)});
    pose.sun_radius_rad = solar_radius;
  }
  return out;
}

// One normal for each class misses 9 % of the peak on the cylinder with alpha = .01, 70 % with .003
// (GGX). Wide lobes have one, and elements of a sphere are no even lattice: a lobe's width across,
// their middles leave 1/3 %.
TEST(CurvedGlints, MatchQuadrature) {
  std::string made;
  std::optional<Scene> scene;
  std::optional<Engine> engine;
  std::size_t count = 0;
  std::map<std::string, double> worst_of; ///< in parts of the peak
  for (const Row &row : rows()) {
    const std::string wanted = row.shape + "_" + row.model + "_" + std::to_string(row.parameter);
    const bool is_wide = row.model == "blinn_phong" ? row.parameter < 2500 : row.parameter > 0.029;
    if (wanted != made) {
      scene = scene_of(mesh_of(row.shape, is_wide), NormalMode::Smooth,
                       {polished(row.model, row.parameter), void_material()});
      engine.emplace(engine_of(*scene, Visibility::None));
      made = wanted;
    }
    const std::vector<Pose> poses = turned_poses(row, 12);
    const StokesTable light = evaluated(*engine, poses);
    const double a = scene->front[0].fresnel(1, dot(row.sun, row.observer)).a;
    double worst = 0;
    for (std::size_t k = 0; k < poses.size(); ++k)
      worst = std::max(worst, std::abs(light.at(k, 1).stokes.i / a - row.j));
    const double bound = is_wide && row.shape == "sphere" ? 4e-3 : 1e-3;
    EXPECT_LT(worst, bound * row.peak) << wanted << ", light " << row.j << " of " << row.peak;
    worst_of[wanted] = std::max(worst_of[wanted], worst / row.peak);
    ++count;
  }
  EXPECT_EQ(count, 364u);
  for (const auto &[what, worst] : worst_of)
    RecordProperty(what, shortest(worst));
}

/// The largest difference of second differences along a curve, in parts of the peak.
double roughness(const Scene &scene, const std::vector<Pose> &poses) {
  const StokesTable fast = evaluated(engine_of(scene, Visibility::None), poses);
  const Elements elements = make_elements(scene, visible_sides(scene.mesh));
  std::vector<double> rays; // which cut elements finer than the lobe; nothing is hidden
  for (const Pose &pose : poses)
    rays.push_back(light_elements(scene, elements, geometry_of(pose), {1, 0, 0, 0}).total[1]);
  double worst = 0, peak = 0;
  const auto apart = [&](std::size_t k) { return fast.at(k, 1).stokes.i - rays[k]; };
  for (std::size_t k = 1; k + 1 < poses.size(); ++k) {
    worst = std::max(worst, std::abs(apart(k - 1) - 2 * apart(k) + apart(k + 1)));
    peak = std::max(peak, rays[k]);
  }
  EXPECT_GT(peak, 0);
  return worst / peak;
}

// In steps of a seventh to a third of the lobe. The narrower one is cut into chords here and into a
// contour there (lobes.md), 1e-3 of the peak apart; it costs the reference a tenth of a second a
// pose on the cylinder, and seconds on a sphere.
TEST(CurvedGlints, CurvesThroughThemHaveNoSteps) {
  const auto scene = [](const Mesh &mesh, const char *model, double parameter) {
    return scene_of(mesh, NormalMode::Smooth, {polished(model, parameter), void_material()});
  };
  const Mesh tube = make_cylinder(1, 2, 48);
  EXPECT_LT(roughness(scene(tube, "ggx", 0.01), through_glint(pi / 2, 0.03, 60)), 1e-4);
  EXPECT_LT(roughness(scene(tube, "beckmann", 0.003), through_glint(pi / 2, 0.006, 12)), 5e-4);
  EXPECT_LT(roughness(scene(make_sphere(1, 2000), "ggx", 0.01), through_glint(1, 0.006, 8)), 3e-4);
}

} // namespace
} // namespace umov::cases
