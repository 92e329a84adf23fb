#include <umov/io/standards_file.h>

#include "io/table/text_table.h"

#include <algorithm>
#include <fmt/format.h>
#include <umov/core/text.h>

namespace umov {
namespace {

/// An error of a star, in the column's unit: 0 without the column or in an empty cell.
Result<double> error_of(const TextTable &table, const std::string &file, std::size_t k,
                        const char *name) {
  const auto &c = table.columns;
  const auto at = static_cast<std::size_t>(std::find(c.begin(), c.end(), name) - c.begin());
  if (at == c.size() || table.rows[k][at].empty())
    return 0.0;
  const auto value = parse_number(table.rows[k][at]);
  if (!value || !(*value >= 0 && *value <= 100))
    return fail(ErrorCode::BadInput,
                fmt::format("{} = \"{}\"; a standard deviation of 0 to 100 was expected, or an "
                            "empty cell",
                            name, printable(table.rows[k][at])),
                {file, table.lines[k]});
  return *value;
}

} // namespace

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
    UMOV_ASSIGN(degree_sd, error_of(table, file, k, "p_err_percent"));
    UMOV_ASSIGN(angle_sd, error_of(table, file, k, "pa_err_deg"));
    out.push_back(
        {row[name], *degree / 100, *angle * pi / 180, degree_sd / 100, angle_sd * pi / 180});
  }
  if (out.empty())
    return fail(ErrorCode::BadInput,
                "no standard in this table; a row of name, p_percent and pa_deg was expected",
                {file});
  return out;
}

} // namespace umov
