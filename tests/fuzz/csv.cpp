// Tables of numbers (CSV).

#include "fuzz/target.h"

#include <umov/io/table.h>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
  using namespace umov;
  const auto read = read_csv(fuzz::text_of(data, size), "input", {"a", "b"}, {"c"});
  if (!fuzz::is_read(read))
    return 0;
  fuzz::require(read->rows() > 0, "a table has rows");
  const std::string text = to_csv(*read);
  const auto back =
      fuzz::must(read_csv(text, "written", {"a", "b", "line"}, {"c"}), "a table can be read again");
  fuzz::require(back.rows() == read->rows(), "with all its rows");
  for (const char *name : {"a", "b"})
    for (std::size_t i = 0; i < back.rows(); ++i)
      fuzz::require(back.number(name, i) == read->number(name, i), "and every bit");
  return 0;
}
