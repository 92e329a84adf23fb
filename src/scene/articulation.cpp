#include <umov/scene/articulation.h>

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <map>
#include <set>
#include <umov/core/rotation.h>

namespace umov {
namespace {

/// Turns vectors by `angle` about the unit axis (the body's frame stands still).
Rotation<Body, Body> rotating(Vec3<Body> axis, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  const auto row = [&](Vec3<Body> e) {
    return e * c + axis * ((1 - c) * dot(axis, e)) - cross(axis, e) * s;
  };
  return {row({1, 0, 0}), row({0, 1, 0}), row({0, 0, 1})};
}

std::size_t carrier_of(const std::vector<Joint> &joints, std::size_t which) {
  for (std::size_t k = 0; k < which; ++k)
    if (joints[k].name == joints[which].on)
      return k;
  return joints.size();
}

/// Motion of everything that a joint carries; those before `which` have angles.
PartMotion motion_of(const std::vector<Joint> &joints, std::size_t which,
                     const std::vector<double> &angles) {
  const Joint &joint = joints[which];
  PartMotion own{rotating(joint.axis, angles[which]), {}};
  own.shift_m = joint.pivot_m - own.turn * joint.pivot_m;
  if (joint.on.empty())
    return own;
  return motion_of(joints, carrier_of(joints, which), angles) * own;
}

Rotation<Body, Body> carrier_turn(const std::vector<Joint> &joints, std::size_t which,
                                  const std::vector<double> &angles) {
  return joints[which].on.empty() ? Rotation<Body, Body>{}
                                  : motion_of(joints, carrier_of(joints, which), angles).turn;
}

/// Where the path of the outermost node that `name` means ends in the path of a group; 0: nowhere.
/// A name stands for a node or for the end of its path.
std::size_t node_end(const std::string &path, const std::string &name) {
  for (std::size_t at = path.find(name); at != std::string::npos; at = path.find(name, at + 1)) {
    const std::size_t end = at + name.size();
    if ((at == 0 || path[at - 1] == '/') && (end == path.size() || path[end] == '/'))
      return name.empty() ? 0 : end;
  }
  return 0;
}

/// The joints that claim a group. One that names the group itself wins over those that name nodes,
/// and of these the one whose node is deepest.
std::vector<std::size_t> claims(const Mesh &mesh, std::size_t group,
                                const std::vector<Joint> &joints) {
  constexpr std::size_t by_name = std::string::npos;
  std::vector<std::size_t> out;
  std::size_t strongest = 1;
  for (std::size_t k = 0; k < joints.size(); ++k) {
    const auto &names = joints[k].groups;
    std::size_t strength =
        std::find(names.begin(), names.end(), mesh.groups[group]) != names.end() ? by_name : 0;
    if (!mesh.nodes.empty())
      for (const std::string &node : joints[k].nodes)
        strength = std::max(strength, node_end(mesh.nodes[group], node));
    if (strength > strongest)
      out.clear();
    if (strength >= strongest)
      out.push_back(k);
    strongest = std::max(strongest, strength);
  }
  return out;
}

/// A joint's node must be there, and be one.
Result<void> check_node(const Joint &joint, const std::string &node, const Mesh &mesh) {
  std::set<std::string> meant, all;
  for (const std::string &path : mesh.nodes) {
    all.insert(path);
    if (const std::size_t end = node_end(path, node); end > 0)
      meant.insert(path.substr(0, end));
  }
  if (meant.empty())
    return fail(ErrorCode::BadInput,
                mesh.nodes.empty()
                    ? fmt::format("part \"{}\" names node \"{}\", but this mesh has no tree of "
                                  "nodes (glTF has); use groups",
                                  joint.name, node)
                    : fmt::format("part \"{}\": the mesh has no node \"{}\" with faces; it has {}",
                                  joint.name, node, fmt::join(all, ", ")));
  if (meant.size() > 1)
    return fail(ErrorCode::BadInput,
                fmt::format("part \"{}\": node \"{}\" may be any of {}; write more of its path",
                            joint.name, node, fmt::join(meant, ", ")));
  return {};
}

/// Names of a joint that the mesh has, each once.
Result<void> check_names(const Joint &joint, const Mesh &mesh) {
  if (joint.groups.empty() && joint.nodes.empty())
    return fail(ErrorCode::BadInput, fmt::format("part \"{}\" has no groups", joint.name));
  for (const std::string &group : joint.groups)
    if (std::find(mesh.groups.begin(), mesh.groups.end(), group) == mesh.groups.end())
      return fail(
          ErrorCode::BadInput,
          fmt::format(
              "part \"{}\": the mesh has no group \"{}\"{}; it has {}", joint.name, group,
              std::find(mesh.nodes.begin(), mesh.nodes.end(), group) == mesh.nodes.end()
                  ? ""
                  : " (groups are named by material), but a node of that name: nodes = [\"" +
                        group + "\"]",
              fmt::join(std::set<std::string>(mesh.groups.begin(), mesh.groups.end()), ", ")));
  for (const std::string &node : joint.nodes)
    UMOV_TRY(check_node(joint, node, mesh));
  return {};
}

} // namespace

Result<void> check_joints(const std::vector<Joint> &joints, const Mesh &mesh) {
  for (std::size_t k = 0; k < joints.size(); ++k) {
    const Joint &joint = joints[k];
    UMOV_TRY(check_names(joint, mesh));
    if (!joint.on.empty() && carrier_of(joints, k) == joints.size())
      return fail(ErrorCode::BadInput,
                  fmt::format("part \"{}\" is carried by \"{}\", which does not stand before it",
                              joint.name, joint.on));
    if (!(std::abs(norm(joint.axis) - 1) < 1e-9))
      return fail(ErrorCode::BadInput,
                  fmt::format("the axis of part \"{}\" is no unit vector", joint.name));
    if (!(norm(cross(joint.axis, joint.face)) > 1e-9))
      return fail(ErrorCode::BadInput,
                  fmt::format("the face of part \"{}\" lies along its axis: it cannot be turned "
                              "towards anything",
                              joint.name));
  }
  for (std::size_t g = 0; g < mesh.groups.size(); ++g)
    if (const auto owners = claims(mesh, g, joints); owners.size() > 1)
      return fail(ErrorCode::BadInput,
                  fmt::format("{} \"{}\" is of part \"{}\" and of part \"{}\"",
                              mesh.nodes.empty() ? "group" : "node",
                              mesh.nodes.empty() ? mesh.groups[g] : mesh.nodes[g],
                              joints[owners[0]].name, joints[owners[1]].name));
  return {};
}

double following_angle(const std::vector<Joint> &joints, std::size_t which,
                       const std::vector<double> &angles_rad, Vec3<Body> direction) {
  const Joint &joint = joints[which];
  const Vec3<Body> d = carrier_turn(joints, which, angles_rad).inverse() * direction;
  const Vec3<Body> x = normalized(joint.face - joint.axis * dot(joint.axis, joint.face));
  const Vec3<Body> y = cross(joint.axis, x);
  return std::atan2(dot(d, y), dot(d, x));
}

Vec3<Body> turned_face(const std::vector<Joint> &joints, std::size_t which,
                       const std::vector<double> &angles_rad) {
  return motion_of(joints, which, angles_rad).turn * joints[which].face;
}

std::vector<PartMotion> part_motions(const std::vector<Joint> &joints,
                                     const std::vector<double> &angles_rad) {
  std::vector<PartMotion> out;
  for (std::size_t k = 0; k < joints.size(); ++k)
    out.push_back(motion_of(joints, k, angles_rad));
  return out;
}

std::vector<std::size_t> joint_of_groups(const Mesh &mesh, const std::vector<Joint> &joints) {
  std::vector<std::size_t> out(mesh.groups.size(), joints.size());
  for (std::size_t g = 0; g < out.size(); ++g)
    if (const auto owners = claims(mesh, g, joints); !owners.empty())
      out[g] = owners.front();
  return out;
}

Mesh posed(const Mesh &mesh, const std::vector<Joint> &joints,
           const std::vector<double> &angles_rad) {
  const std::vector<std::size_t> joint_of = joint_of_groups(mesh, joints);
  const std::vector<PartMotion> motions = part_motions(joints, angles_rad);
  Mesh out = mesh;
  // A vertex that a moving and another group share becomes one for each.
  std::map<std::pair<std::size_t, std::uint32_t>, std::uint32_t> places, normals;
  for (std::size_t t = 0; t < out.triangles.size(); ++t) {
    Triangle &triangle = out.triangles[t];
    const std::size_t joint = joint_of[triangle.front];
    if (joint == joints.size())
      continue;
    const PartMotion &motion = motions[joint];
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const std::uint32_t vertex = triangle.vertex[corner], normal = triangle.normal[corner];
      const auto [place, is_new] = places.emplace(std::pair{joint, vertex},
                                                  static_cast<std::uint32_t>(out.positions.size()));
      if (is_new)
        out.positions.push_back(motion.place(mesh.positions[vertex]));
      triangle.vertex[corner] = place->second;
      if (normal == no_index)
        continue;
      const auto [turned, is_new_normal] =
          normals.emplace(std::pair{joint, normal}, static_cast<std::uint32_t>(out.normals.size()));
      if (is_new_normal)
        out.normals.push_back(motion.turn * mesh.normals[normal]);
      triangle.normal[corner] = turned->second;
    }
    if (!out.tangents.empty())
      out.tangents[t] = motion.turn * mesh.tangents[t];
  }
  return out;
}

} // namespace umov
