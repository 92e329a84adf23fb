#include <umov/io/standards_file.h>

#include "io/table/text_table.h"

#include <algorithm>
#include <fmt/format.h>
#include <umov/core/text.h>

namespace umov {

Result<std::vector<PolarizedStandard>> read_standards_text(std::string_view text,
                                                           const std::string &file) {
  UMOV_ASSIGN(table, read_text_table(text, file));
  const auto column = [&](const char *name) {
    const auto &c = table.columns;
    return static_cast<std::size_t>(std::find(c.begin(), c.end(), name) - c.begin());
  };
  const std::size_t name = column("name"), p = column("p_percent"), pa = column("pa_deg");
  for (const auto &[at, text_of] : {std::pair{name, "name"}, {p, "p_percent"}, {pa, "pa_deg"}})
    if (at == table.columns.size())
      return fail(ErrorCode::BadInput,
                  fmt::format("a table of standards without the column \"{}\"; name, p_percent and "
                              "pa_deg were expected",
                              text_of),
                  {file, 1});
  std::vector<PolarizedStandard> out;
  for (std::size_t k = 0; k < table.rows.size(); ++k) {
    const auto &row = table.rows[k];
    const auto degree = parse_number(row[p]), angle = parse_number(row[pa]);
    if (!degree || !angle || !(*degree >= 0 && *degree <= 100) || !(std::abs(*angle) <= 360))
      return fail(ErrorCode::BadInput,
                  fmt::format("p_percent = \"{}\", pa_deg = \"{}\"; 0 to 100 and an angle were "
                              "expected",
                              printable(row[p]), printable(row[pa])),
                  {file, table.lines[k]});
    if (row[name].empty() ||
        std::ranges::find(out, row[name], &PolarizedStandard::name) != out.end())
      return fail(ErrorCode::BadInput,
                  row[name].empty()
                      ? std::string("a standard without a name; give it as the counts do")
                      : fmt::format("\"{}\" stands twice; keep one", printable(row[name])),
                  {file, table.lines[k]});
    out.push_back({row[name], *degree / 100, *angle * pi / 180});
  }
  if (out.empty())
    return fail(ErrorCode::BadInput,
                "no standard in this table; a row of name, p_percent and pa_deg was expected",
                {file});
  return out;
}

} // namespace umov
