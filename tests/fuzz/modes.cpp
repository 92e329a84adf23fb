// Modes and samples of an inversion (CSV, ECSV): what is accepted is an attitude with variances,
// and draws whose weights add up to one.

#include "fuzz/target.h"

#include <cmath>
#include <umov/io/modes_file.h>

namespace {

void check_length(umov::Quaternion q) {
  umov::fuzz::require(std::abs(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z - 1) < 1e-9,
                      "a length");
}

void check_samples(std::string_view text) {
  using namespace umov;
  const auto read = read_samples_text(text, "input");
  if (!fuzz::is_read(read))
    return;
  double sum = 0;
  for (const SampleRow &row : *read) {
    check_length(row.attitude);
    fuzz::require(row.weight >= 0 && row.scale > 0, "a weight and a scale");
    sum += row.weight;
  }
  fuzz::require(std::abs(sum - 1) < 1e-6, "a sum of one");
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
  using namespace umov;
  const auto text = fuzz::text_of(data, size);
  check_samples(text);
  const auto read = read_modes_text(text, "input");
  if (!fuzz::is_read(read))
    return 0;
  fuzz::require(!read->rows.empty(), "a mode");
  const std::size_t n = read->has_rates ? 6 : 3;
  for (const ModesRow &row : read->rows) {
    check_length(row.attitude);
    fuzz::require(row.weight > 0 && row.covariance.size() == n * n, "a weight and a covariance");
    for (std::size_t k = 0; k < n; ++k)
      fuzz::require(row.covariance[k * n + k] > 0, "a variance");
  }
  return 0;
}
