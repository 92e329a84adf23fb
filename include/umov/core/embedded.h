#pragma once
#include <cstddef>
#include <string_view>

/// Declares a function that returns the bytes of a file compiled in by `umov_embed(target symbol
/// file)` in CMake: `UMOV_EMBEDDED(leap_seconds)` at namespace scope, then `leap_seconds()`.
#define UMOV_EMBEDDED(symbol)                                                                      \
  extern "C" const char umov_embedded_##symbol##_begin[];                                          \
  extern "C" const char umov_embedded_##symbol##_end[];                                            \
  static inline std::string_view symbol() {                                                        \
    return {                                                                                       \
        umov_embedded_##symbol##_begin,                                                            \
        static_cast<std::size_t>(umov_embedded_##symbol##_end - umov_embedded_##symbol##_begin)};  \
  }
