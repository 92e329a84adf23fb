#pragma once
// Private: numbers in binary files, whatever the order of their bytes and ours.

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

namespace umov::mesh_io {

/// The number at `at`, which must lie inside.
template <class T>
T number_at(std::string_view bytes, std::size_t at, std::endian order = std::endian::little) {
  char raw[sizeof(T)];
  for (std::size_t i = 0; i < sizeof(T); ++i)
    raw[order == std::endian::native ? i : sizeof(T) - 1 - i] = bytes[at + i];
  T out;
  std::memcpy(&out, raw, sizeof(T));
  return out;
}

/// Appends a number, least significant byte first.
template <class T> void append(std::string &out, T value) {
  char raw[sizeof(T)];
  std::memcpy(raw, &value, sizeof(T));
  for (std::size_t i = 0; i < sizeof(T); ++i)
    out += raw[std::endian::native == std::endian::little ? i : sizeof(T) - 1 - i];
}

} // namespace umov::mesh_io
