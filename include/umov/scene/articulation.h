#pragma once
// Parts of a mesh that turn against the body.

#include <optional>
#include <string>
#include <umov/core/result.h>
#include <umov/core/rotation.h>
#include <umov/shape/mesh.h>
#include <vector>

namespace umov {

/// Parts of a mesh that turn together about an axis: groups by name, and whatever hangs below nodes
/// of the file's tree; everything as it stands in the mesh, body axes.
struct Joint {
  std::string name;
  std::vector<std::string> groups;
  Vec3<Body> axis{0, 1, 0};         ///< unit; right-handed angles
  Vec3<Body> pivot_m{};             ///< a point of the axis
  Vec3<Body> face{0, 0, 1};         ///< what is turned towards a target
  std::string on;                   ///< the joint that carries this one; "" the body
  std::vector<std::string> nodes{}; ///< names of nodes, or ends of their paths ("bus/wing")
};

/// BadInput for a group that the mesh lacks or that two joints claim, a node that is not in its
/// tree or whose name means several (a joint of a node further down wins), a carrier that does not
/// stand before, an axis without length, or a face along the axis.
Result<void> check_joints(const std::vector<Joint> &joints, const Mesh &mesh);

/// The angle [rad] that brings the face as near as possible to a direction, for a joint whose
/// carrier has turned by the angles before it: the face and the direction are alike across the
/// axis. 0 where the direction lies along the axis (any angle would do).
double following_angle(const std::vector<Joint> &joints, std::size_t which,
                       const std::vector<double> &angles_rad, Vec3<Body> direction);

/// Where a joint's face points after all have turned.
Vec3<Body> turned_face(const std::vector<Joint> &joints, std::size_t which,
                       const std::vector<double> &angles_rad);

/// Where a rigid part of the mesh goes: x -> turn x + shift_m, in body axes.
struct PartMotion {
  Rotation<Body, Body> turn;
  Vec3<Body> shift_m{};

  /// Where a point goes.
  [[nodiscard]] Vec3<Body> place(Vec3<Body> p) const { return turn * p + shift_m; }
  /// The motion back.
  [[nodiscard]] PartMotion inverse() const {
    const Rotation<Body, Body> back = turn.inverse();
    return {back, back * (-1 * shift_m)};
  }
  friend PartMotion operator*(const PartMotion &a, const PartMotion &b) {
    return {a.turn * b.turn, a.place(b.shift_m)};
  }
};
/// Motions of all joints.
std::vector<PartMotion> part_motions(const std::vector<Joint> &joints,
                                     const std::vector<double> &angles_rad);

/// The joint of each mesh group; joints.size() where it stands still.
std::vector<std::size_t> joint_of_groups(const Mesh &mesh, const std::vector<Joint> &joints);

/// The mesh with its joints turned by one angle each.
Mesh posed(const Mesh &mesh, const std::vector<Joint> &joints,
           const std::vector<double> &angles_rad);

} // namespace umov
