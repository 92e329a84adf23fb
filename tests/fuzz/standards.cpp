// Tables of standard stars (CSV, ECSV): what is accepted is physical. A text of one line is also
// the name of a table.

#include "fuzz/target.h"

#include <umov/io/standards_file.h>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
  using namespace umov;
  const std::string_view text = fuzz::text_of(data, size);
  // No path to a file, of which there are odd ones outside this folder.
  if (text.find_first_of("/\n") == std::string_view::npos)
    if (const auto known = standards_text(std::string(text)); fuzz::is_read(known))
      fuzz::require(fuzz::is_read(read_standards_text(*known, "table")), "our tables can be read");
  const auto read = read_standards_text(text, "input");
  if (!fuzz::is_read(read))
    return 0;
  for (const StandardStar &star : *read)
    fuzz::require(!(star.p < 0 || star.p > 1), "a degree of polarization");
  return 0;
}
