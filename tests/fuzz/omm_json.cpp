// Orbit mean-elements messages as JSON.

#include "fuzz/elements.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
  umov::fuzz::check_elements(umov::fuzz::text_of(data, size), umov::ElementsForm::OmmJson);
  return 0;
}
