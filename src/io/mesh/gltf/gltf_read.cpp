// glTF 2.0 (Khronos, ISO/IEC 12113:2022): the tree of nodes of a scene with their meshes.

#include "io/mesh/gltf/placement.h"
#include "io/mesh/gltf/primitives.h"
#include "io/mesh/mesh_parts.h"
#include "io/mesh/readers.h"

#include <cmath>
#include <fmt/format.h>
#include <set>
#include <umov/core/stop.h>
#include <utility>

namespace umov::mesh_io {
namespace {

using gltf::Document;
using gltf::Json;
using gltf::Placement;
using gltf::Primitive;

constexpr std::size_t deepest_node = 256, longest_path = 1024, most_instances = 1'000'000,
                      most_nodes_with_faces = 100'000;

/// A node that waits to be read.
struct Pending {
  std::size_t node = 0, depth = 0;
  Placement parent;
  std::string path; ///< its own
};

class GltfReader {
public:
  GltfReader(Document &document, const MeshFileOptions &options)
      : document_(document), primitives_(document, options), options_(options) {}

  Result<MeshFile> read(Diagnostics &diagnostics);

private:
  Result<std::vector<std::size_t>> roots(Diagnostics &diagnostics) const;
  Result<std::vector<std::size_t>> node_list(const Json &from, const char *key,
                                             const std::string &place) const;
  /// Paths of nodes below one parent; unnamed ones get a name, equal ones a number.
  Result<void> push(const std::vector<std::size_t> &nodes, const Placement &parent,
                    const std::string &path, std::size_t depth);
  Result<void> take_node(const Pending &at);
  Result<void> add(const Primitive &primitive, const Placement &place, std::uint32_t group);

  Document &document_;
  gltf::PrimitiveReader primitives_;
  const MeshFileOptions &options_;
  MeshFile out_;
  GroupIndex groups_{out_.mesh};
  std::vector<Pending> pending_;
  std::vector<bool> is_reached_;
  std::size_t instances_ = 0;
  bool has_textures_ = false;
};

Result<std::vector<std::size_t>> GltfReader::node_list(const Json &from, const char *key,
                                                       const std::string &place) const {
  std::vector<std::size_t> out;
  const auto list = from.find(key);
  if (list == from.end())
    return out;
  if (!list->is_array())
    return document_.bad(place + "." + key, "no list", "a list of nodes");
  for (const Json &one : *list) {
    UMOV_ASSIGN(node, document_.index(Json{{key, one}}, key, place, "nodes"));
    out.push_back(*node);
  }
  return out;
}

Result<std::vector<std::size_t>> GltfReader::roots(Diagnostics &diagnostics) const {
  const std::size_t scenes = document_.size("scenes");
  if (scenes > 0) {
    UMOV_ASSIGN(given, document_.index(document_.json(), "scene", "the document", "scenes"));
    const std::size_t scene = given.value_or(0);
    if (scenes > 1)
      diagnostics.warn(fmt::format("scene {} of {} was read (the file's default)", scene, scenes),
                       {document_.file()});
    return node_list(document_.entry("scenes", scene), "nodes", fmt::format("scenes[{}]", scene));
  }
  std::set<std::size_t> children;
  for (std::size_t i = 0; i < document_.size("nodes"); ++i) {
    UMOV_ASSIGN(list,
                node_list(document_.entry("nodes", i), "children", fmt::format("nodes[{}]", i)));
    children.insert(list.begin(), list.end());
  }
  std::vector<std::size_t> out;
  for (std::size_t i = 0; i < document_.size("nodes"); ++i)
    if (!children.contains(i))
      out.push_back(i);
  return out;
}

Result<void> GltfReader::push(const std::vector<std::size_t> &nodes, const Placement &parent,
                              const std::string &path, std::size_t depth) {
  std::set<std::string> names;
  std::vector<Pending> found;
  for (const std::size_t node : nodes) {
    if (is_reached_[node])
      return document_.bad(fmt::format("nodes[{}]", node), "reached twice", "a tree of nodes");
    is_reached_[node] = true;
    std::string name = gltf::name_of(document_.entry("nodes", node));
    if (name.empty())
      name = fmt::format("node_{}", node);
    if (!names.insert(name).second) {
      name += fmt::format("#{}", node);
      names.insert(name);
    }
    found.push_back({node, depth, parent, joined_path(path, name)});
    if (depth > deepest_node)
      return document_.bad(fmt::format("nodes[{}]", node),
                           fmt::format("{} deep in the tree", depth),
                           fmt::format("at most {}", deepest_node));
    if (found.back().path.size() > longest_path)
      return document_.bad(
          fmt::format("nodes[{}]", node),
          fmt::format("{} deep in the tree, under names of {} letters", depth,
                      found.back().path.size()),
          fmt::format("at most {} letters of all names on the way together", longest_path));
  }
  pending_.insert(pending_.end(), found.rbegin(), found.rend());
  return {};
}

Result<void> GltfReader::add(const Primitive &primitive, const Placement &place,
                             std::uint32_t group) {
  Mesh &mesh = out_.mesh;
  if (++instances_ > most_instances ||
      mesh.triangles.size() + primitive.triangles.size() > options_.max_triangles)
    return too_many_triangles(options_.max_triangles, {document_.file()});
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  const auto first_normal = static_cast<std::uint32_t>(mesh.normals.size());
  for (const Vec3<Body> p : primitive.positions) {
    mesh.positions.push_back(place.point(p));
    if (is_out_of_reach(mesh.positions.back()))
      return document_.bad("a vertex placed by its nodes", point_text(mesh.positions.back()),
                           fmt::format("finite numbers up to {:g}", farthest));
  }
  for (const Vec3<Body> n : primitive.normals) {
    const Vec3<Body> turned = place.normal(n);
    const double length = norm(turned);
    mesh.normals.push_back(length > 0 && std::isfinite(length) ? turned / length : Vec3<Body>{});
  }
  const bool is_mirrored = place.determinant() < 0;
  for (auto corners : primitive.triangles) {
    leave_if_stopped(options_.cancel, mesh.triangles.size());
    if (is_mirrored)
      std::swap(corners[1], corners[2]);
    Triangle triangle;
    triangle.front = triangle.back = group;
    std::array<Vec3<Body>, 3> at;
    std::array<std::array<double, 2>, 3> uv{};
    for (std::size_t k = 0; k < 3; ++k) {
      triangle.vertex[k] = first + corners[k];
      at[k] = mesh.positions[triangle.vertex[k]];
      if (!primitive.normals.empty())
        triangle.normal[k] = first_normal + corners[k];
      if (!primitive.textures.empty())
        uv[k] = primitive.textures[corners[k]];
    }
    mesh.triangles.push_back(triangle);
    mesh.tangents.push_back(primitive.textures.empty() ? Vec3<Body>{} : texture_tangent(at, uv));
  }
  has_textures_ = has_textures_ || !primitive.textures.empty();
  return {};
}

Result<void> GltfReader::take_node(const Pending &at) {
  const Json &json = document_.entry("nodes", at.node);
  const std::string place = fmt::format("nodes[{}]", at.node);
  UMOV_ASSIGN(own, gltf::placement_of(document_, at.node));
  const Placement here = at.parent * own;
  UMOV_ASSIGN(which, document_.index(json, "mesh", place, "meshes"));
  if (which) {
    if (json.contains("skin"))
      return fail(ErrorCode::BadInput,
                  fmt::format("{} (\"{}\") is bent by a skeleton (skin), which umov does not read. "
                              "Apply the skeleton before exporting.",
                              place, at.path),
                  {document_.file()});
    UMOV_ASSIGN(primitives, primitives_.mesh(*which));
    const std::size_t before = out_.mesh.triangles.size();
    const std::string name = at.path.substr(at.path.rfind('/') + 1);
    for (const Primitive &one : *primitives)
      if (!one.triangles.empty())
        UMOV_TRY(add(one, here, groups_.of(one.material.empty() ? name : one.material, at.path)));
    if (out_.mesh.triangles.size() > before)
      out_.nodes.push_back({at.path, here.origin, out_.mesh.triangles.size() - before});
    if (out_.nodes.size() > most_nodes_with_faces)
      return document_.bad("the number of nodes with faces",
                           fmt::format("above {}", most_nodes_with_faces), "fewer; join some");
  }
  UMOV_ASSIGN(children, node_list(json, "children", place));
  return push(children, here, at.path, at.depth + 1);
}

Result<MeshFile> GltfReader::read(Diagnostics &diagnostics) {
  out_.format = "glTF";
  is_reached_.assign(document_.size("nodes"), false);
  UMOV_ASSIGN(first, roots(diagnostics));
  UMOV_TRY(push(first, {}, "", 1));
  while (!pending_.empty()) {
    const Pending next = std::move(pending_.back());
    pending_.pop_back();
    UMOV_TRY(take_node(next));
  }
  if (!has_textures_)
    out_.mesh.tangents.clear();
  join_equal(out_.mesh, options_.cancel);
  out_.files = document_.files();
  const auto warn = [&](bool is_so, const std::string &what) {
    if (is_so)
      diagnostics.warn(what, {document_.file()});
  };
  warn(primitives_.skipped().points_and_lines > 0,
       fmt::format("{} primitives of points or lines were skipped: they have no area",
                   primitives_.skipped().points_and_lines));
  warn(primitives_.skipped().morphs > 0,
       fmt::format("{} primitives have morph targets; they were read as they stand without",
                   primitives_.skipped().morphs));
  warn(document_.size("animations") > 0,
       "the animations of the file are not read; nodes turn by [[object.part]] in a scenario");
  return std::move(out_);
}

} // namespace

Result<MeshFile> read_gltf(std::string_view bytes, const std::filesystem::path &path,
                           const MeshFileOptions &options, Diagnostics &diagnostics) {
  const std::size_t max_elements = 3 * options.max_triangles;
  UMOV_ASSIGN(document, Document::open(bytes, path, max_elements, options.cancel));
  return GltfReader(document, options).read(diagnostics);
}

} // namespace umov::mesh_io
