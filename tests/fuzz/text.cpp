// Numbers and names as every reader takes them.

#include "fuzz/target.h"

#include <cmath>
#include <umov/core/text.h>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
  using namespace umov;
  const std::string_view text = fuzz::text_of(data, size);
  if (const auto number = parse_number(text)) {
    fuzz::require(std::isfinite(*number), "parse_number gives finite numbers");
    fuzz::require(parse_number(shortest(*number)) == number, "shortest reads back to the same");
  }
  bool is_changed = false;
  const std::string shown = printable(text, &is_changed);
  fuzz::require(printable(shown) == shown, "printable text stays as it is");
  fuzz::require(is_changed || shown == text, "is_changed tells of a change");
  const std::string_view inner = trimmed(text);
  fuzz::require(trimmed(inner) == inner, "trimmed text has no blanks at its ends");
  const std::string known[] = {"scenario", "material", "", std::string(text.substr(0, 100))};
  if (size <= 1000)
    nearest_name(text, known);
  return 0;
}
