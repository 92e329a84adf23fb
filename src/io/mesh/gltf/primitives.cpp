#include "io/mesh/gltf/primitives.h"

#include "io/mesh/mesh_parts.h"

#include <fmt/format.h>
#include <umov/core/stop.h>
#include <unordered_map>

namespace umov::mesh_io::gltf {
namespace {

enum Mode : std::size_t { Triangles = 4, Strip = 5, Fan = 6 };

/// The k-th triangle of a primitive as places in its list of indices.
std::array<std::size_t, 3> corners_of(std::size_t mode, std::size_t k) {
  if (mode == Strip)
    return k % 2 == 0 ? std::array{k, k + 1, k + 2} : std::array{k + 1, k, k + 2};
  if (mode == Fan)
    return {k + 1, k + 2, 0};
  return {3 * k, 3 * k + 1, 3 * k + 2};
}

Vec3<Body> vector_at(const Accessor &from, std::size_t i) {
  return {from.value(i, 0), from.value(i, 1), from.value(i, 2)};
}

} // namespace

std::string name_of(const Json &json) {
  const auto found = json.find("name");
  return found == json.end() || !found->is_string() ? std::string()
                                                    : clean_name(found->get<std::string>());
}

std::string material_name(const Document &document, std::size_t i) {
  const std::string name = name_of(document.entry("materials", i));
  return name.empty() ? fmt::format("material_{}", i) : name;
}

Result<const Accessor *> PrimitiveReader::attribute(const Json &attributes, const char *key,
                                                    const std::string &place,
                                                    std::size_t components) {
  UMOV_ASSIGN(which, document_.index(attributes, key, place, "accessors"));
  if (!which)
    return nullptr;
  UMOV_ASSIGN(out, document_.accessor(*which));
  if (out->components() != components)
    return document_.bad(fmt::format("{}.{}", place, key),
                         fmt::format("an accessor of {} components", out->components()),
                         std::to_string(components));
  return out;
}

Result<PrimitiveReader::Sources> PrimitiveReader::sources(const Json &json,
                                                          const std::string &place) {
  Sources out;
  const auto attributes = json.find("attributes");
  if (attributes == json.end() || !attributes->is_object())
    return document_.bad(place, "without \"attributes\"", "POSITION among its attributes");
  UMOV_ASSIGN(position, attribute(*attributes, "POSITION", place, 3));
  UMOV_ASSIGN(normal, attribute(*attributes, "NORMAL", place, 3));
  UMOV_ASSIGN(texture, attribute(*attributes, "TEXCOORD_0", place, 2));
  UMOV_ASSIGN(index, document_.index(json, "indices", place, "accessors"));
  out = {position, normal, texture, nullptr};
  if (position != nullptr)
    for (const Accessor *other : {normal, texture})
      if (other != nullptr && other->count() != position->count())
        return document_.bad(place,
                             fmt::format("{} positions and {} normals or texture coordinates",
                                         position->count(), other->count()),
                             "as many of each");
  if (index) {
    UMOV_ASSIGN(list, document_.accessor(*index));
    if (!list->is_index())
      return document_.bad(place + ".indices", "an accessor of another kind",
                           "SCALAR with componentType 5121, 5123 or 5125");
    out.index = list;
  }
  return out;
}

Result<void> PrimitiveReader::take_corners(const Sources &from, std::size_t mode,
                                           const std::string &place, Primitive &out) {
  const std::size_t corners = from.index != nullptr ? from.index->count() : from.position->count();
  const std::size_t count = mode == Triangles ? corners / 3 : corners < 3 ? 0 : corners - 2;
  triangles_ += count;
  if (triangles_ > options_.max_triangles)
    return too_many_triangles(options_.max_triangles, {document_.file()});
  std::unordered_map<std::size_t, std::uint32_t> places;
  for (std::size_t t = 0; t < count; ++t) {
    leave_if_stopped(options_.cancel, t);
    const auto at = corners_of(mode, t);
    std::array<std::uint32_t, 3> triangle{};
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t vertex =
          from.index != nullptr ? static_cast<std::size_t>(from.index->value(at[k], 0)) : at[k];
      if (vertex >= from.position->count())
        return document_.bad(fmt::format("{}.indices, number {},", place, at[k]),
                             std::to_string(vertex),
                             fmt::format("a number below {}", from.position->count()));
      const auto [entry, is_new] =
          places.emplace(vertex, static_cast<std::uint32_t>(out.positions.size()));
      triangle[k] = entry->second;
      if (!is_new)
        continue;
      out.positions.push_back(vector_at(*from.position, vertex));
      if (from.normal != nullptr)
        out.normals.push_back(vector_at(*from.normal, vertex));
      if (from.texture != nullptr)
        out.textures.push_back({from.texture->value(vertex, 0), from.texture->value(vertex, 1)});
      for (const Vec3<Body> v :
           {out.positions.back(), from.normal != nullptr ? out.normals.back() : Vec3<Body>{}})
        if (is_out_of_reach(v))
          return document_.bad(fmt::format("{}, vertex {},", place, vertex), point_text(v),
                               fmt::format("finite numbers up to {:g}", farthest));
    }
    out.triangles.push_back(triangle);
  }
  return {};
}

Result<Primitive> PrimitiveReader::read(const Json &json, const std::string &place,
                                        bool &is_surface) {
  Primitive out;
  UMOV_ASSIGN(mode, document_.whole(json, "mode", place, Triangles, 0, Fan));
  is_surface = mode >= Triangles;
  if (!is_surface)
    return out;
  const auto extensions = json.find("extensions");
  if (extensions != json.end() && extensions->is_object() &&
      extensions->contains("KHR_draco_mesh_compression"))
    return fail(ErrorCode::BadInput,
                fmt::format("{} is compressed (KHR_draco_mesh_compression), which umov does not "
                            "read. Export the file without compression.",
                            place),
                {document_.file()});
  UMOV_ASSIGN(from, sources(json, place));
  if (from.position == nullptr)
    return document_.bad(place, "without POSITION", "positions");
  UMOV_ASSIGN(material, document_.index(json, "material", place, "materials"));
  if (material)
    out.material = material_name(document_, *material);
  skipped_.morphs += json.contains("targets") ? 1u : 0u;
  UMOV_TRY(take_corners(from, mode, place, out));
  return out;
}

Result<const std::vector<Primitive> *> PrimitiveReader::mesh(std::size_t i) {
  if (const auto known = known_.find(i); known != known_.end())
    return &known->second;
  const Json &json = document_.entry("meshes", i);
  const auto list = json.find("primitives");
  if (list == json.end() || !list->is_array())
    return document_.bad(fmt::format("meshes[{}]", i), "without \"primitives\"", "a list of them");
  std::vector<Primitive> out;
  for (std::size_t k = 0; k < list->size(); ++k) {
    const std::string place = fmt::format("meshes[{}].primitives[{}]", i, k);
    if (!(*list)[k].is_object())
      return document_.bad(place, "no object", "one");
    bool is_surface = true;
    UMOV_ASSIGN(one, read((*list)[k], place, is_surface));
    if (is_surface)
      out.push_back(std::move(one));
    else
      ++skipped_.points_and_lines;
  }
  return &known_.emplace(i, std::move(out)).first->second;
}

} // namespace umov::mesh_io::gltf
