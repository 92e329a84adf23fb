// Densities of normals (CSV).

#include "fuzz/target.h"

#include <umov/io/measured_file.h>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
  using namespace umov;
  const auto read = read_normals(fuzz::text_of(data, size), "input");
  if (fuzz::is_read(read))
    fuzz::require(read->angle_deg.size() == read->density.size(), "a density for each angle");
  return 0;
}
