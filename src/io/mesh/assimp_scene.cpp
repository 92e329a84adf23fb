#include "io/mesh/assimp_scene.h"

#include "io/mesh/bytes.h"

#include <algorithm>
#include <array>
#include <assimp/material.h>
#include <assimp/scene.h>
#include <cmath>
#include <fmt/format.h>
#include <umov/core/stop.h>

namespace umov::mesh_io {
namespace {

void append_text(std::string &out, const std::string &text) {
  append(out, static_cast<std::uint32_t>(text.size()));
  out += text;
}

class Packer {
public:
  Packer(const aiScene &scene) : scene_(scene) {}

  void node(const aiNode &node, const aiMatrix4x4 &parent, const std::string &path, int depth) {
    constexpr int deepest = 256;
    const aiMatrix4x4 here = parent * node.mTransformation;
    for (unsigned i = 0; i < node.mNumMeshes; ++i)
      mesh(*scene_.mMeshes[node.mMeshes[i]], here, path.empty() ? "object" : path);
    for (unsigned i = 0; i < node.mNumChildren && depth < deepest; ++i) {
      std::string name = clean_name(node.mChildren[i]->mName.C_Str());
      if (name.empty())
        name = fmt::format("node_{}", i);
      this->node(*node.mChildren[i], here, joined_path(path, name), depth + 1);
    }
  }

  std::string out;

private:
  void mesh(const aiMesh &mesh, const aiMatrix4x4 &at, const std::string &path);
  void vertices(const aiMesh &mesh, const aiMatrix4x4 &at);

  const aiScene &scene_;
};

void Packer::vertices(const aiMesh &mesh, const aiMatrix4x4 &at) {
  // Directions of normals by the cofactors, which exist for flat scales too.
  const aiMatrix3x3 linear(at);
  const aiVector3D x(linear.a1, linear.b1, linear.c1), y(linear.a2, linear.b2, linear.c2),
      z(linear.a3, linear.b3, linear.c3);
  const ai_real sign = linear.Determinant() < 0 ? -1 : 1;
  const aiVector3D yz = (y ^ z) * sign, zx = (z ^ x) * sign, xy = (x ^ y) * sign;
  for (unsigned v = 0; v < mesh.mNumVertices; ++v) {
    const aiVector3D p = at * mesh.mVertices[v];
    for (const ai_real value : {p.x, p.y, p.z})
      append(out, static_cast<double>(value));
    if (mesh.mNormals != nullptr) {
      const aiVector3D &m = mesh.mNormals[v];
      const aiVector3D n = yz * m.x + zx * m.y + xy * m.z;
      for (const ai_real value : {n.x, n.y, n.z})
        append(out, static_cast<double>(value));
    }
    if (mesh.mTextureCoords[0] != nullptr) {
      append(out, static_cast<double>(mesh.mTextureCoords[0][v].x));
      append(out, static_cast<double>(mesh.mTextureCoords[0][v].y));
    }
  }
}

void Packer::mesh(const aiMesh &mesh, const aiMatrix4x4 &at, const std::string &path) {
  std::string material;
  if (mesh.mMaterialIndex < scene_.mNumMaterials)
    material = clean_name(scene_.mMaterials[mesh.mMaterialIndex]->GetName().C_Str());
  if (material == AI_DEFAULT_MATERIAL_NAME) // made up by Assimp
    material.clear();
  append_text(out, path);
  append_text(out, material);
  for (const ai_real value : {at.a4, at.b4, at.c4})
    append(out, static_cast<double>(value));
  append(out, std::uint8_t{mesh.mNormals != nullptr});
  append(out, std::uint8_t{mesh.mTextureCoords[0] != nullptr});
  append(out, mesh.mNumVertices);
  vertices(mesh, at);
  const bool is_mirrored = at.Determinant() < 0;
  append(out, mesh.mNumFaces);
  for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
    const aiFace &face = mesh.mFaces[f];
    append(out, face.mNumIndices);
    for (unsigned k = 0; k < face.mNumIndices; ++k)
      append(out, face.mIndices[is_mirrored ? face.mNumIndices - 1 - k : k]);
  }
}

/// Takes packed numbers one after the other; what is not there becomes 0 and `is_short`.
class Unpacker {
public:
  explicit Unpacker(std::string_view bytes) : bytes_(bytes) {}

  template <class T> T take() {
    if (bytes_.size() - at_ < sizeof(T)) {
      at_ = bytes_.size();
      is_short = true;
      return T{};
    }
    at_ += sizeof(T);
    return number_at<T>(bytes_, at_ - sizeof(T));
  }
  std::string text() {
    const std::size_t size = take<std::uint32_t>();
    if (size > bytes_.size() - at_) {
      is_short = true;
      return {};
    }
    at_ += size;
    return std::string(bytes_.substr(at_ - size, size));
  }
  Vec3<Body> vector() {
    const double x = take<double>(), y = take<double>(), z = take<double>();
    return {x, y, z};
  }
  [[nodiscard]] bool has_more() const { return !is_short && at_ < bytes_.size(); }

  bool is_short = false;

private:
  std::string_view bytes_;
  std::size_t at_ = 0;
};

class Builder {
public:
  Builder(std::string_view bytes, const std::string &file, const MeshFileOptions &options)
      : from_(bytes), file_(file), cancel_(options.cancel), polygons_(out_.mesh, options) {}

  Result<MeshFile> build(Diagnostics &diagnostics);

private:
  Result<void> vertices(bool has_normals, bool has_textures, std::size_t count);
  Result<void> piece();
  Result<void> faces(const std::string &name, const std::string &path,
                     const std::array<std::size_t, 3> &first, std::size_t vertices);
  [[nodiscard]] tl::unexpected<Error> bad(const std::string &what) const {
    return fail(ErrorCode::BadInput, what + ". Export the file again, best as glTF (.glb).",
                {file_});
  }

  Unpacker from_;
  const std::string &file_;
  const std::atomic<bool> *cancel_;
  MeshFile out_;
  GroupIndex groups_{out_.mesh};
  PolygonMaker polygons_;
};

Result<void> Builder::vertices(bool has_normals, bool has_textures, std::size_t count) {
  for (std::size_t v = 0; v < count && !from_.is_short; ++v) {
    leave_if_stopped(cancel_, v);
    out_.mesh.positions.push_back(from_.vector());
    if (is_out_of_reach(out_.mesh.positions.back()))
      return bad(fmt::format("a vertex at {}; finite coordinates up to {:g} were expected",
                             point_text(out_.mesh.positions.back()), farthest));
    if (has_normals) {
      const Vec3<Body> n = from_.vector();
      const double length = norm(n);
      out_.mesh.normals.push_back(length > 0 && std::isfinite(length) ? n / length : Vec3<Body>{});
    }
    if (has_textures) {
      const double u = from_.take<double>();
      polygons_.textures.push_back({u, from_.take<double>()});
    }
  }
  return {};
}

Result<void> Builder::faces(const std::string &name, const std::string &path,
                            const std::array<std::size_t, 3> &first, std::size_t vertices) {
  const std::size_t count = from_.take<std::uint32_t>();
  const auto at = [](std::size_t begin, std::size_t end, std::uint32_t i) {
    return begin == end ? no_index : static_cast<std::uint32_t>(begin) + i;
  };
  std::vector<Corner> corners;
  for (std::size_t f = 0; f < count && !from_.is_short; ++f) {
    corners.clear();
    const std::size_t size = from_.take<std::uint32_t>();
    for (std::size_t k = 0; k < size && !from_.is_short; ++k) {
      const auto i = from_.take<std::uint32_t>();
      if (i >= vertices)
        return bad(fmt::format("a face names vertex {} of {}", i, vertices));
      corners.push_back({at(first[0], out_.mesh.positions.size(), i),
                         at(first[1], out_.mesh.normals.size(), i),
                         at(first[2], polygons_.textures.size(), i)});
    }
    UMOV_TRY(polygons_.add(corners, size < 3 ? 0 : groups_.of(name, path), {file_}));
  }
  return {};
}

Result<void> Builder::piece() {
  const std::string path = from_.text(), material = from_.text();
  const Vec3<Body> origin = from_.vector();
  const bool has_normals = from_.take<std::uint8_t>() != 0;
  const bool has_textures = from_.take<std::uint8_t>() != 0;
  const std::size_t count = from_.take<std::uint32_t>();
  const std::array first{out_.mesh.positions.size(), out_.mesh.normals.size(),
                         polygons_.textures.size()};
  UMOV_TRY(vertices(has_normals, has_textures, count));
  const std::size_t before = out_.mesh.triangles.size();
  const std::string name = path.substr(path.rfind('/') + 1);
  UMOV_TRY(faces(material.empty() ? name : material, path, first, count));
  const std::size_t made = out_.mesh.triangles.size() - before;
  if (!out_.nodes.empty() && out_.nodes.back().path == path) // its meshes come one after the other
    out_.nodes.back().triangles += made;
  else if (made > 0)
    out_.nodes.push_back({path, origin, made});
  return {};
}

Result<MeshFile> Builder::build(Diagnostics &diagnostics) {
  while (from_.has_more())
    UMOV_TRY(piece());
  if (from_.is_short)
    return bad("the scene that was read is not complete");
  polygons_.finish();
  polygons_.warn(diagnostics, {file_});
  join_equal(out_.mesh, cancel_);
  return std::move(out_);
}

} // namespace

std::string pack_scene(const aiScene &scene, bool drops_root) {
  Packer packer(scene);
  if (scene.mRootNode == nullptr)
    return {};
  aiMatrix4x4 undo;
  if (drops_root)
    undo = aiMatrix4x4(scene.mRootNode->mTransformation).Inverse();
  packer.node(*scene.mRootNode, undo, "", 0);
  return std::move(packer.out);
}

Result<MeshFile> unpack_scene(std::string_view bytes, const std::string &file,
                              const MeshFileOptions &options, Diagnostics &diagnostics) {
  return Builder(bytes, file, options).build(diagnostics);
}

} // namespace umov::mesh_io
