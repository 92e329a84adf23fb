// A scene as the child that runs Assimp hands it over: a hostile file may have led that child
// astray. What is read is packed again from a scene of Assimp's.

#include "fuzz/mesh.h"

#include "io/mesh/assimp_scene.h"

#include <assimp/material.h>
#include <assimp/scene.h>
#include <memory>

namespace {

using namespace umov;

aiVector3D single(Vec3<Body> v) {
  return {static_cast<ai_real>(v.x), static_cast<ai_real>(v.y), static_cast<ai_real>(v.z)};
}

aiNode *child(aiNode &parent, unsigned k, const char *name) {
  auto node = std::make_unique<aiNode>(name);
  node->mParent = &parent;
  return parent.mChildren[k] = node.release();
}

void make_children(aiNode &node, unsigned count) {
  node.mChildren = new aiNode *[count]();
  node.mNumChildren = count;
}

/// One triangle with its own corners, mirrored at x = 0 if so; with texture coordinates where the
/// mesh has tangents, which lie along its first side then.
std::unique_ptr<aiMesh> mesh_of(const Mesh &mesh, std::size_t triangle, bool is_mirrored) {
  const Triangle &t = mesh.triangles[triangle];
  auto out = std::make_unique<aiMesh>();
  out->mMaterialIndex = t.front;
  out->mNumVertices = 3;
  out->mVertices = new aiVector3D[3];
  if (t.normal[0] != no_index)
    out->mNormals = new aiVector3D[3];
  if (!mesh.tangents.empty())
    out->mTextureCoords[0] = new aiVector3D[3]{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  const ai_real x = is_mirrored ? -1.0F : 1.0F;
  for (std::size_t k = 0; k < 3; ++k) {
    out->mVertices[k] = single(mesh.positions[t.vertex[k]]);
    out->mVertices[k].x *= x;
    if (out->mNormals != nullptr) {
      out->mNormals[k] = single(mesh.normals[t.normal[k]]);
      out->mNormals[k].x *= x;
    }
  }
  out->mNumFaces = 1;
  out->mFaces = new aiFace[1];
  out->mFaces[0].mNumIndices = 3;
  out->mFaces[0].mIndices = is_mirrored ? new unsigned[3]{2, 1, 0} : new unsigned[3]{0, 1, 2};
  return out;
}

/// Below a root of twice the size, which is to be dropped: a node with a mesh for each triangle.
/// Every second node mirrors it, every third has no name.
std::unique_ptr<aiScene> scene_of(const Mesh &mesh) {
  auto out = std::make_unique<aiScene>();
  const auto triangles = static_cast<unsigned>(mesh.triangles.size());
  out->mMeshes = new aiMesh *[triangles]();
  out->mNumMeshes = triangles;
  out->mNumMaterials = static_cast<unsigned>(mesh.groups.size());
  out->mMaterials = new aiMaterial *[out->mNumMaterials]();
  for (unsigned k = 0; k < out->mNumMaterials; ++k) {
    const aiString name(mesh.groups[k]);
    out->mMaterials[k] = new aiMaterial;
    out->mMaterials[k]->AddProperty(&name, AI_MATKEY_NAME);
  }
  aiNode &root = *(out->mRootNode = new aiNode("root"));
  root.mTransformation = aiMatrix4x4({2, 2, 2}, aiQuaternion(), {0, 0, 0});
  make_children(root, triangles);
  for (unsigned k = 0; k < triangles; ++k) {
    const bool is_mirrored = k % 2 == 1;
    aiNode &node = *child(root, k, k % 3 == 0 ? "" : "part");
    node.mTransformation.a1 = is_mirrored ? -1 : 1;
    node.mMeshes = new unsigned[1]{k};
    node.mNumMeshes = 1;
    out->mMeshes[k] = mesh_of(mesh, k, is_mirrored).release();
  }
  return out;
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
  const auto reader = [](std::string_view bytes, const MeshFileOptions &options,
                         Diagnostics &diagnostics) {
    return mesh_io::unpack_scene(bytes, "input", options, diagnostics);
  };
  const auto pack = [](const Mesh &mesh) { return mesh_io::pack_scene(*scene_of(mesh), true); };
  return fuzz::try_format(fuzz::text_of(data, size), fuzz::mesh_options(), reader, pack);
}
