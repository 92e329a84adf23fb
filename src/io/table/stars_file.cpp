#include <umov/io/stars_file.h>

#include "io/table/text_table.h"

#include <algorithm>
#include <fmt/format.h>
#include <umov/core/text.h>

namespace umov {
namespace {

struct Wanted {
  const char *name;
  double low, high;
  double FieldStar::*value;
};
constexpr Wanted wanted[] = {{"ra_deg", 0, 360, &FieldStar::ra_deg},
                             {"dec_deg", -90, 90, &FieldStar::dec_deg},
                             {"mag", -30, 40, &FieldStar::mag}};

} // namespace

Result<std::vector<FieldStar>> read_stars_text(std::string_view text, const std::string &file,
                                               Diagnostics &diagnostics) {
  UMOV_ASSIGN(table, read_text_table(text, file));
  std::vector<FieldStar> out(table.rows());
  for (const Wanted &one : wanted) {
    const auto column = column_named(table, one.name);
    if (!column)
      return without_column(
          table, file,
          fmt::format("stars without the column \"{}\"; ra_deg, dec_deg and mag were "
                      "expected",
                      one.name));
    const std::string what = fmt::format("a number from {} to {}", one.low, one.high);
    for (std::size_t row = 0; row < table.rows(); ++row) {
      UMOV_ASSIGN(value, number_in(table, row, *column, one.low, one.high, what, file,
                                   ". Mend the line or take it out"));
      out[row].*one.value = value;
    }
  }
  if (out.empty())
    diagnostics.warn("no star in this table: the field is empty. Is it the right file?", {file});
  return out;
}

} // namespace umov
