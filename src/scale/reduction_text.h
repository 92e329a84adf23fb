#pragma once
// Private: what --reduce asks for, as its text says.

#include <optional>
#include <string>
#include <umov/core/result.h>
#include <vector>

namespace umov::scale {

enum class Kind { Histogram, LogHistogram, Most, Least, Likelihood };

/// A value that was measured, and its standard deviation.
struct Measured {
  std::string column;
  double value = 0, error = 0;
};

/// What a text asks for.
struct Wanted {
  Kind kind = Kind::Histogram;
  std::string column;
  double low = 0, high = 0;
  std::size_t count = 0;
  std::vector<Measured> measured; ///< of a likelihood
  std::optional<std::vector<std::string>> by;
};

/// Of bins, one more than these.
std::vector<double> edges_of(const Wanted &wanted);
/// Usage for a text that is none.
Result<Wanted> read_wanted(const std::string &text);

} // namespace umov::scale
