// Counts of an observation (ECSV, CSV): what is accepted can be fitted.

#include "fuzz/target.h"

#include <cmath>
#include <umov/io/counts_file.h>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
  using namespace umov;
  Diagnostics diagnostics;
  const auto read = read_counts_text(fuzz::text_of(data, size), "input", diagnostics);
  if (!fuzz::is_read(read))
    return 0;
  fuzz::require(!read->rows.empty(), "there are rows");
  for (const CountRow &row : read->rows) {
    fuzz::require(std::isfinite(row.counts) && std::isfinite(row.sky), "counts are numbers");
    fuzz::require(row.row[0] > 0 && row.var_read >= 0 && row.excess2 >= 1, "rows can be weighted");
  }
  return 0;
}
