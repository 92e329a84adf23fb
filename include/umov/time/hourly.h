#pragma once
// Slow functions of time, computed once an hour.

#include <array>
#include <cmath>
#include <cstdint>
#include <umov/time/epoch.h>

namespace umov {

/// N numbers that change slowly with terrestrial time, and take long: computed on whole hours, with
/// the cubic through the four hours around a time. A wave of period P and amplitude A is off by at
/// most .024 (2 pi h/P)^4 A (Lagrange's remainder): 7e-10 arcsec of nutation's fortnightly term, a
/// millimetre of the Sun. The result depends on the time alone, whatever was asked for before. Not
/// thread safe: one per thread.
template <std::size_t N> class Hourly {
public:
  /// What is computed at once.
  using Values = std::array<double, N>;
  /// `exact` takes a two-part Julian date TT.
  explicit Hourly(Values (*exact)(double jd1, double jd2)) : exact_(exact) {}

  /// The numbers at a time.
  Values operator()(Epoch<Tt> time) {
    const double hours = ((time.jd1 - origin) + time.jd2) * 24, before = std::floor(hours);
    const auto first = static_cast<std::int64_t>(before) - 1;
    const double x = hours - before, y = x - 1, z = x - 2, w = x + 1;
    const double weight[4] = {-x * y * z / 6, w * y * z / 2, -w * x * z / 2, w * x * y / 6};
    Values out{};
    for (std::int64_t k = 0; k < 4; ++k) {
      const Values &node = at_hour(first + k);
      for (std::size_t i = 0; i < N; ++i)
        out[i] += weight[k] * node[i];
    }
    return out;
  }

private:
  static constexpr double origin = 2451545; ///< J2000
  static constexpr std::int64_t kept = 64;  ///< hours: more than any two days that are mixed
  struct Node {
    std::int64_t hour = INT64_MIN;
    Values values{};
  };
  const Values &at_hour(std::int64_t hour) {
    Node &node = nodes_[static_cast<std::size_t>(((hour % kept) + kept) % kept)];
    if (node.hour != hour)
      node = {hour, exact_(origin, static_cast<double>(hour) / 24)};
    return node.values;
  }
  Values (*exact_)(double, double);
  std::array<Node, kept> nodes_{};
};

} // namespace umov
