#pragma once
// An unknown: its name, unit, bounds, and what was known of it before.

#include <string>

namespace umov {

/// How likely values are before anything was measured.
enum class Prior {
  Flat,    ///< every value within the bounds alike
  LogFlat, ///< every power of ten alike: a scale
  Normal   ///< around `mean` with `sd`, within the bounds
};

/// One unknown of a model.
struct Parameter {
  std::string name, unit;
  double lower = 0, upper = 0; ///< bounds
  Prior prior = Prior::Flat;
  double mean = 0, sd = 0; ///< of a normal prior
};

/// Logarithm of the prior density at a value, without its norm; minus infinity outside the bounds.
double log_prior(const Parameter &parameter, double value);
/// "flat", "log-flat" or "normal".
const char *name_of(Prior prior);

} // namespace umov
