#pragma once
// Scenes and poses that the tests of the integrator share.

#include <cmath>
#include <gtest/gtest.h>
#include <umov/core/random.h>
#include <umov/light/integrator.h>
#include <umov/shape/primitives.h>

namespace umov::cases {

inline std::vector<Band> three_bands() {
  return {{"nm:425", Wavelength::nm(425)},
          {"nm:550", Wavelength::nm(550)},
          {"nm:650", Wavelength::nm(650)}};
}

/// A built-in index with an exponent and without body light.
inline Material interface_of(const std::string &name, double exponent) {
  Material out = builtin_material(name).value();
  out.distribution = blinn_phong(exponent);
  out.body.reset();
  return out;
}

/// Index 1 reflects nothing at the interface; what is left is Lambert's law with reflectance 1.
inline Material white_lambert() {
  Material out = builtin_material("paper_spectralon").value();
  out.body = BodyLobe{{{}, {1.0}}, false};
  return out;
}

inline Material grey(double reflectance) {
  Material out = white_lambert();
  out.body->reflectance.value = {reflectance};
  return out;
}

inline Material mirror_of(const std::string &name) {
  Material out = builtin_material(name).value();
  out.distribution = {"mirror", {}, {}, {}};
  out.body.reset();
  return out;
}

/// Front and back of each group with materials of their own; flat normals.
inline Scene scene_of_sides(const Mesh &mesh, const std::vector<Material> &front,
                            const std::vector<Material> &back) {
  Diagnostics diagnostics;
  auto scene = make_scene(mesh, NormalMode::Flat, three_bands(), front, back, diagnostics);
  EXPECT_TRUE(scene) << scene.error().text();
  return *scene;
}

/// A sphere with the triangles about +z taken out; the share of its area that is missing.
struct Cavity {
  Mesh mesh;
  double hole_area = 0, whole_area = 0;
  Vec3<Body> opening{}; ///< vector area of the hole: along a direction, what one looks through
};
inline Cavity cavity(std::size_t facets, double opening_deg) {
  Cavity out;
  out.mesh = make_sphere(1, facets);
  std::vector<Triangle> kept;
  for (const Triangle &t : out.mesh.triangles) {
    const double area = 0.5 * norm(area_vector_doubled(out.mesh, t));
    Vec3<Body> middle{};
    for (const std::uint32_t v : t.vertex)
      middle += out.mesh.positions[v] / 3;
    out.whole_area += area;
    if (middle.z > std::cos(Angle::degrees(opening_deg).radians()) * norm(middle)) {
      out.hole_area += area;
      out.opening += area_vector_doubled(out.mesh, t) * 0.5;
    } else
      kept.push_back(t);
  }
  out.mesh.triangles = kept;
  return out;
}

/// A square floor of 1 m2 and a wall along its edge at x = 0, their inner sides facing each other.
inline Mesh corner(double height = 1) {
  Mesh mesh;
  mesh.groups = {"floor", "wall"};
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, height}, {0, 1, height}};
  const std::array<std::uint32_t, 3> none{no_index, no_index, no_index};
  mesh.triangles = {{{0, 1, 2}, none, 0, 0},
                    {{0, 2, 3}, none, 0, 0},
                    {{0, 3, 5}, none, 1, 1},
                    {{0, 5, 4}, none, 1, 1}};
  return mesh;
}

/// The first material on the first group and so on, over and over.
inline Scene scene_of(const Mesh &mesh, NormalMode normals,
                      const std::vector<Material> &materials) {
  std::vector<Material> per_group;
  for (std::size_t g = 0; g < mesh.groups.size(); ++g)
    per_group.push_back(materials[g % materials.size()]);
  Diagnostics diagnostics;
  auto scene = make_scene(mesh, normals, three_bands(), per_group, per_group, diagnostics);
  EXPECT_TRUE(scene) << scene.error().text();
  return *scene;
}

/// Uniform attitude, the given phase angle.
inline Pose pose_at(std::uint64_t index, Angle phase) {
  const auto u = uniform4(20180121, 1, index);
  const double z = 2 * u[0] - 1, s = std::sqrt(1 - z * z);
  const Vec3<Body> sun{s * std::cos(2 * pi * u[1]), s * std::sin(2 * pi * u[1]), z};
  const Vec3<Body> a = any_perpendicular(sun), b = cross(sun, a);
  const Vec3<Body> aside = std::cos(2 * pi * u[2]) * a + std::sin(2 * pi * u[2]) * b;
  return {sun, normalized(std::cos(phase.radians()) * sun + std::sin(phase.radians()) * aside)};
}

/// Uniform attitude, phase angle uniform between two limits.
inline Pose random_pose(std::uint64_t index, double low_deg = 20, double high_deg = 150) {
  const double u = uniform4(20180121, 2, index)[0];
  return pose_at(index, Angle::degrees(low_deg + (high_deg - low_deg) * u));
}

/// Both meshes in one; groups of equal name become one.
inline Mesh joined(Mesh a, const Mesh &b) {
  const auto positions = static_cast<std::uint32_t>(a.positions.size());
  const auto normals = static_cast<std::uint32_t>(a.normals.size());
  std::vector<std::uint32_t> group;
  for (const std::string &name : b.groups) {
    std::uint32_t g = 0;
    while (g < a.groups.size() && a.groups[g] != name)
      ++g;
    if (g == a.groups.size())
      a.groups.push_back(name);
    group.push_back(g);
  }
  a.positions.insert(a.positions.end(), b.positions.begin(), b.positions.end());
  a.normals.insert(a.normals.end(), b.normals.begin(), b.normals.end());
  for (Triangle t : b.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      t.vertex[k] += positions;
      if (t.normal[k] != no_index)
        t.normal[k] += normals;
    }
    t.front = group[t.front];
    t.back = group[t.back];
    a.triangles.push_back(t);
  }
  return a;
}

template <class F> Mesh moved(Mesh mesh, F &&place) {
  for (Vec3<Body> &p : mesh.positions)
    p = place(p);
  return mesh;
}

inline Mesh shifted(const Mesh &mesh, Vec3<Body> by) {
  return moved(mesh, [&](Vec3<Body> p) { return p + by; });
}

inline Mesh renamed(Mesh mesh, const std::string &group) {
  mesh.groups = {group};
  for (Triangle &t : mesh.triangles)
    t.front = t.back = 0;
  return mesh;
}

/// Rectangle [x0, x1] x [y0, y1] at height z, normal +z.
inline Mesh sheet(double x0, double x1, double y0, double y1, double z, const std::string &group) {
  Mesh mesh;
  mesh.positions = {{x0, y0, z}, {x1, y0, z}, {x1, y1, z}, {x0, y1, z}};
  mesh.triangles.resize(2);
  mesh.triangles[0].vertex = {0, 1, 2};
  mesh.triangles[1].vertex = {0, 2, 3};
  mesh.groups = {group};
  return mesh;
}

/// A satellite that shades itself: a cube, two wings on its y axis and a round tank on top.
inline Mesh box_wing() {
  Mesh mesh = renamed(make_chamfered_cube(2, 0.2), "bus");
  mesh = joined(mesh, shifted(renamed(make_plate(2, 6, false), "wing"), {0, 4.5, 0}));
  mesh = joined(mesh, shifted(renamed(make_plate(2, 6, false), "wing"), {0, -4.5, 0}));
  return joined(mesh, shifted(renamed(make_cylinder(0.7, 1.5, 24), "tank"), {0, 0, 2}));
}

/// The built-in bus with wings: metal, white and gold.
inline Scene box_wing_scene() {
  return scene_of(make_box_wing({1000, 0}), NormalMode::Flat,
                  {interface_of("paper_al", 30), white_lambert(), interface_of("paper_au", 50)});
}

inline double relative(double value, double expected) { return std::abs(value / expected - 1); }

} // namespace umov::cases
