#pragma once
// CCSDS messages there and back.

#include "fuzz/target.h"

#include <optional>
#include <umov/core/diagnostics.h>
#include <umov/io/ccsds.h>

namespace umov::fuzz {

inline bool is_same(const std::vector<ccsds::Field> &a, const std::vector<ccsds::Field> &b) {
  if (a.size() != b.size())
    return false;
  for (std::size_t k = 0; k < a.size(); ++k)
    if (a[k].key != b[k].key || a[k].text != b[k].text || a[k].unit != b[k].unit)
      return false;
  return true;
}

inline bool is_same(const ccsds::Message &a, const ccsds::Message &b) {
  if (a.kind != b.kind || a.version != b.version || !is_same(a.header, b.header) ||
      a.segments.size() != b.segments.size())
    return false;
  for (std::size_t s = 0; s < a.segments.size(); ++s) {
    const ccsds::Segment &one = a.segments[s], &other = b.segments[s];
    if (!is_same(one.metadata, other.metadata) || one.data.size() != other.data.size())
      return false;
    for (std::size_t r = 0; r < one.data.size(); ++r)
      if (one.data[r].name != other.data[r].name ||
          !is_same(one.data[r].fields, other.data[r].fields))
        return false;
  }
  return true;
}

/// A written message reads back to one that is written the same again; in the form that it came
/// in, to the same one.
inline void check_written(const ccsds::Message &message, ccsds::Form form, bool is_own) {
  const auto text = ccsds::write_message(message, form);
  if (!is_read(text))
    return;
  Diagnostics diagnostics;
  const auto back = must(ccsds::read_message(*text, "written", diagnostics),
                         "a message is written so that it can be read");
  require(must(ccsds::write_message(back, form), "and be written again") == *text,
          "a message is written the same again");
  require(!is_own || is_same(message, back), "a message keeps all it has in its own form");
}

/// The message that the bytes are, if they are one of that kind, checked both ways.
inline std::optional<ccsds::Message> message_of(std::string_view text, ccsds::Kind kind) {
  if (!ccsds::is_message(text))
    return std::nullopt;
  Diagnostics diagnostics;
  const auto message = ccsds::read_message(text, "input", diagnostics);
  if (!is_read(message) || message->kind != kind)
    return std::nullopt;
  const std::size_t first = text.find_first_not_of(" \t\r\n\xEF\xBB\xBF");
  const bool is_xml = first != std::string_view::npos && text[first] == '<';
  check_written(*message, ccsds::Form::Kvn, !is_xml);
  check_written(*message, ccsds::Form::Xml, is_xml);
  return *message;
}

} // namespace umov::fuzz
