#pragma once
#include <cstddef>
#include <string_view>
#include <vector>

namespace umov {
/// One file of a folder that is compiled in (`umov_embed_folder` in CMake).
struct EmbeddedFile {
  const char *stem;
  std::string_view bytes;
};
} // namespace umov

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
