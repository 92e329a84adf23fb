// Counts behind a polarizer that is turned (CSV, ECSV): what is accepted can be fitted, each row
// with an error.

#include "fuzz/target.h"

#include <cmath>
#include <umov/io/polarizer_file.h>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
  using namespace umov;
  const auto read = read_polarizer_text(fuzz::text_of(data, size), "input");
  if (!fuzz::is_read(read))
    return 0;
  fuzz::require(!read->empty(), "a row");
  for (const PolarizerCount &row : *read) {
    fuzz::require(std::isfinite(row.angle_rad), "an angle");
    fuzz::require(row.counts >= 0 && row.counts <= 1e15, "electrons");
    fuzz::require(row.variance > 0 && row.variance <= 1e15, "a variance");
  }
  return 0;
}
