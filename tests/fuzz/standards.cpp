// Tables of standard stars (CSV, ECSV): what is accepted is physical. A text of one line is also
// the name of a table; as that of a file of the working directory it promises nothing.

#include "fuzz/target.h"

#include <algorithm>
#include <umov/io/standards_file.h>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
  using namespace umov;
  static const std::vector<std::string> ours = standards_names();
  const std::string_view text = fuzz::text_of(data, size);
  // No path to a file, of which there are odd ones outside this folder.
  if (text.find_first_of("/\n") == std::string_view::npos) {
    const auto named = standards_text(std::string(text));
    if (const bool is_found = fuzz::is_read(named); std::ranges::count(ours, text) > 0)
      fuzz::require(is_found && fuzz::is_read(read_standards_text(*named, "table")),
                    "our tables can be read");
  }
  const auto read = read_standards_text(text, "input");
  if (!fuzz::is_read(read))
    return 0;
  for (const StandardStar &star : *read)
    fuzz::require(!(star.p < 0 || star.p > 1), "a degree of polarization");
  return 0;
}
