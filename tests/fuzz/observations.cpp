// Light curves of observers (ECSV, CSV): what is accepted can be compared with a model.

#include "fuzz/target.h"

#include <cmath>
#include <umov/io/observations_file.h>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
  using namespace umov;
  Diagnostics diagnostics;
  const auto read = read_observations_text(fuzz::text_of(data, size), "input", diagnostics);
  if (!fuzz::is_read(read))
    return 0;
  fuzz::require(!read->rows.empty(), "there are rows");
  for (const ObservedRow &row : read->rows) {
    fuzz::require(!std::isnan(row.flux) || !std::isnan(row.mag) || !std::isnan(row.q),
                  "every row measures something");
    fuzz::require(std::isnan(row.q) == std::isnan(row.u), "q and u come together");
    fuzz::require(!(row.flux_err < 0) && !(row.cov_qq < 0), "errors are not negative");
  }
  return 0;
}
