#pragma once
// What readers of orbits and attitudes share about the fields of a CCSDS message.

#include <algorithm>
#include <cctype>
#include <fmt/format.h>
#include <string>
#include <umov/io/ccsds.h>

namespace umov::ccsds {

inline std::string upper(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return text;
}

/// "KEY is "FOUND", expected EXPECTED", with the field's line.
inline tl::unexpected<Error> refuse(const Message &message, const Field &field,
                                    const std::string &expected) {
  return fail(
      ErrorCode::BadInput,
      fmt::format("{} is \"{}\", expected {}", field.key, field.text.substr(0, 60), expected),
      {message.file, field.line});
}

} // namespace umov::ccsds
