// glTF 2.0 as JSON and as GLB.

#include "fuzz/mesh.h"

#include "io/mesh/mesh_parts.h"
#include "io/mesh/readers.h"

namespace {

umov::Result<umov::MeshFile> read(std::string_view bytes) {
  using namespace umov;
  Diagnostics diagnostics;
  const MeshFileOptions options = fuzz::mesh_options("m", "+Y");
  auto out = mesh_io::read_gltf(bytes, fuzz::nowhere, options, diagnostics);
  if (out)
    UMOV_TRY(mesh_io::to_body_frame(*out, options, "input", diagnostics));
  return out;
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
  using namespace umov;
  const auto mesh = read(fuzz::text_of(data, size));
  if (!fuzz::is_read(mesh))
    return 0;
  fuzz::check_mesh(mesh->mesh);
  fuzz::check_written_twice(mesh->mesh, read, mesh_io::write_glb);
  fuzz::check_written_twice(mesh->mesh, read, mesh_io::write_gltf);
  return 0;
}
