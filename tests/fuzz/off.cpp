// OFF held against its header: what is accepted has the counts and corners that it states, so that
// Assimp's reader, which believes them, can be let at it.

#include "fuzz/target.h"

#include "io/mesh/off_check.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
  using namespace umov;
  const std::string_view text = fuzz::text_of(data, size);
  if (fuzz::is_read(mesh_io::check_off(text, "input", nullptr)))
    fuzz::require(text.find("OFF") != std::string_view::npos, "the mark of the format");
  return 0;
}
