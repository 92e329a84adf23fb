// Magnitudes of tracking data messages: what is accepted can be compared with a model.

#include "jobs/observations_tdm.h"
#include "fuzz/target.h"

#include <cmath>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
  using namespace umov;
  Diagnostics diagnostics;
  const auto read = jobs::observations_of_tdm(fuzz::text_of(data, size), "input", diagnostics);
  if (!fuzz::is_read(read))
    return 0;
  fuzz::require(!read->rows.empty(), "there are rows");
  for (const ObservedRow &row : read->rows)
    fuzz::require(std::isfinite(row.mag), "every row has a magnitude");
  return 0;
}
