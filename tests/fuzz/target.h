#pragma once
// What the fuzz targets share. A target is `LLVMFuzzerTestOneInput`: it hands the bytes to a reader
// and holds what it gives against what its header promises.

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>
#include <umov/core/result.h>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size);

namespace umov::fuzz {

/// Files that an input names are looked for here, where none can be.
inline constexpr const char *nowhere = "/dev/null/input";

/// Ends the program, as a sanitizer does, where a promise is broken.
inline void require(bool holds, const std::string &promise) {
  if (holds)
    return;
  std::fprintf(stderr, "broken promise: %s\n", promise.c_str());
  std::abort();
}

/// A refusal is no bug of ours and says something.
inline void check_refusal(const Error &error) {
  require(error.code != ErrorCode::Internal, "bad input is no bug of ours: " + error.text());
  require(!error.message.empty(), "a refusal has a message");
}

/// True where there is a value; a refusal is checked.
template <class T> bool is_read(const Result<T> &result) {
  if (!result)
    check_refusal(result.error());
  return result.has_value();
}

/// The value of what must not be refused.
template <class T> T must(Result<T> result, const std::string &promise) {
  if (!result)
    require(false, promise + ": " + result.error().text());
  return std::move(*result);
}

inline std::string_view text_of(const std::uint8_t *data, std::size_t size) {
  return {reinterpret_cast<const char *>(data), size};
}

} // namespace umov::fuzz
