#include <umov/io/modes_file.h>

#include "io/table/text_table.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <umov/core/quantity.h>
#include <umov/core/text.h>

namespace umov {
namespace {

/// What a column is in; empty: a bare number.
std::string_view unit_of(std::string_view name) {
  if (name.starts_with("rate_"))
    return "deg / s";
  if (!name.starts_with("cov_"))
    return "";
  constexpr std::size_t of_axes = 4; // behind "cov_"
  const auto rates = std::ranges::count(name.substr(of_axes), 'w');
  return rates == 0 ? "rad2" : rates == 1 ? "rad2 / s" : "rad2 / s2";
}

/// The same but for blanks.
bool is_unit(std::string told, std::string_view expected) {
  std::erase(told, ' ');
  std::string bare(expected);
  std::erase(bare, ' ');
  return told == bare;
}

/// Cells of one table by name.
class ModesTable {
public:
  ModesTable(const TextTable &table, const std::string &file) : table_(table), file_(file) {}
  [[nodiscard]] bool has(std::string_view name) const {
    return column_named(table_, name).has_value();
  }
  [[nodiscard]] Result<double> number(std::size_t row, const std::string &name,
                                      double least = -1e30) const {
    constexpr double most = 1e30;
    const auto column = column_named(table_, name);
    if (!column)
      return fail(
          ErrorCode::BadInput,
          fmt::format("modes without the column \"{}\"; modes.ecsv of umov invert pose, spin "
                      "or track was expected",
                      name),
          {file_});
    if (const auto told = table_.units.find(name);
        told != table_.units.end() && !is_unit(told->second, unit_of(name)))
      return fail(ErrorCode::BadInput,
                  fmt::format("{} is in \"{}\"; \"{}\" was expected, as answers have it", name,
                              printable(told->second), unit_of(name)),
                  {file_});
    return number_in(table_, row, *column, least, most,
                     least < 0 ? "a number" : "a number of 0 or more", file_);
  }
  [[nodiscard]] Result<Quaternion> attitude(std::size_t row) const;
  [[nodiscard]] Result<std::vector<double>> covariance(std::size_t row, bool has_rates) const;

private:
  const TextTable &table_;
  const std::string &file_;
};

Result<Quaternion> ModesTable::attitude(std::size_t row) const {
  UMOV_ASSIGN(w, number(row, "qw"));
  UMOV_ASSIGN(x, number(row, "qx"));
  UMOV_ASSIGN(y, number(row, "qy"));
  UMOV_ASSIGN(z, number(row, "qz"));
  const double length = std::sqrt(w * w + x * x + y * y + z * z);
  constexpr double rounding = 1e-3; // of tables that were made shorter by hand
  if (!(std::abs(length - 1) < rounding))
    return fail(ErrorCode::BadInput,
                fmt::format("qw, qx, qy, qz are of length {:.6g}; a quaternion of length 1 was "
                            "expected",
                            length),
                {file_, table_.lines[row]});
  return Quaternion{w / length, x / length, y / length, z / length};
}

Result<std::vector<double>> ModesTable::covariance(std::size_t row, bool has_rates) const {
  const char *const axes[] = {"x", "y", "z", "wx", "wy", "wz"};
  const std::size_t n = has_rates ? 6 : 3;
  std::vector<double> out(n * n);
  for (std::size_t r = 0; r < n; ++r)
    for (std::size_t c = r; c < n; ++c) {
      const std::string name = fmt::format("cov_{}{}", axes[r], axes[c]);
      UMOV_ASSIGN(value, number(row, name));
      if (r == c && !(value > 0))
        return fail(ErrorCode::BadInput,
                    fmt::format("{} = {}; a variance above 0 was expected", name, value),
                    {file_, table_.lines[row]});
      out[r * n + c] = out[c * n + r] = value;
    }
  return out;
}

Result<ModesRow> mode_of(const ModesTable &table, std::size_t row, bool has_rates) {
  ModesRow out;
  UMOV_ASSIGN(weight, table.number(row, "weight", 0));
  out.weight = weight;
  if (table.has("scale")) {
    UMOV_ASSIGN(scale, table.number(row, "scale"));
    out.scale = scale;
  }
  UMOV_ASSIGN(attitude, table.attitude(row));
  out.attitude = attitude;
  if (has_rates) {
    UMOV_ASSIGN(x, table.number(row, "rate_x"));
    UMOV_ASSIGN(y, table.number(row, "rate_y"));
    UMOV_ASSIGN(z, table.number(row, "rate_z"));
    constexpr double degree = pi / 180;
    out.rate_rad_s = {x * degree, y * degree, z * degree};
  }
  UMOV_ASSIGN(covariance, table.covariance(row, has_rates));
  out.covariance = std::move(covariance);
  return out;
}

} // namespace

Result<ModesFile> read_modes_text(std::string_view text, const std::string &file) {
  UMOV_ASSIGN(table, read_text_table(text, file));
  const ModesTable cells(table, file);
  ModesFile out;
  out.notes = table.notes;
  out.has_rates = cells.has("rate_x");
  for (std::size_t row = 0; row < table.rows(); ++row) {
    UMOV_ASSIGN(mode, mode_of(cells, row, out.has_rates));
    if (mode.weight > 0)
      out.rows.push_back(std::move(mode));
  }
  if (out.rows.empty())
    return fail(ErrorCode::BadInput,
                "no mode has a weight above 0; modes.ecsv of umov invert pose, spin or track was "
                "expected",
                {file});
  return out;
}

Result<std::vector<SampleRow>> read_samples_text(std::string_view text, const std::string &file) {
  UMOV_ASSIGN(table, read_text_table(text, file));
  const ModesTable cells(table, file);
  std::vector<SampleRow> out;
  double sum = 0;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    UMOV_ASSIGN(weight, cells.number(row, "weight"));
    UMOV_ASSIGN(scale, cells.number(row, "scale"));
    UMOV_ASSIGN(attitude, cells.attitude(row));
    if (!(weight > 0) || !(scale > 0))
      continue;
    sum += weight;
    out.push_back({weight, scale, attitude});
  }
  if (out.empty())
    return fail(ErrorCode::BadInput,
                "no sample has a weight and a scale above 0; samples.ecsv of umov invert pose was "
                "expected",
                {file});
  for (SampleRow &row : out)
    row.weight /= sum;
  return out;
}

} // namespace umov
