#pragma once
#include <string>
#include <umov/core/result.h>
#include <utility>
#include <vector>

namespace umov {

/// Something the user should know although work went on.
struct Warning {
  Where where;
  std::string message;

  /// Place and message in one line.
  [[nodiscard]] std::string text() const { return to_text(where) + message; }
};

/// Collects warnings; a function that can warn takes a `Diagnostics &`. A file with a fault in
/// every line gives `most` of them, and one more that says so.
class Diagnostics {
public:
  static constexpr std::size_t most = 1000;

  /// Adds a warning.
  void warn(std::string message, Where where = {}) {
    if (warnings_.size() > most)
      return;
    if (warnings_.size() == most) {
      message = "there are more warnings, which are left out.";
      where = Where();
    }
    warnings_.push_back({std::move(where), std::move(message)});
  }
  /// All warnings so far, in order.
  [[nodiscard]] const std::vector<Warning> &warnings() const { return warnings_; }
  /// There was no warning.
  [[nodiscard]] bool empty() const { return warnings_.empty(); }

private:
  std::vector<Warning> warnings_;
};

} // namespace umov
