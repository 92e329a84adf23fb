#include <umov/io/extinction_file.h>

#include "io/table/text_table.h"

#include <algorithm>
#include <fmt/format.h>
#include <umov/core/text.h>

namespace umov {
namespace {

struct ExtinctionColumn {
  const char *name;
  double low, high;
  const char *hint;
  std::vector<double> MeasuredExtinction::*values;
};
// From where ozone lets light through to thermal light; nothing is seen behind ten magnitudes.
constexpr ExtinctionColumn extinction_columns[] = {
    {"wavelength_nm", 200, 5000, " (is it in um or Angstrom?)", &MeasuredExtinction::nm},
    {"k_mag", 0, 10, " magnitudes per air mass", &MeasuredExtinction::mag}};

Result<void> read_column(const TextTable &table, const ExtinctionColumn &one,
                         const std::string &file, MeasuredExtinction &out) {
  const auto column = column_named(table, one.name);
  if (!column)
    return without_column(table, file,
                          fmt::format("extinction without the column \"{}\"; a line of the names "
                                      "wavelength_nm and k_mag above the numbers was expected",
                                      one.name));
  const std::string what = fmt::format("{} to {}{}", one.low, one.high, one.hint);
  for (std::size_t row = 0; row < table.rows(); ++row) {
    UMOV_ASSIGN(value, number_in(table, row, *column, one.low, one.high, what, file));
    (out.*one.values).push_back(value);
  }
  return {};
}

} // namespace

Result<MeasuredExtinction> read_extinction_text(std::string_view text, const std::string &file) {
  UMOV_ASSIGN(table, read_text_table(text, file));
  MeasuredExtinction out;
  for (const ExtinctionColumn &one : extinction_columns)
    UMOV_TRY(read_column(table, one, file, out));
  if (out.nm.size() < 2)
    return fail(ErrorCode::BadInput,
                fmt::format("{} of extinction; two wavelengths or more were expected",
                            counted(out.nm.size(), "row")),
                {file});
  for (std::size_t k = 1; k < out.nm.size(); ++k)
    if (!(out.nm[k] > out.nm[k - 1]))
      return fail(ErrorCode::BadInput,
                  fmt::format("wavelength_nm = {} after {}: rising wavelengths were expected; sort "
                              "the rows",
                              out.nm[k], out.nm[k - 1]),
                  {file, table.lines[k]});
  return out;
}

} // namespace umov
