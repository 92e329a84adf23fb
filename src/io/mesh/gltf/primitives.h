#pragma once
// Private: the triangles of a glTF mesh before any node places them.

#include "io/mesh/gltf/document.h"

#include <array>
#include <map>
#include <umov/core/vec3.h>

namespace umov::mesh_io::gltf {

struct Primitive {
  std::string material; ///< "" without one
  std::vector<Vec3<Body>> positions, normals;
  std::vector<std::array<double, 2>> textures;         ///< u, v
  std::vector<std::array<std::uint32_t, 3>> triangles; ///< into the lists above
};

/// What was left out, for warnings.
struct Skipped {
  std::size_t points_and_lines = 0, morphs = 0;
};

/// Reads primitives, each mesh once; only corners that a triangle uses are kept.
class PrimitiveReader {
public:
  /// Throws Failure (Interrupted) where MeshFileOptions::cancel comes true.
  PrimitiveReader(Document &document, const MeshFileOptions &options)
      : document_(document), options_(options) {}

  Result<const std::vector<Primitive> *> mesh(std::size_t i);
  [[nodiscard]] const Skipped &skipped() const { return skipped_; }

private:
  struct Sources {
    const Accessor *position = nullptr, *normal = nullptr, *texture = nullptr, *index = nullptr;
  };
  Result<Primitive> read(const Json &json, const std::string &place, bool &is_surface);
  Result<Sources> sources(const Json &json, const std::string &place);
  Result<const Accessor *> attribute(const Json &attributes, const char *key,
                                     const std::string &place, std::size_t components);
  Result<void> take_corners(const Sources &from, std::size_t mode, const std::string &place,
                            Primitive &out);

  Document &document_;
  const MeshFileOptions &options_;
  std::size_t triangles_ = 0;
  std::map<std::size_t, std::vector<Primitive>> known_;
  Skipped skipped_;
};

/// The name of a material, made up where it has none.
std::string material_name(const Document &document, std::size_t i);
/// The text under "name", cleaned; "" where there is none.
std::string name_of(const Json &json);

} // namespace umov::mesh_io::gltf
