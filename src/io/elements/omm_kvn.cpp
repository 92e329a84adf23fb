// KEYWORD = VALUE [unit], a message after the other.

#include "io/elements/omm_message.h"

#include <optional>
#include <umov/core/text.h>

namespace umov::omm {
namespace {

/// "51.6 [deg]" as value and unit.
Field field_of(std::string_view text, std::size_t line) {
  text = trimmed(text);
  Field out{std::string(text), "", line};
  const std::size_t open = text.rfind('[');
  if (open != std::string_view::npos && text.ends_with(']') && open > 0 &&
      (text[open - 1] == ' ' || text[open - 1] == '\t') &&
      parse_number(trimmed(text.substr(0, open)))) {
    out.text = trimmed(text.substr(0, open));
    out.unit = text.substr(open + 1, text.size() - open - 2);
  }
  return out;
}

} // namespace

Result<void> read_kvn(std::string_view text, const std::string &file, const Sink &sink) {
  std::optional<Message> message;
  std::optional<Error> broken; // of this message; the rest of it is skipped
  std::size_t line_number = 0, messages = 0;
  const auto finish = [&]() -> Result<void> {
    if (!message)
      return {};
    Message done = std::move(*message);
    message.reset();
    if (broken)
      return sink(tl::unexpected(*std::exchange(broken, std::nullopt)));
    return sink(std::move(done));
  };
  while (!text.empty()) {
    const std::size_t end = text.find_first_of("\r\n");
    const std::string_view line = trimmed(text.substr(0, end));
    const bool is_pair = end != std::string_view::npos && text.substr(end).starts_with("\r\n");
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + (is_pair ? 2 : 1));
    ++line_number;
    if (line.empty() || line.starts_with("COMMENT") || line.starts_with('#'))
      continue;
    const std::size_t equals = line.find('=');
    const std::string key(trimmed(line.substr(0, equals)));
    if (key == "CCSDS_OMM_VERS") {
      UMOV_TRY(finish());
      message = Message{{}, line_number, ++messages};
    }
    if (!message)
      return fail(ErrorCode::BadInput,
                  "\"" + std::string(line.substr(0, 60)) +
                      "\" stands before any CCSDS_OMM_VERS, which begins a message",
                  {file, line_number});
    if (broken)
      continue;
    if (equals == std::string_view::npos) {
      broken = Error{ErrorCode::BadInput,
                     "\"" + std::string(line.substr(0, 60)) +
                         "\" has no '='; KEYWORD = VALUE was expected",
                     {file, line_number}};
      continue;
    }
    if (auto done = put(*message, file, key, field_of(line.substr(equals + 1), line_number)); !done)
      broken = std::move(done).error();
  }
  return finish();
}

} // namespace umov::omm
