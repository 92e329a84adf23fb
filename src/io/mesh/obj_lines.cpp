#include "io/mesh/obj_lines.h"

#include "io/mesh/mesh_parts.h"

#include <algorithm>
#include <fmt/format.h>
#include <umov/core/stop.h>
#include <umov/core/text.h>

namespace umov::obj {

namespace {

/// A comment begins at a '#' that starts a word; inside one it belongs to a name ("red#2").
std::size_t comment_begin(std::string_view line) {
  for (std::size_t at = line.find('#'); at != std::string_view::npos; at = line.find('#', at + 1))
    if (at == 0 || line[at - 1] == ' ' || line[at - 1] == '\t')
      return at;
  return line.size();
}

} // namespace

Lines::Lines(std::string_view text, std::string file, const std::atomic<bool> *cancel)
    : rest_(text), file_(std::move(file)), cancel_(cancel) {
  if (rest_.starts_with("\xEF\xBB\xBF"))
    rest_.remove_prefix(3);
}

bool Lines::next(std::vector<Word> &words) {
  words.clear();
  while (!rest_.empty()) {
    leave_if_stopped(cancel_, ++line_);
    const std::size_t end = std::min(rest_.find_first_of("\r\n"), rest_.size());
    std::string_view line = rest_.substr(0, end);
    const bool is_crlf = rest_.substr(end).starts_with("\r\n");
    rest_.remove_prefix(std::min(rest_.size(), end + (is_crlf ? 2 : 1)));
    line = line.substr(0, comment_begin(line));
    const std::size_t last = line.find_last_not_of(" \t");
    const bool goes_on = last != std::string_view::npos && line[last] == '\\';
    if (goes_on)
      line = line.substr(0, last);
    for (std::size_t at = line.find_first_not_of(" \t"); at != std::string_view::npos;) {
      const std::size_t stop = std::min(line.find_first_of(" \t", at), line.size());
      if (words.size() < words_max)
        words.push_back({line.substr(at, stop - at), line_, at + 1});
      else if (cut_line_ == 0)
        cut_line_ = line_;
      at = line.find_first_not_of(" \t", stop);
    }
    if (!goes_on && !words.empty())
      return true;
  }
  return !words.empty();
}

Result<double> number(const Lines &lines, const Word &word) {
  if (word.text.size() <= 64) // longer than any double is printed: a broken file
    if (const auto value = parse_number(word.text))
      return *value;
  const std::string shown = mesh_io::clean_name(word.text.substr(0, 40));
  const bool has_comma = word.text.find(',') != std::string_view::npos;
  return fail(ErrorCode::BadInput,
              fmt::format("\"{}\" is not a finite decimal number{}", shown,
                          has_comma ? "; write a point instead of the comma"
                                    : "; one such as -1.25 or 3e-2 was expected. Correct it, or "
                                      "export the mesh again"),
              lines.where(word));
}

std::string name_from(const std::vector<Word> &words, std::size_t first) {
  std::string out;
  for (std::size_t i = first; i < words.size(); ++i) {
    if (!out.empty())
      out += ' ';
    out += words[i].text;
  }
  return out;
}

} // namespace umov::obj
