// MTL files, of which the names are read.

#include "fuzz/mesh.h"

#include <umov/core/text.h>
#include <umov/io/obj.h>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
  using namespace umov;
  const MtlLoader loader = [&](const std::string & /*name*/) -> Result<std::string> {
    return std::string(fuzz::text_of(data, size));
  };
  Diagnostics diagnostics;
  const auto read =
      fuzz::must(read_obj_text("mtllib a.mtl\nmtllib ./a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
                               "input", fuzz::mesh_options(), loader, diagnostics),
                 "no MTL file spoils a mesh");
  for (const std::string &name : read.defined)
    fuzz::require(printable(name) == name, "names of materials are printable");
  fuzz::require(read.files.size() == 1, "an MTL file is read once");
  return 0;
}
