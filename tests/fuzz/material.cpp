// Materials in files of their own (TOML).

#include "fuzz/target.h"

#include "io/scenario/parts.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
  using namespace umov;
  const auto read =
      scenario::read_material_text(std::string(fuzz::text_of(data, size)), fuzz::nowhere);
  if (!fuzz::is_read(read))
    return 0;
  const std::string text = material_as_toml(*read);
  const auto back = fuzz::must(scenario::read_material_text(text, fuzz::nowhere),
                               "a material is written so that it can be read:\n" + text);
  fuzz::require(material_as_toml(back) == text, "a material is written the same again");
  return 0;
}
