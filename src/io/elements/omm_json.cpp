// JSON as catalogues serve it: one object or a list of them, values as numbers or strings.

#include "io/elements/omm_message.h"

#include "core/parse_place.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>
#include <umov/core/text.h>

namespace umov::omm {
namespace {

constexpr int deepest = 4;

/// Depth of brackets outside strings, and the line where it first exceeds `deepest`.
std::size_t line_too_deep(std::string_view text) {
  int depth = 0;
  std::size_t line = 1;
  bool is_text = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    line += c == '\n' ? 1u : 0u;
    if (is_text) {
      if (c == '\\')
        ++i;
      else if (c == '"')
        is_text = false;
    } else if (c == '"') {
      is_text = true;
    } else if (c == '{' || c == '[') {
      if (++depth > deepest)
        return line;
    } else if (c == '}' || c == ']') {
      --depth;
    }
  }
  return 0;
}

/// Where a number stands that the parser tells of in quotes, without its place.
std::size_t byte_of_number(std::string_view text, std::string_view words) {
  const std::size_t quote = words.find('\'');
  const std::string_view number = words.substr(quote + 1, words.rfind('\'') - quote - 1);
  bool is_text = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '"')
      is_text = !is_text;
    else if (is_text && text[i] == '\\')
      ++i;
    else if (!is_text && text.substr(i).starts_with(number))
      return i;
  }
  return text.size();
}

std::string text_of(const nlohmann::json &value) {
  if (value.is_string())
    return value.get<std::string>();
  if (value.is_number_float())
    return shortest(value.get<double>());
  return value.is_null() ? std::string() : value.dump();
}

} // namespace

Result<void> read_json(std::string_view text, const std::string &file, const Sink &sink) {
  if (const std::size_t line = line_too_deep(text); line > 0)
    return fail(ErrorCode::BadInput,
                "is nested deeper than any list of element sets; is it another file? Fetch the "
                "sets again.",
                {file, line});
  // The parser keeps the last of two equal keys: they are caught as they pass.
  std::set<std::string> keys; // a list would take a hostile object's keys squared
  std::string twice;
  std::size_t number = 0;
  const auto watch = [&](int depth, nlohmann::json::parse_event_t event, nlohmann::json &parsed) {
    using Event = nlohmann::json::parse_event_t;
    if (event == Event::object_start && depth <= 1) {
      keys.clear();
      ++number;
    }
    if (event == Event::key && depth <= 2) {
      const auto key = parsed.get<std::string>();
      if (!keys.insert(key).second && twice.empty())
        twice = "message " + std::to_string(number) + ": " + key;
    }
    return true;
  };
  nlohmann::json document;
  try {
    document = nlohmann::json::parse(text, watch);
  } catch (const nlohmann::json::parse_error &problem) {
    const auto [line, column] =
        line_and_column(text, problem.byte - std::min<std::size_t>(problem.byte, 1));
    return fail(ErrorCode::BadInput,
                "is no JSON of element sets: " + json_words(problem.what()) +
                    ". Fetch the sets again.",
                {file, line, column});
  } catch (const nlohmann::json::exception &problem) { // a number that no double holds
    const auto [line, column] = line_and_column(text, byte_of_number(text, problem.what()));
    return fail(ErrorCode::BadInput,
                "is no JSON of element sets: " + json_words(problem.what()) +
                    "; a finite number was expected. Correct it, or fetch the sets again.",
                {file, line, column});
  }
  if (!twice.empty())
    return fail(ErrorCode::BadInput, twice + " stands twice. Keep one of them.", {file});
  if (document.is_object())
    document = nlohmann::json::array({document});
  std::size_t messages = 0;
  for (const auto &entry : document) {
    Message message{{}, 0, ++messages};
    if (!entry.is_object()) {
      UMOV_TRY(sink(fail(
          ErrorCode::BadInput,
          "entry " + std::to_string(messages) + " is no object of keywords and values", {file})));
      continue;
    }
    for (const auto &[key, value] : entry.items())
      message.fields[key] = {text_of(value), "", 0};
    UMOV_TRY(sink(std::move(message)));
  }
  return {};
}

} // namespace umov::omm
