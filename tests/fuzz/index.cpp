// Refractive indices: pages of refractiveindex.info (YAML).

#include "fuzz/target.h"

#include <cmath>
#include <umov/io/index_file.h>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
  using namespace umov;
  const auto read = read_index_text(std::string(fuzz::text_of(data, size)), "input.yml");
  if (!fuzz::is_read(read))
    return 0;
  for (const double nm : {10., 400., 550., 700., 1e4, 1e6}) {
    const auto eta = index_at(*read, Wavelength::nm(nm));
    if (fuzz::is_read(eta))
      fuzz::require(std::isfinite(eta->real()) && eta->real() > 0 && std::isfinite(eta->imag()),
                    "an index is a finite number with n > 0");
  }
  return 0;
}
