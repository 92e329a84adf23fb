#pragma once
// Private: whole numbers and lists of JSON that anybody may have written.

#include <cstdint>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>

namespace umov::scale {

/// A whole number: get<std::size_t> alone would cast 1e300, -1 and 0.5 too. Throws (std::exception)
/// for these, with the `key` that it stands under.
inline std::size_t whole_of(const nlohmann::json &value, const char *key) {
  if (!value.is_number_unsigned())
    throw std::runtime_error(std::string(key) + " is no whole number from 0 on");
  return value.get<std::size_t>();
}
/// That of `key`; throws for what is not there too.
inline std::size_t whole_at(const nlohmann::json &all, const char *key) {
  return whole_of(all.at(key), key);
}

/// A number of decimals or digits from `least`, 0 or less, to `most`; throws for others. (Compared
/// as it stands, 18446744073709551615 would be -1.)
inline int digits_of(const nlohmann::json &value, int least, int most) {
  if (value.is_number_unsigned() ? value.get<std::uint64_t>() > static_cast<std::uint64_t>(most)
                                 : !value.is_number_integer() || value.get<std::int64_t>() < least)
    throw std::runtime_error("precision is no number of digits from " + std::to_string(least) +
                             " to " + std::to_string(most));
  return value.get<int>();
}

/// A list: a loop over null would find nothing, over an object its values, over a number that.
/// Throws for these, with the `key` that it stands under.
inline const nlohmann::json &list_of(const nlohmann::json &value, const char *key) {
  if (!value.is_array())
    throw std::runtime_error(std::string(key) + " is no list");
  return value;
}
/// That of `key`; throws for what is not there too.
inline const nlohmann::json &list_at(const nlohmann::json &all, const char *key) {
  return list_of(all.at(key), key);
}

/// An exit code, or 128 and the number of a signal.
inline int code_at(const nlohmann::json &all) {
  constexpr std::size_t most = 1000;
  const std::size_t code = whole_at(all, "code");
  if (code > most)
    throw std::runtime_error("code is none of a process");
  return static_cast<int>(code);
}

} // namespace umov::scale
