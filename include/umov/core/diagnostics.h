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

  [[nodiscard]] std::string text() const { return to_text(where) + message; }
};

/// Collects warnings; a function that can warn takes a `Diagnostics &`.
class Diagnostics {
public:
  void warn(std::string message, Where where = {}) {
    warnings_.push_back({std::move(where), std::move(message)});
  }
  [[nodiscard]] const std::vector<Warning> &warnings() const { return warnings_; }
  [[nodiscard]] bool empty() const { return warnings_.empty(); }

private:
  std::vector<Warning> warnings_;
};

} // namespace umov
