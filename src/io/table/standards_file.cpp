#include <umov/io/standards_file.h>

#include "io/table/text_table.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <umov/core/embedded.h>
#include <umov/core/files.h>
#include <umov/core/text.h>

namespace umov {

const std::vector<EmbeddedFile> &standard_files();

namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();

/// The column that is meant by one of another's spelling; null for those that say nothing to us.
const char *misspelt(std::string_view column) {
  constexpr std::array names{std::pair{"color", "colour"},      std::pair{"b_v", "colour"},
                             std::pair{"B-V", "colour"},        std::pair{"p", "p_percent"},
                             std::pair{"pa", "pa_deg"},         std::pair{"p_err", "p_err_percent"},
                             std::pair{"pa_err", "pa_err_deg"}, std::pair{"magnitude", "mag"}};
  const auto found =
      std::ranges::find_if(names, [column](const auto &one) { return column == one.first; });
  return found == names.end() ? nullptr : found->second;
}

class StandardsReader {
public:
  StandardsReader(const TextTable &table, const std::string &file) : table_(table), file_(file) {}

  [[nodiscard]] Result<void> check_columns() const;
  [[nodiscard]] Result<StandardStar> star(std::size_t k) const;

private:
  [[nodiscard]] bool has(const char *name) const {
    return std::ranges::find(table_.columns, name) != table_.columns.end();
  }
  [[nodiscard]] std::string_view text(const char *name, std::size_t k) const {
    const auto at = std::ranges::find(table_.columns, name);
    return at == table_.columns.end()
               ? std::string_view()
               : table_.cell(k, static_cast<std::size_t>(at - table_.columns.begin()));
  }
  /// NaN without the column or in an empty cell.
  [[nodiscard]] Result<double> number(const char *name, std::size_t k, double low, double high,
                                      const char *what) const;
  [[nodiscard]] tl::unexpected<Error> refuse(std::size_t k, std::string message) const {
    return fail(ErrorCode::BadInput, std::move(message), {file_, table_.lines[k]});
  }

  const TextTable &table_;
  const std::string &file_;
};

Result<void> StandardsReader::check_columns() const {
  const Where header{file_, table_.header_line};
  if (!has("name"))
    return without_column(
        table_, file_,
        "a table of standards without the column \"name\"; it was expected, with p_percent and "
        "pa_deg, or with mag, or with all of them");
  for (const auto &[one, other] : {std::pair{"p_percent", "pa_deg"}, {"pa_deg", "p_percent"}})
    if (has(one) && !has(other))
      return fail(
          ErrorCode::BadInput,
          fmt::format("a table of standards with \"{}\" and without the column \"{}\"; both "
                      "were expected",
                      one, other),
          header);
  for (const std::string &column : table_.columns)
    if (const char *meant = misspelt(column); meant != nullptr && !has(meant))
      return fail(ErrorCode::BadInput,
                  fmt::format("a table of standards with the column \"{}\"; \"{}\" was expected",
                              printable(column), meant),
                  header);
  if (!has("p_percent") && !has("mag"))
    return fail(ErrorCode::BadInput,
                "a table of standards that tells nothing of them: the columns \"p_percent\" and "
                "\"pa_deg\", or \"mag\", or all of them, were expected",
                header);
  return {};
}

Result<double> StandardsReader::number(const char *name, std::size_t k, double low, double high,
                                       const char *what) const {
  const std::string_view cell = text(name, k);
  if (cell.empty() || cell == "nan" || cell == "NaN")
    return none;
  const auto value = parse_number(cell);
  if (!value || !(*value >= low && *value <= high))
    return refuse(k, fmt::format("{} = \"{}\"; {} from {} to {} was expected, or an empty cell",
                                 name, printable(cell), what, low, high));
  return *value;
}

Result<StandardStar> StandardsReader::star(std::size_t k) const {
  StandardStar out;
  out.name = text("name", k);
  if (out.name.empty())
    return refuse(k, "a standard without a name; give it as the counts do");
  UMOV_ASSIGN(percent, number("p_percent", k, 0, 100, "a degree in per cent"));
  UMOV_ASSIGN(angle, number("pa_deg", k, -360, 360, "an angle"));
  UMOV_ASSIGN(percent_sd, number("p_err_percent", k, 0, 100, "a standard deviation"));
  UMOV_ASSIGN(angle_sd, number("pa_err_deg", k, 0, 100, "a standard deviation"));
  UMOV_ASSIGN(mag, number("mag", k, -30, 40, "a magnitude"));
  UMOV_ASSIGN(colour, number("colour", k, -10, 20, "a colour index"));
  if (percent > 0 && std::isnan(angle))
    return refuse(k, fmt::format("p_percent = {} without pa_deg; an angle was expected", percent));
  if (std::isnan(percent) && std::isnan(mag))
    return refuse(k, "this row tells nothing of the star: p_percent (0 for an unpolarized one) and "
                     "pa_deg, or mag, was expected");
  constexpr double degree = pi / 180;
  const auto or_0 = [](double value) { return std::isnan(value) ? 0 : value; };
  out.p = percent / 100;
  out.angle_rad = or_0(angle) * degree;
  out.p_sd = or_0(percent_sd) / 100;
  out.angle_sd = or_0(angle_sd) * degree;
  out.mag = mag;
  out.colour = colour;
  return out;
}

} // namespace

Result<std::vector<StandardStar>> read_standards_text(std::string_view text,
                                                      const std::string &file) {
  UMOV_ASSIGN(table, read_text_table(text, file));
  const StandardsReader reader(table, file);
  UMOV_TRY(reader.check_columns());
  std::vector<StandardStar> out;
  for (std::size_t k = 0; k < table.rows(); ++k) {
    UMOV_ASSIGN(star, reader.star(k));
    if (std::ranges::find(out, star.name, &StandardStar::name) != out.end())
      return fail(ErrorCode::BadInput,
                  fmt::format("\"{}\" stands twice; keep one", printable(star.name)),
                  {file, table.lines[k]});
    out.push_back(std::move(star));
  }
  if (out.empty())
    return fail(ErrorCode::BadInput,
                "no standard in this table; a row of name, p_percent and pa_deg was expected",
                {file});
  return out;
}

std::vector<std::string> standards_names() {
  std::vector<std::string> out;
  for (const EmbeddedFile &file : standard_files())
    out.emplace_back(file.stem);
  std::ranges::sort(out);
  return out;
}

Result<std::string> standards_text(const std::string &name_or_path) {
  for (const EmbeddedFile &file : standard_files())
    if (name_or_path == file.stem)
      return std::string(file.bytes);
  if (name_or_path.find_first_of("./") != std::string::npos || file_exists(name_or_path))
    return read_file(name_or_path);
  const auto near = nearest_name(name_or_path, standards_names());
  return fail(ErrorCode::BadInput,
              fmt::format("no file \"{0}\", and no table of standards of that name.{1} Known: {2}",
                          printable(name_or_path),
                          near ? fmt::format(" Did you mean \"{}\"?", *near) : "",
                          fmt::join(standards_names(), ", ")));
}

} // namespace umov
