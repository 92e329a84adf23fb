// Measured surfaces (CSV): what is accepted gives finite light.

#include "fuzz/target.h"

#include <cmath>
#include <umov/io/measured_file.h>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
  using namespace umov;
  std::vector<std::string> none;
  fuzz::require(!fuzz::is_read(read_measured_file(fuzz::nowhere, false, none)),
                "no file, no table");
  for (const bool accept : {false, true}) {
    std::vector<std::string> remarks;
    const auto read = read_measured(fuzz::text_of(data, size), "input", accept, remarks);
    if (!fuzz::is_read(read))
      continue;
    for (const double o : {0., 0.3, 1.5})
      for (const double m : (*read)(read->first_nm(), 0.2, o, 1))
        fuzz::require(std::isfinite(m), "a measured table gives finite numbers");
    break; // it is accepted either way
  }
  return 0;
}
