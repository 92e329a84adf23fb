// Writes glTF 2.0: one mesh for each node of the tree, one primitive for each material on it.

#include "io/mesh/bytes.h"
#include "io/mesh/readers.h"

#include <algorithm>
#include <array>
#include <map>
#include <nlohmann/json.hpp>

namespace umov::mesh_io {
namespace {

using OrderedJson = nlohmann::ordered_json;

constexpr int number_float = 5126, number_uint = 5125, for_vertices = 34962, for_indices = 34963;

/// A side of a triangle in the order of its corners.
struct Side {
  const Triangle *triangle;
  bool is_back;
};

class Writer {
public:
  explicit Writer(const Mesh &mesh) : mesh_(mesh) {}
  void write();

  OrderedJson json;
  std::string buffer;

private:
  std::size_t node(const std::string &path);
  std::size_t material(const std::string &name);
  OrderedJson primitive(const std::vector<Side> &sides);
  std::size_t accessor(const std::string &bytes, std::size_t count, const char *type, int target);

  const Mesh &mesh_;
  std::map<std::string, std::size_t> nodes_, materials_;
};

/// Body +Z up to the +Y up of the format.
std::array<float, 3> turned(Vec3<Body> v) {
  return {static_cast<float>(v.x), static_cast<float>(v.z), static_cast<float>(-v.y)};
}

std::size_t Writer::material(const std::string &name) {
  const auto [entry, is_new] = materials_.emplace(name, materials_.size());
  if (is_new)
    json["materials"].push_back({{"name", name}, {"doubleSided", true}});
  return entry->second;
}

/// The node of a path, with those above it.
std::size_t Writer::node(const std::string &path) {
  if (const auto known = nodes_.find(path); known != nodes_.end())
    return known->second;
  const std::size_t slash = path.rfind('/');
  const bool is_root = slash == std::string::npos;
  const std::size_t parent = is_root ? 0 : node(path.substr(0, slash));
  const std::size_t here = json["nodes"].size();
  json["nodes"].push_back({{"name", is_root ? path : path.substr(slash + 1)}});
  if (is_root)
    json["scenes"][0]["nodes"].push_back(here);
  else
    json["nodes"][parent]["children"].push_back(here);
  return nodes_[path] = here;
}

std::size_t Writer::accessor(const std::string &bytes, std::size_t count, const char *type,
                             int target) {
  json["bufferViews"].push_back({{"buffer", 0},
                                 {"byteOffset", buffer.size()},
                                 {"byteLength", bytes.size()},
                                 {"target", target}});
  json["accessors"].push_back(
      {{"bufferView", json["bufferViews"].size() - 1},
       {"componentType", target == for_indices ? number_uint : number_float},
       {"count", count},
       {"type", type}});
  buffer += bytes;
  return json["accessors"].size() - 1;
}

OrderedJson Writer::primitive(const std::vector<Side> &sides) {
  std::map<std::array<std::uint32_t, 2>, std::uint32_t> place;
  std::string positions, normals, indices;
  std::array<float, 3> low{}, high{};
  const bool has_normals = std::all_of(sides.begin(), sides.end(), [](const Side &side) {
    return side.triangle->normal[0] != no_index;
  });
  for (const auto &[triangle, is_back] : sides)
    for (const std::size_t k :
         is_back ? std::array<std::size_t, 3>{0, 2, 1} : std::array<std::size_t, 3>{0, 1, 2}) {
      const std::array key{triangle->vertex[k], has_normals ? triangle->normal[k] : no_index};
      const auto [entry, is_new] = place.emplace(key, static_cast<std::uint32_t>(place.size()));
      append(indices, entry->second);
      if (!is_new)
        continue;
      const auto p = turned(mesh_.positions[key[0]]);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        append(positions, p[axis]);
        low[axis] = place.size() == 1 ? p[axis] : std::min(low[axis], p[axis]);
        high[axis] = place.size() == 1 ? p[axis] : std::max(high[axis], p[axis]);
      }
      if (has_normals)
        for (const float value : turned(mesh_.normals[key[1]]))
          append(normals, value);
    }
  OrderedJson out;
  out["attributes"]["POSITION"] = accessor(positions, place.size(), "VEC3", for_vertices);
  json["accessors"].back()["min"] = low; // required for positions
  json["accessors"].back()["max"] = high;
  if (has_normals)
    out["attributes"]["NORMAL"] = accessor(normals, place.size(), "VEC3", for_vertices);
  out["indices"] = accessor(indices, 3 * sides.size(), "SCALAR", for_indices);
  return out;
}

void Writer::write() {
  json["asset"] = {{"version", "2.0"}, {"generator", "umov"}};
  json["scene"] = 0;
  std::vector<std::vector<Side>> sides(mesh_.groups.size());
  for (const Triangle &t : mesh_.triangles) {
    sides[t.front].push_back({&t, false});
    if (t.back != t.front)
      sides[t.back].push_back({&t, true});
  }
  for (std::size_t g = 0; g < mesh_.groups.size(); ++g) {
    if (sides[g].empty())
      continue;
    const std::size_t at = node(mesh_.nodes.empty() ? "object" : mesh_.nodes[g]);
    OrderedJson one = primitive(sides[g]);
    one["material"] = material(mesh_.groups[g]);
    if (!json["nodes"][at].contains("mesh")) {
      json["nodes"][at]["mesh"] = json["meshes"].size();
      json["meshes"].push_back({{"name", json["nodes"][at]["name"]}});
    }
    json["meshes"][json["nodes"][at]["mesh"].get<std::size_t>()]["primitives"].push_back(one);
  }
  json["buffers"].push_back({{"byteLength", buffer.size()}});
}

std::string in_base64(const std::string &bytes) {
  constexpr char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t bits = 0;
    for (std::size_t k = 0; k < 3; ++k)
      bits = bits << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k)
      out += i + k <= bytes.size() ? digits[bits >> (18 - 6 * k) & 63] : '=';
  }
  return out;
}

} // namespace

std::string write_glb(const Mesh &mesh) {
  Writer writer(mesh);
  writer.write();
  std::string json = writer.json.dump(-1, ' ', false, OrderedJson::error_handler_t::replace);
  json.resize((json.size() + 3) / 4 * 4, ' ');
  writer.buffer.resize((writer.buffer.size() + 3) / 4 * 4, '\0');
  std::string out = "glTF";
  append(out, std::uint32_t{2});
  append(out, static_cast<std::uint32_t>(28 + json.size() + writer.buffer.size()));
  append(out, static_cast<std::uint32_t>(json.size()));
  out += "JSON" + json;
  append(out, static_cast<std::uint32_t>(writer.buffer.size()));
  out += std::string("BIN\0", 4) + writer.buffer;
  return out;
}

std::string write_gltf(const Mesh &mesh) {
  Writer writer(mesh);
  writer.write();
  writer.json["buffers"][0]["uri"] =
      "data:application/octet-stream;base64," + in_base64(writer.buffer);
  return writer.json.dump(1, ' ', false, OrderedJson::error_handler_t::replace) + "\n";
}

} // namespace umov::mesh_io
