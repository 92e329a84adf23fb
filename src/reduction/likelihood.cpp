#include <umov/reduction/likelihood.h>

#include <algorithm>
#include <boost/math/special_functions/bessel.hpp>
#include <boost/math/special_functions/erf.hpp>
#include <cmath>
#include <limits>
#include <umov/core/quantity.h>

namespace umov {

double log_poisson_gauss(double counts, double mean, double read_sd) {
  const double reach = 12 * (std::sqrt(mean) + read_sd + 1);
  const auto first = static_cast<std::int64_t>(std::max(0.0, std::min(mean, counts) - reach));
  const auto last = static_cast<std::int64_t>(std::max({mean, counts, 0.0}) + reach);
  // The sum is kept relative to its largest term so far.
  double largest = -std::numeric_limits<double>::infinity(), sum = 0;
  const double log_mean = std::log(mean);
  double log_factorial = std::lgamma(static_cast<double>(first) + 1);
  for (std::int64_t k = first; k <= last; ++k) {
    const auto n = static_cast<double>(k);
    const double off = (counts - n) / read_sd;
    const double term = (k > 0 ? n * log_mean : 0) - mean - log_factorial - off * off / 2;
    if (term > largest) {
      sum *= std::exp(largest - term);
      largest = term;
    }
    sum += std::exp(term - largest);
    log_factorial += std::log(n + 1);
  }
  return largest + std::log(sum) - std::log(read_sd * std::sqrt(2 * pi));
}

double log_shifted_poisson(double counts, double mean, double variance) {
  const double n = std::max(0.0, counts + variance), m = mean + variance;
  return n * std::log(m) - m - std::lgamma(n + 1);
}

double log_normal_counts(double counts, double mean, double variance, double excess2) {
  const double v = excess2 * mean + variance, off = counts - mean;
  return -off * off / (2 * v) - std::log(2 * pi * v) / 2;
}

double log_multiplied(double output, double mean, double gain) {
  const double a = 2 * std::sqrt(output * mean / gain);
  // I1 grows as exp(a)/sqrt(2 pi a): asked for without the exponential where that overflows.
  const double bessel = a < 500 ? std::log(boost::math::cyl_bessel_i(1, a))
                                : a - std::log(2 * pi * a) / 2 - 3 / (8 * a);
  return std::log(mean / (output * gain)) / 2 - output / gain - mean + bessel;
}

double log_saturated(double limit, double mean, double variance) {
  const double x = (limit - mean) / std::sqrt(2 * (mean + variance));
  constexpr double far = 25; // erfc underflows a little later
  return x < far ? std::log(std::erfc(x) / 2) : -x * x - std::log(2 * x * std::sqrt(pi));
}

} // namespace umov
