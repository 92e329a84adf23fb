// STL, text and binary.

#include "fuzz/mesh.h"

#include "io/mesh/readers.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
  using namespace umov;
  const auto reader = [](std::string_view bytes, const MeshFileOptions &options,
                         Diagnostics &diagnostics) {
    return mesh_io::read_stl(bytes, "input", options, diagnostics);
  };
  return fuzz::try_format(fuzz::text_of(data, size), fuzz::mesh_options(), reader,
                          mesh_io::write_stl);
}
