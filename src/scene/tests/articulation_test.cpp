// Turning parts: what they face, and the mesh that comes of it.

#include <umov/scene/articulation.h>

#include <cmath>
#include <gtest/gtest.h>
#include <random>
#include <umov/core/quantity.h>

namespace umov {
namespace {

Vec3<Body> random_unit(std::mt19937_64 &random) {
  std::normal_distribution<double> normal;
  return normalized(Vec3<Body>{normal(random), normal(random), normal(random)});
}

/// A body and a panel that share an edge's vertices.
Mesh body_with_panel() {
  Mesh mesh;
  mesh.groups = {"body", "panel"};
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}};
  mesh.normals = {{0, 0, 1}};
  mesh.triangles = {{{0, 1, 2}, {0, 0, 0}, 0, 0}, {{1, 3, 2}, {0, 0, 0}, 1, 1}};
  mesh.tangents = {{1, 0, 0}, {1, 0, 0}};
  return mesh;
}

TEST(Articulation, OneAxisFacesAsNearAsItMay) {
  std::mt19937_64 random(1);
  for (int k = 0; k < 1000; ++k) {
    Joint joint{"p", {"panel"}, random_unit(random), {}, {}, ""};
    joint.face = normalized(cross(joint.axis, random_unit(random))); // across the axis
    const Vec3<Body> sun = random_unit(random);
    const double angle = following_angle({joint}, 0, {0}, sun);
    const double sine = std::sin(angle_between(joint.axis, sun));
    EXPECT_NEAR(dot(turned_face({joint}, 0, {angle}), sun), sine, 1e-12);
  }
}

TEST(Articulation, TwoAxesFaceItExactly) {
  std::mt19937_64 random(2);
  for (int k = 0; k < 1000; ++k) {
    Joint outer{"yoke", {"body"}, random_unit(random), {}, {}, ""};
    Joint inner{"panel", {"panel"}, {}, {}, {}, "yoke"};
    inner.axis = normalized(cross(outer.axis, random_unit(random))); // across the outer axis
    outer.face = inner.face = cross(outer.axis, inner.axis);
    const Vec3<Body> sun = random_unit(random);
    const std::vector<Joint> joints{outer, inner};
    std::vector<double> angles(2, 0);
    angles[0] = following_angle(joints, 0, angles, sun);
    angles[1] = following_angle(joints, 1, angles, sun);
    EXPECT_NEAR(dot(turned_face(joints, 1, angles), sun), 1, 1e-12);
  }
}

TEST(Articulation, AYawSteeringBodyLetsOneAxisFaceItExactly) {
  // z to nadir and the panel's axis y held across the Sun: the two-axis law does that.
  std::mt19937_64 random(3);
  for (int k = 0; k < 1000; ++k) {
    const Vec3<Body> sun = random_unit(random), nadir{0, 0, 1};
    const Vec3<Body> axis = normalized(cross(nadir, sun));
    const Joint joint{"p", {"panel"}, axis, {}, {0, 0, 1}, ""};
    EXPECT_NEAR(dot(turned_face({joint}, 0, {following_angle({joint}, 0, {0}, sun)}), sun), 1,
                1e-12);
  }
}

TEST(Articulation, TurnsItsGroupsAloneAboutTheirAxis) {
  const Mesh mesh = body_with_panel();
  // About the line x = 1, y + z: right-handed about +y, so +x goes to -z.
  const Joint joint{"p", {"panel"}, {0, 1, 0}, {1, 0, 0}, {0, 0, 1}, ""};
  const Mesh out = posed(mesh, {joint}, {pi / 2});
  ASSERT_EQ(out.triangles.size(), 2u);
  for (int c = 0; c < 3; ++c)
    EXPECT_EQ(out.triangles[0].vertex[static_cast<std::size_t>(c)],
              mesh.triangles[0].vertex[static_cast<std::size_t>(c)]);
  const auto corner = [&](std::size_t c) { return out.positions[out.triangles[1].vertex[c]]; };
  EXPECT_LT(norm(corner(0) - Vec3<Body>{1, 0, 0}), 1e-15);
  EXPECT_LT(norm(corner(1) - Vec3<Body>{1, 1, 0}), 1e-15);
  EXPECT_LT(norm(corner(2) - Vec3<Body>{1, 1, 1}), 1e-15); // was (0, 1, 0)
  EXPECT_LT(norm(out.normals[out.triangles[1].normal[0]] - Vec3<Body>{1, 0, 0}), 1e-15);
  EXPECT_LT(norm(out.tangents[1] - Vec3<Body>{0, 0, -1}), 1e-15);
  EXPECT_EQ(mesh.positions.size(), 4u);
  EXPECT_EQ(posed(mesh, {joint}, {0.0}).positions.size(), 7u);
}

TEST(Articulation, ACarriedPartGoesWithItsCarrier) {
  Mesh mesh = body_with_panel();
  const std::vector<Joint> joints{{"a", {"body"}, {0, 0, 1}, {0, 0, 0}, {1, 0, 0}, ""},
                                  {"b", {"panel"}, {0, 1, 0}, {1, 0, 0}, {0, 0, 1}, "a"}};
  const Mesh out = posed(mesh, joints, {pi / 2, pi / 2});
  // (0, 1, 0) goes to (1, 1, 1) by b, then to (-1, 1, 1) by a.
  EXPECT_LT(norm(out.positions[out.triangles[1].vertex[2]] - Vec3<Body>{-1, 1, 1}), 1e-15);
}

/// Three panels of one material in the tree body, body/wing, body/wing/tip.
Mesh tree() {
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.groups = {"foil", "foil", "foil"};
  mesh.nodes = {"body", "body/wing", "body/wing/tip"};
  for (std::uint32_t g = 0; g < 3; ++g)
    mesh.triangles.push_back({{0, 1, 2}, {no_index, no_index, no_index}, g, g});
  return mesh;
}

TEST(Articulation, NodesTurnWithAllBelowThem) {
  const Mesh mesh = tree();
  Joint wing{"w", {}, {0, 0, 1}, {}, {1, 0, 0}, ""}, tip = wing;
  wing.nodes = {"wing"};
  tip.name = "t";
  tip.on = "w";
  tip.nodes = {"wing/tip"};
  ASSERT_TRUE(check_joints({wing, tip}, mesh));
  EXPECT_EQ(joint_of_groups(mesh, {wing}), (std::vector<std::size_t>{1, 0, 0}));
  EXPECT_EQ(joint_of_groups(mesh, {wing, tip}),
            (std::vector<std::size_t>{2, 0, 1})); // deepest wins
  Joint all = wing;
  all.nodes.clear();
  all.groups = {"foil"};
  EXPECT_EQ(joint_of_groups(mesh, {all}), (std::vector<std::size_t>{0, 0, 0})); // a name, all nodes
}

TEST(Articulation, RefusesNodesThatAreNoneOrSeveral) {
  Mesh mesh = tree();
  Joint joint{"w", {}, {0, 0, 1}, {}, {1, 0, 0}, ""};
  const auto refused = [&](const char *node, const char *words) {
    joint.nodes = {node};
    const auto checked = check_joints({joint}, mesh);
    ASSERT_FALSE(checked) << words;
    EXPECT_NE(checked.error().message.find(words), std::string::npos) << checked.error().message;
  };
  refused("win", "no node \"win\" with faces; it has body, body/wing, body/wing/tip");
  mesh.nodes = {"left/wing", "right/wing", "right/wing/tip"};
  refused("wing", "may be any of left/wing, right/wing; write more of its path");
  mesh.nodes.clear();
  refused("wing", "has no tree of nodes");
}

TEST(Articulation, RefusesWhatCannotTurn) {
  const Mesh mesh = body_with_panel();
  const Joint fine{"p", {"panel"}, {0, 1, 0}, {}, {0, 0, 1}, ""};
  EXPECT_TRUE(check_joints({fine}, mesh));
  const auto refused = [&](Joint joint, const char *words) {
    const auto checked = check_joints({fine, joint}, mesh);
    ASSERT_FALSE(checked) << words;
    EXPECT_NE(checked.error().message.find(words), std::string::npos) << checked.error().message;
  };
  refused({"q", {"wing"}, {0, 1, 0}, {}, {0, 0, 1}, ""}, "no group \"wing\"; it has body, panel");
  refused({"q", {"panel"}, {0, 1, 0}, {}, {0, 0, 1}, ""}, "of part \"p\" and of part \"q\"");
  refused({"q", {"body"}, {0, 1, 0}, {}, {0, 0, 1}, "z"}, "does not stand before it");
  refused({"q", {"body"}, {0, 1, 0}, {}, {0, 1, 0}, ""}, "lies along its axis");
  refused({"q", {}, {0, 1, 0}, {}, {0, 0, 1}, ""}, "has no groups");
}

} // namespace
} // namespace umov
