// Modes of an inversion (CSV, ECSV): what is accepted is an attitude with variances.

#include "fuzz/target.h"

#include <cmath>
#include <umov/io/modes_file.h>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
  using namespace umov;
  const auto read = read_modes_text(fuzz::text_of(data, size), "input");
  if (!fuzz::is_read(read))
    return 0;
  fuzz::require(!read->rows.empty(), "a mode");
  const std::size_t n = read->has_rates ? 6 : 3;
  for (const ModesRow &row : read->rows) {
    const Quaternion q = row.attitude;
    fuzz::require(std::abs(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z - 1) < 1e-9, "a length");
    fuzz::require(row.weight > 0 && row.covariance.size() == n * n, "a weight and a covariance");
    for (std::size_t k = 0; k < n; ++k)
      fuzz::require(row.covariance[k * n + k] > 0, "a variance");
  }
  return 0;
}
