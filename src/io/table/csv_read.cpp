#include <umov/io/table.h>

#include "io/table/text_table.h"

#include <algorithm>
#include <fmt/format.h>
#include <umov/core/text.h>

namespace umov {

namespace {

class CsvReader {
public:
  CsvReader(std::string_view text, const std::string &file,
            const std::vector<std::string> &required, const std::vector<std::string> &optional)
      : text_(text), file_(file), required_(required), optional_(optional) {}

  Result<Table> read() {
    if (const auto why = why_no_text(text_))
      return fail(ErrorCode::BadInput, *why, {file_});
    if (text_.substr(0, 3) == "\xEF\xBB\xBF")
      text_.remove_prefix(3);
    while (!text_.empty()) {
      const std::size_t end = std::min(text_.find('\n'), text_.size());
      std::string_view line = text_.substr(0, end);
      text_.remove_prefix(std::min(end + 1, text_.size()));
      ++line_;
      const std::string_view content = trimmed(line.substr(0, line.find_last_not_of('\r') + 1));
      if (content.empty() || content.front() == '#')
        continue;
      // Each cell costs many times its one byte, so they are counted before they are made.
      constexpr std::ptrdiff_t columns_max = 10'000;
      if (std::count(line.begin(), line.end(), ',') >= columns_max)
        return fail(ErrorCode::BadInput,
                    fmt::format("more than {} cells in this row; is it a table?", columns_max),
                    {file_, line_});
      if (const auto why = why_no_names(content); why && header_.empty())
        return fail(ErrorCode::BadInput, fmt::format("{}: {}", *why, wanted()), {file_, line_});
      const auto cells = csv_cells(line.substr(0, line.find_last_not_of('\r') + 1));
      if (!cells)
        return fail(ErrorCode::BadInput, "a quote is not closed in this row; close it with \"",
                    {file_, line_});
      UMOV_TRY(header_.empty() ? header(*cells) : row(*cells));
    }
    return table();
  }

private:
  std::string wanted() const { return fmt::format("{}", fmt::join(required_, ", ")); }

  Result<void> header(const std::vector<CsvCell> &cells) {
    for (const CsvCell &cell : cells)
      header_.push_back(cell.text);
    for (const std::string &name : required_) {
      if (std::find(header_.begin(), header_.end(), name) == header_.end())
        return missing(name);
      taken_.push_back(name);
    }
    for (const std::string &name : optional_)
      if (std::find(header_.begin(), header_.end(), name) != header_.end())
        taken_.push_back(name);
    for (const std::string &name : taken_) {
      const auto found = std::find(header_.begin(), header_.end(), name);
      if (std::find(found + 1, header_.end(), name) != header_.end())
        return fail(ErrorCode::BadInput,
                    fmt::format("column \"{}\" stands twice in the header; keep one", name),
                    {file_, line_});
      place_.push_back(static_cast<std::size_t>(found - header_.begin()));
    }
    values_.resize(taken_.size());
    is_dropped_.resize(taken_.size());
    return {};
  }

  Result<void> missing(const std::string &name) const {
    if (const auto why = why_no_names(header_))
      return fail(ErrorCode::BadInput, fmt::format("{}: {}", *why, wanted()), {file_, line_});
    const auto near = nearest_name(name, header_);
    return fail(ErrorCode::BadInput,
                fmt::format("no column \"{}\"{}; the first line must name the columns {}", name,
                            near ? fmt::format(" (there is \"{}\")", *near) : "", wanted()),
                {file_, line_});
  }

  Result<void> row(const std::vector<CsvCell> &cells) {
    if (cells.size() != header_.size())
      return fail(
          ErrorCode::BadInput,
          fmt::format("{} cells in this row; the header has {}", cells.size(), header_.size()),
          {file_, line_});
    for (std::size_t k = 0; k < taken_.size(); ++k) {
      const CsvCell &cell = cells[place_[k]];
      const auto value = parse_number(cell.text);
      if (!value && k >= required_.size()) { // not the numbers that were hoped for: no such column
        is_dropped_[k] = true;
        values_[k].push_back(0);
        continue;
      }
      if (!value)
        return fail(ErrorCode::BadInput,
                    fmt::format("{} is \"{}\"; a finite number was expected", taken_[k], cell.text),
                    {file_, line_, cell.column});
      values_[k].push_back(*value);
    }
    lines_.push_back(static_cast<std::int64_t>(line_));
    return {};
  }

  Result<Table> table() {
    if (header_.empty())
      return fail(ErrorCode::BadInput,
                  "no header; the first line must name the columns " + wanted(), {file_});
    if (lines_.empty())
      return fail(ErrorCode::BadInput, "no rows below the header; at least one was expected",
                  {file_});
    Table out;
    for (std::size_t k = 0; k < taken_.size(); ++k)
      if (!is_dropped_[k])
        out.add(taken_[k], "", "", std::move(values_[k]));
    out.add("line", "", "line in the file", std::move(lines_));
    return out;
  }

  std::string_view text_;
  const std::string &file_;
  const std::vector<std::string> &required_, &optional_;
  std::vector<std::string> header_, taken_;
  std::vector<std::size_t> place_;
  std::vector<std::vector<double>> values_;
  std::vector<std::int64_t> lines_;
  std::vector<bool> is_dropped_; ///< optional columns that hold something else
  std::size_t line_ = 0;
};

} // namespace

Result<Table> read_csv(std::string_view text, const std::string &file,
                       const std::vector<std::string> &required,
                       const std::vector<std::string> &optional) {
  return CsvReader(text, file, required, optional).read();
}

} // namespace umov
