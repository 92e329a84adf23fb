#include "io/scenario/parse_toml.h"

#include "io/scenario/node.h"

#include <algorithm>
#include <fmt/format.h>
#include <umov/core/text.h>

namespace umov::scenario {
namespace {

/// Behind the text in quotes that begins at `at`, or the end.
std::size_t behind_quotes(std::string_view text, std::size_t at) {
  const char quote = text[at];
  const std::string_view three = text.substr(at, 3);
  const bool is_long = three.size() == 3 && three[1] == quote && three[2] == quote;
  const std::size_t marks = is_long ? 3 : 1;
  for (std::size_t k = at + marks; k < text.size(); ++k) {
    if (quote == '"' && text[k] == '\\')
      ++k;
    else if (text[k] == quote && (!is_long || text.substr(k, 3) == three))
      return std::min(k + marks, text.size());
    else if (!is_long && text[k] == '\n')
      return k; // not closed: the parser says so
  }
  return text.size();
}

/// What the parser says, and how such a thing is mended.
Error no_toml(const toml::parse_error &problem, const std::string &file) {
  const std::string_view said = problem.description();
  const auto speaks_of = [&](const char *words) {
    return said.find(words) != std::string_view::npos;
  };
  const char *remedy = "A TOML file was expected: KEY = VALUE, texts in quotes, times such as "
                       "2018-01-21T04:00:00Z.";
  if (speaks_of("redefine"))
    remedy = "It stands twice: keep one of them.";
  else if (speaks_of("invalid utf-8"))
    remedy = "Save the file as UTF-8.";
  else if (speaks_of("saw 60"))
    remedy = "Write a leap second in quotes: \"2016-12-31T23:59:60Z\".";
  else if (speaks_of("expected day") || speaks_of("expected month") || speaks_of("expected hour"))
    remedy = "Correct the date.";
  else if (speaks_of("not representable"))
    remedy = "Take a smaller number.";
  else if (speaks_of("nested"))
    remedy = "Simplify the file.";
  return {ErrorCode::BadInput, fmt::format("{}. {}", printable(said), remedy),
          place_of(problem.source(), file)};
}

/// A text or key with the character 0, which the system takes for the end of a file's name, so that
/// another file would be read; null: there is none.
const toml::node *text_with_0(const toml::node &node) {
  if (const auto *text = node.as_string())
    return text->get().find('\0') != std::string::npos ? &node : nullptr;
  if (const toml::array *list = node.as_array()) {
    for (const toml::node &one : *list)
      if (const toml::node *found = text_with_0(one))
        return found;
  } else if (const toml::table *table = node.as_table()) {
    for (const auto &[key, one] : *table) {
      if (key.str().find('\0') != std::string_view::npos)
        return &one;
      if (const toml::node *found = text_with_0(one))
        return found;
    }
  }
  return nullptr;
}

} // namespace

Result<void> check_key_depth(std::string_view text, const std::string &file) {
  std::size_t dots = 0, line = 1;
  for (std::size_t k = 0; k < text.size();) {
    const char c = text[k];
    if (c == '"' || c == '\'') {
      const std::size_t end = behind_quotes(text, k);
      line += static_cast<std::size_t>(std::count(text.data() + k, text.data() + end, '\n'));
      k = end;
      continue;
    }
    if (c == '#')
      k = std::min(text.find('\n', k), text.size());
    else
      ++k;
    if (c == '.')
      ++dots;
    else if (c != ' ' && c != '\t' &&
             std::string_view("=,[]{}#\n").find(c) != std::string_view::npos)
      dots = 0;
    if (c == '\n')
      ++line;
    if (dots >= names_max)
      return fail(
          ErrorCode::BadInput,
          fmt::format("a key of more than {} names with dots between; the deepest of umov has "
                      "5. Simplify the file.",
                      names_max),
          Where{file, line});
  }
  return {};
}

Result<toml::table> parse_toml(std::string_view text, const std::string &file) {
  UMOV_TRY(check_key_depth(text, file));
  try {
    toml::table out = toml::parse(text, file);
    if (const toml::node *found = text_with_0(out))
      return fail(ErrorCode::BadInput,
                  "a text has the character 0 (\\u0000); one without it was expected",
                  place_of(found->source(), file));
    return out;
  } catch (const toml::parse_error &problem) {
    return tl::unexpected(no_toml(problem, file));
  }
}

} // namespace umov::scenario
