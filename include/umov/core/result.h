#pragma once
// Errors are values: what happened, where it was read, and which exit code it means.

#include <cstddef>
#include <exception>
#include <string>
#include <tl/expected.hpp>
#include <utility>

namespace umov {

/// Kind of failure; the numbers are the exit codes of the command line.
enum class ErrorCode : int {
  Internal = 1,     ///< our bug
  Usage = 2,        ///< wrong option or argument
  BadInput = 3,     ///< an input file or value is wrong, or missing
  Physics = 4,      ///< decayed orbit, numerics that do not converge
  Nothing = 5,      ///< nothing to report (no pass)
  Device = 6,       ///< device missing, disk full, folder not writable
  Interrupted = 130 ///< stopped by the user
};

/// Place in an input. Zero line or column means "not known".
struct Where {
  std::string file;
  std::size_t line = 0;
  std::size_t column = 0;
};

/// "file:line:column: " as far as known, else "".
std::string to_text(const Where &where);

/// What went wrong: its kind, a sentence for the user, and the place in an input.
struct Error {
  ErrorCode code = ErrorCode::Internal;
  std::string message; ///< what was found, what was expected, what to do
  Where where{};

  /// Place and message in one line, without the word "error".
  [[nodiscard]] std::string text() const { return to_text(where) + message; }
};

/// A failure where no Result can be returned: in a constructor.
class Failure : public std::exception {
public:
  /// Wraps an error.
  explicit Failure(Error error) : error_(std::move(error)), text_(error_.text()) {}
  /// The error itself.
  [[nodiscard]] const Error &error() const noexcept { return error_; }
  /// The error's text.
  [[nodiscard]] const char *what() const noexcept override { return text_.c_str(); }

private:
  Error error_;
  std::string text_;
};

/// A value, or the error that stands in its place.
template <class T> using Result = tl::expected<T, Error>;

/// Shorthand for returning a failure: `return fail(ErrorCode::BadInput, "...", {file, line, col});`
inline tl::unexpected<Error> fail(ErrorCode code, std::string message, Where where = {}) {
  return tl::unexpected<Error>(Error{code, std::move(message), std::move(where)});
}

} // namespace umov

/// Returns the error of a Result expression from the enclosing function.
#define UMOV_TRY(...)                                                                              \
  do {                                                                                             \
    if (auto umov_try_ = (__VA_ARGS__); !umov_try_)                                                \
      return tl::unexpected(std::move(umov_try_).error());                                         \
  } while (false)

/// Declares `name` from a Result expression, or returns its error.
#define UMOV_ASSIGN(name, ...)                                                                     \
  auto name##_result_ = (__VA_ARGS__);                                                             \
  if (!name##_result_)                                                                             \
    return tl::unexpected(std::move(name##_result_).error());                                      \
  auto &name = *name##_result_
