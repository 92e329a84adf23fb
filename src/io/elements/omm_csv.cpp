// A line of keywords, then a line of values for each message.

#include "io/elements/omm_message.h"

#include <algorithm>
#include <umov/core/text.h>

namespace umov::omm {
Result<void> read_csv(std::string_view text, const std::string &file, const Sink &sink) {
  std::vector<std::string> keys;
  std::size_t line_number = 0, messages = 0;
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    std::string_view line = text.substr(0, end);
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    ++line_number;
    line = trimmed(line.substr(0, line.find_last_not_of('\r') + 1));
    if (line.empty() || line.starts_with('#'))
      continue;
    const auto refuse = [&](const std::string &what) {
      return fail(ErrorCode::BadInput, what, {file, line_number});
    };
    constexpr std::ptrdiff_t cells_max = 10'000; // an OMM has some 50 keywords
    if (std::count(line.begin(), line.end(), ',') >= cells_max)
      return refuse("more than " + std::to_string(cells_max) + " cells; is it a list of OMM?");
    const auto cells = csv_cells(line);
    if (keys.empty()) {
      if (!cells)
        return refuse("a quote is not closed");
      for (const CsvCell &cell : *cells) {
        // Spreadsheets end lines in empty cells: columns without a keyword.
        if (!cell.text.empty() && std::ranges::find(keys, cell.text) != keys.end())
          return refuse(printable(cell.text) +
                        " stands twice among the keywords. Keep one of them.");
        keys.push_back(cell.text);
      }
      continue;
    }
    Message message{{}, line_number, ++messages};
    Result<void> done;
    if (!cells || cells->size() != keys.size())
      done = refuse(cells ? std::to_string(cells->size()) + " cells, expected " +
                                std::to_string(keys.size()) + " as in the line of keywords"
                          : std::string("a quote is not closed"));
    for (std::size_t k = 0; done && k < keys.size(); ++k) {
      const std::string &cell = (*cells)[k].text;
      if (!keys[k].empty())
        done = put(message, file, keys[k], {cell, "", line_number});
      else if (!cell.empty())
        done = refuse("\"" + printable(cell) + "\" stands below no keyword, in column " +
                      std::to_string(k + 1) + ". Name it, or take it out.");
    }
    if (done)
      UMOV_TRY(sink(std::move(message)));
    else
      UMOV_TRY(sink(tl::unexpected(std::move(done).error())));
  }
  return {};
}

} // namespace umov::omm
