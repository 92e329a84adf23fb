// A scene as the child that runs Assimp hands it over: a hostile file may have led that child
// astray.

#include "fuzz/mesh.h"

#include "io/mesh/assimp_scene.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
  using namespace umov;
  const auto reader = [](std::string_view bytes, const MeshFileOptions &options,
                         Diagnostics &diagnostics) {
    return mesh_io::unpack_scene(bytes, "input", options, diagnostics);
  };
  return fuzz::try_format(fuzz::text_of(data, size), fuzz::mesh_options(), reader);
}
