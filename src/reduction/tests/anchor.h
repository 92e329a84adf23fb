#pragma once
#include "core/tests/anchors.h"

#include <umov/reduction/stokes_fit.h>

namespace umov {

/// A number of tests/data/anchors/observing_reduction.csv: seven to ten digits.
inline double of(const std::string &name) { return anchor(name, "observing_reduction"); }

constexpr double four_angles[] = {0, 45, 90, 135};
constexpr double test_extinction = 300;

/// Four analysers of extinction 300 and unequal gains.
inline StokesRow analyser_row(double angle_deg, double gain) {
  const double d = (test_extinction - 1) / (test_extinction + 1), x = angle_deg * pi / 90;
  return {gain / 2, gain / 2 * d * std::cos(x), gain / 2 * d * std::sin(x), 0};
}

/// The worked set of docs/theory/observing.md 6: 40 pixels of 2.3 e and 2.6 e/ADU, sky of 120 e
/// from 400 pixels.
inline std::vector<ChannelDatum> worked_set() {
  const double counts[] = {3120, 2705, 2210, 2650}, gains[] = {.98, 1, 1.02, 1.01};
  const double fixed = 40 * 2.3 * 2.3 + 120 * 40 / 400. + 40 * 2.6 * 2.6 / 12;
  std::vector<ChannelDatum> out;
  for (int k = 0; k < 4; ++k)
    out.push_back({counts[k], 120, fixed, 1, analyser_row(four_angles[k], gains[k])});
  return out;
}

} // namespace umov
