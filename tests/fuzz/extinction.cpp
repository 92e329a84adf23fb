// Measured extinction (CSV, ECSV): what is accepted rises in wavelength and is what air does.

#include "fuzz/target.h"

#include <umov/io/extinction_file.h>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
  using namespace umov;
  const auto read = read_extinction_text(fuzz::text_of(data, size), "input");
  if (!fuzz::is_read(read))
    return 0;
  fuzz::require(read->nm.size() == read->mag.size() && read->nm.size() >= 2, "two columns");
  for (std::size_t k = 0; k < read->nm.size(); ++k) {
    fuzz::require(k == 0 || read->nm[k] > read->nm[k - 1], "rising wavelengths");
    fuzz::require(read->nm[k] >= 200 && read->nm[k] <= 5000, "a wavelength");
    fuzz::require(read->mag[k] >= 0 && read->mag[k] <= 10, "an extinction");
  }
  return 0;
}
