#include <umov/lightcurve/repetition.h>

#include "algebra/dense.h"

#include <algorithm>
#include <cmath>
#include <umov/core/quantity.h>
#include <vector>

namespace umov {
namespace {

using algebra::MatrixXd;
using algebra::VectorXd;
using Index = Eigen::Index;

/// Cosine and sine at a frequency as columns `at` and `at` + 1.
void put_sines(MatrixXd &m, Index at, std::span<const double> seconds, double frequency) {
  for (std::size_t k = 0; k < seconds.size(); ++k) {
    const double turn = 2 * pi * frequency * (seconds[k] - seconds.front());
    m(static_cast<Index>(k), at) = std::cos(turn);
    m(static_cast<Index>(k), at + 1) = std::sin(turn);
  }
}

/// What a parabola and harmonics of a frequency leave, which grow or fade evenly through the span.
VectorXd without(std::span<const double> seconds, std::span<const double> magnitudes,
                 double frequency, Index harmonics) {
  const auto count = static_cast<Index>(seconds.size());
  MatrixXd m(count, 3 + 4 * harmonics);
  VectorXd y(count), x(count);
  const double span = seconds.back() - seconds.front();
  for (Index k = 0; k < count; ++k) {
    const auto i = static_cast<std::size_t>(k);
    x[k] = (seconds[i] - seconds.front()) / span;
    m.row(k).head(3) << 1, x[k], x[k] * x[k];
    y[k] = magnitudes[i];
  }
  for (Index h = 0, at = 3; h < harmonics; ++h, at += 4) {
    put_sines(m, at, seconds, static_cast<double>(h + 1) * frequency);
    for (const Index c : {0, 1})
      m.col(at + 2 + c) = m.col(at + c).cwiseProduct(x);
  }
  return y - algebra::times(m, algebra::least_squares(m, y));
}

/// Sum of squares that a sine of a frequency takes of a rest.
double taken(std::span<const double> seconds, const VectorXd &rest, double frequency) {
  double cc = 0, ss = 0, cs = 0, yc = 0, ys = 0;
  for (std::size_t k = 0; k < seconds.size(); ++k) {
    const double turn = 2 * pi * frequency * (seconds[k] - seconds.front());
    const double c = std::cos(turn), s = std::sin(turn), y = rest[static_cast<Index>(k)];
    cc += c * c;
    ss += s * s;
    cs += c * s;
    yc += y * c;
    ys += y * s;
  }
  const double d = cc * ss - cs * cs;
  return d > 1e-9 * cc * ss ? (ss * yc * yc + cc * ys * ys - 2 * cs * yc * ys) / d : 0;
}

/// Fisher's (1932) chance of several that are independent: minus twice the sum of their logarithms
/// is a chi square with twice as many degrees of freedom.
double together(const std::vector<double> &chances) {
  double sum = 0;
  for (const double one : chances)
    sum -= std::log(std::max(one, 1e-300));
  double term = std::exp(-sum), out = 0;
  for (std::size_t j = 0; j < chances.size(); ++j) {
    out += term;
    term *= sum / static_cast<double>(j + 1);
  }
  return std::min(out, 1.0);
}

} // namespace

Alternation alternation(std::span<const double> seconds, std::span<const double> magnitudes,
                        double period_s) {
  Alternation out;
  constexpr double turns_min = 6; // so that the frequencies beside are midway to the harmonics
  constexpr std::size_t count_min = 20;
  if (seconds.size() < count_min || !(period_s > 0))
    return out;
  constexpr std::size_t count_max = 200'000; // more would be a matrix of gigabytes
  if (seconds.size() > count_max)
    return alternation(seconds.first(count_max), magnitudes.first(count_max), period_s);
  const double span = seconds.back() - seconds.front(), frequency = 1 / period_s;
  const auto count = static_cast<double>(seconds.size());
  out.turns = span / period_s;
  // Frequencies that the values can tell apart: as many as half of them, on the average.
  const double highest = 0.5 * (count - 1) / span;
  const double harmonics = std::min({8., std::floor(highest / frequency), (count - 8) / 8});
  const int odd = std::min(3, static_cast<int>(highest / frequency + 0.5));
  if (out.turns < turns_min || harmonics < 1 || odd < 1)
    return out;
  out.is_told = true;
  const VectorXd rest = without(seconds, magnitudes, frequency, static_cast<Index>(harmonics));
  double all = 0;
  std::vector<double> chances;
  for (int j = 0; j < odd; ++j) {
    const double at = (j + 0.5) * frequency;
    const double own = std::max(taken(seconds, rest, at), 0.);
    double beside = 0;
    int others = 0;
    // Not nearer to the harmonics, half the turns away, than to the frequency itself.
    constexpr double nearest = 1.5;
    constexpr int enough = 20;
    for (double away = nearest; away <= 0.5 * out.turns - nearest && others < enough; ++away)
      for (const double way : {-away, away}) {
        beside += std::max(taken(seconds, rest, at + way / span), 0.);
        ++others;
      }
    // F with 2 and 2 * others degrees of freedom.
    const double rounding = 1e-20 * count;
    chances.push_back(own > rounding ? std::pow(beside / (own + beside), others) : 1);
    all += own;
  }
  out.difference = 2 * std::sqrt(all / count);
  out.false_alarm = together(chances);
  return out;
}

} // namespace umov
