#include <umov/reduction/polarization.h>

#include <algorithm>
#include <boost/math/distributions/non_central_chi_squared.hpp>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/special_functions/bessel.hpp>
#include <boost/math/tools/roots.hpp>
#include <cmath>
#include <umov/core/quantity.h>

namespace umov {
namespace {

using boost::math::cyl_bessel_i;

double root_between(auto f, double a, double b, double fa, double fb) {
  if (fa == 0)
    return a;
  if (fb == 0)
    return b;
  std::uintmax_t rounds = 100;
  const auto found = boost::math::tools::toms748_solve(
      f, a, b, fa, fb, boost::math::tools::eps_tolerance<double>(40), rounds);
  return (found.first + found.second) / 2;
}

double root_between(auto f, double a, double b) { return root_between(f, a, b, f(a), f(b)); }

/// The true degree for which `x` is likeliest: x I1(x nu) = nu I0(x nu), 0 up to sqrt 2.
double likeliest(double x) {
  if (x * x <= 2)
    return 0;
  const auto slope = [x](double nu) {
    return x * cyl_bessel_i(1, x * nu) / cyl_bessel_i(0, x * nu) - nu;
  };
  const double small = 1e-3 * std::sqrt(x * x - 2); // there the slope is positive
  return slope(small) > 0 ? root_between(slope, small, x) : small;
}

/// Logarithm of the Rice density at x of a true nu over that of the likeliest nu.
double log_ratio(double x, double nu) {
  const double best = likeliest(x);
  return (best * best - nu * nu) / 2 +
         std::log(cyl_bessel_i(0, x * nu) / cyl_bessel_i(0, x * best));
}

/// Probability of less than x at a true nu: the square is non-central chi-squared.
double below(double x, double nu) {
  if (x <= 0)
    return 0;
  if (nu < 1e-8)
    return -std::expm1(-x * x / 2);
  return boost::math::cdf(boost::math::non_central_chi_squared(2, nu * nu), x * x);
}

/// x that is likeliest to be met where nu itself is the likeliest: the ratio's peak.
double peak_of(double nu) {
  if (nu <= 0)
    return 0;
  return root_between([nu](double x) { return likeliest(x) - nu; }, std::sqrt(2.0), nu + 2);
}

/// Probability of what is ranked above x at a true nu.
double ranked_above(double x, double nu) {
  const double rank = log_ratio(x, nu), peak = peak_of(nu);
  const auto over = [&](double y) { return log_ratio(y, nu) - rank; };
  if (x >= peak) {
    const double at_zero = over(0);
    const double other = nu <= 0 || at_zero >= 0 ? 0 : root_between(over, 0, peak);
    return below(x, nu) - below(other, nu);
  }
  double far = peak + 1;
  while (over(far) > 0)
    far += 1;
  return below(root_between(over, peak, far), nu) - below(x, nu);
}

} // namespace

PolarizationInterval degree_interval(double x, double level) {
  constexpr double normal_from = 8;
  if (x > normal_from) {
    const double debiased = x - (1 - std::exp(-x * x)) / (2 * x);
    const double reach = boost::math::quantile(boost::math::normal(), (1 + level) / 2);
    return {debiased - reach, debiased + reach};
  }
  const auto excess = [&](double nu) { return ranked_above(x, nu) - level; };
  const double best = likeliest(x);
  PolarizationInterval out;
  if (const double at_zero = excess(0); at_zero > 0)
    out.low = root_between(excess, 0, best, at_zero, -level);
  double far = best + 1;
  while (excess(far) <= 0)
    far += 1;
  out.high = root_between(excess, best, far, -level, excess(far));
  return out;
}

double angle_half_width(double x) {
  constexpr double level = 0.682689492137086;
  constexpr double normal_from = 20; // there the density is that of a normal angle to 1e-3
  if (x > normal_from)
    return 1 / (2 * x);
  // Density of the angle t from the true one, integrated by panels: smooth everywhere.
  const auto density = [x](double t) {
    const double eta = x / std::sqrt(2.0) * std::cos(2 * t);
    const double tail = eta * std::exp(eta * eta) * (1 + std::erf(eta));
    return (1 / std::sqrt(pi) + tail) * std::exp(-x * x / 2) / std::sqrt(pi);
  };
  const auto within = [&](double half) {
    constexpr int panels = 256; // Simpson's rule
    double sum = density(0) + density(half);
    for (int k = 1; k < panels; ++k)
      sum += (k % 2 == 1 ? 4 : 2) * density(half * k / panels);
    return 2 * sum * half / panels / 3 - level;
  };
  return root_between(within, 0, pi / 2);
}

PolarizationEstimate polarization_of(double q, double u, const LinearCovariance &c) {
  PolarizationEstimate out;
  out.p = std::hypot(q, u);
  const double phi = std::atan2(u, q), x = std::cos(phi), y = std::sin(phi);
  const double along = x * x * c[0][0] + 2 * x * y * c[0][1] + y * y * c[1][1];
  const double across = y * y * c[0][0] - 2 * x * y * c[0][1] + x * x * c[1][1];
  out.sd = std::sqrt(along);
  out.across = std::sqrt(across);
  out.debiased = out.p > 0 && across > 0
                     ? out.p - across * (1 - std::exp(-out.p * out.p / across)) / (2 * out.p)
                     : out.p;
  out.angle_rad = phi < 0 ? phi / 2 + pi : phi / 2;
  const double ratio = out.p / out.across;
  constexpr double linear_from = 4;
  out.angle_sd_rad = ratio >= linear_from ? out.across / (2 * out.p) : angle_half_width(ratio);
  return out;
}

} // namespace umov
