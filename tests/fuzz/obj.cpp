// Wavefront OBJ. OBJ keeps every bit.

#include "fuzz/mesh.h"

#include <algorithm>
#include <umov/io/obj.h>

namespace {

umov::Result<std::string> no_mtl(const std::string & /*name*/) {
  return umov::fail(umov::ErrorCode::BadInput, "there is none");
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
  using namespace umov;
  Diagnostics diagnostics;
  const auto read =
      read_obj_text(fuzz::text_of(data, size), "input", fuzz::mesh_options(), no_mtl, diagnostics);
  if (!fuzz::is_read(read))
    return 0;
  fuzz::check_mesh(read->mesh);
  for (const char *up : {"+X", "+Y", "-X", "-Y", "-Z", "", "+W"}) // what the user says of the file
    for (const char *unit : {"km", "", "parsec"})
      fuzz::is_read(read_obj_text(fuzz::text_of(data, std::min<std::size_t>(size, 500)), "input",
                                  fuzz::mesh_options(unit, up), no_mtl, diagnostics));
  const ObjText text = write_obj(read->mesh, "input", MtlUse::None);
  const auto back =
      fuzz::must(read_obj_text(text.obj, "written", fuzz::mesh_options(), no_mtl, diagnostics),
                 "a mesh is written so that it can be read");
  fuzz::require(fuzz::is_same_shape(read->mesh, back.mesh), "OBJ keeps every bit");
  return 0;
}
