#include <umov/io/polarizer_file.h>

#include "io/table/text_table.h"

#include <algorithm>
#include <fmt/format.h>
#include <optional>
#include <umov/core/quantity.h>
#include <umov/core/text.h>

namespace umov {
namespace {

constexpr double most = 1e15;

} // namespace

Result<std::vector<PolarizerCount>> read_polarizer_text(std::string_view text,
                                                        const std::string &file) {
  UMOV_ASSIGN(table, read_text_table(text, file));
  const auto angle = column_named(table, "angle_deg"), counts = column_named(table, "counts");
  const auto channel = column_named(table, "channel"), variance = column_named(table, "variance");
  if (!angle || !counts)
    return without_column(
        table, file,
        fmt::format("no column \"{}\"; angle_deg and counts were expected, with channel "
                    "where there are several",
                    angle ? "counts" : "angle_deg"));
  std::vector<PolarizerCount> out;
  for (std::size_t k = 0; k < table.rows(); ++k) {
    PolarizerCount one;
    UMOV_ASSIGN(degrees, number_in(table, k, *angle, -1e4, most, "an angle in degrees", file));
    UMOV_ASSIGN(found, number_in(table, k, *counts, 0, most, "a number of electrons", file));
    one.angle_rad = degrees * pi / 180;
    one.counts = one.variance = found;
    if (variance) {
      UMOV_ASSIGN(told, number_in(table, k, *variance, 0, most, "a variance in electron^2", file));
      one.variance = told;
    }
    if (!(one.variance > 0))
      return fail(ErrorCode::BadInput,
                  "a variance of 0; counts above 0, or a column variance that says what dark "
                  "counts err by, was expected",
                  {file, table.lines[k]});
    if (channel)
      one.channel = table.cell(k, *channel);
    out.push_back(std::move(one));
  }
  if (out.empty())
    return fail(ErrorCode::BadInput, "no counts in this table; a row for each angle was expected",
                {file});
  return out;
}

} // namespace umov
