#include <umov/reduction/polarization.h>

#include <algorithm>
#include <boost/math/distributions/non_central_chi_squared.hpp>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/quadrature/gauss.hpp>
#include <boost/math/special_functions/bessel.hpp>
#include <boost/math/tools/roots.hpp>
#include <cmath>
#include <umov/core/quantity.h>

namespace umov {
namespace {

/// In double precision throughout: Boost's own way by long double is six times slower and adds
/// nothing to limits of nine digits.
using InDouble = boost::math::policies::policy<boost::math::policies::promote_double<false>>;

double bessel_i(int order, double z) { return boost::math::cyl_bessel_i(order, z, InDouble()); }

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

/// The true degree for which `x` is likeliest: x I1(x nu) = nu I0(x nu), 0 up to sqrt 2. Newton
/// from above: I1/I0 is concave, so that no step goes past the root.
double likeliest(double x) {
  if (x * x <= 2)
    return 0;
  double nu = x;
  constexpr int most = 60; // near sqrt 2, where the root parts from that at 0, steps only halve
  for (int k = 0; k < most; ++k) {
    const double ratio = bessel_i(1, x * nu) / bessel_i(0, x * nu);
    const double slope = x * x * (1 - ratio * ratio) - x * ratio / nu - 1;
    const double step = (x * ratio - nu) / slope;
    nu -= step;
    if (std::abs(step) < 1e-13 * x)
      break;
  }
  return nu;
}

/// Logarithm of the Rice density at x of a true nu over that of the likeliest nu.
double log_ratio(double x, double nu) {
  const double best = likeliest(x);
  return (best * best - nu * nu) / 2 + std::log(bessel_i(0, x * nu) / bessel_i(0, x * best));
}

/// Probability of less than x at a true nu: the square is non-central chi-squared.
double below(double x, double nu) {
  if (x <= 0)
    return 0;
  if (nu < 1e-8)
    return -std::expm1(-x * x / 2);
  return boost::math::cdf(
      boost::math::non_central_chi_squared_distribution<double, InDouble>(2, nu * nu), x * x);
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

double interval_sd(const LinearCovariance &c) {
  const double mean = (c[0][0] + c[1][1]) / 2, half = std::hypot((c[0][0] - c[1][1]) / 2, c[0][1]);
  constexpr double unlike = 2;
  return std::sqrt(mean + half > unlike * (mean - half) ? mean + half : mean);
}

double angle_half_width(double x) {
  constexpr double level = 0.6827;
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
    return 2 * boost::math::quadrature::gauss<double, 30>::integrate(density, 0, half) - level;
  };
  return root_between(within, 0, pi / 2);
}

double angle_reach(double x) { return x < angle_unknown_below ? pi / 2 : angle_half_width(x); }

PolarizationEstimate polarization_of(double q, double u, const LinearCovariance &c) {
  PolarizationEstimate out;
  out.p = std::hypot(q, u);
  const double phi = std::atan2(u, q), x = std::cos(phi), y = std::sin(phi);
  const double along = x * x * c[0][0] + 2 * x * y * c[0][1] + y * y * c[1][1];
  // Of a covariance that is all but singular rounding can leave less than nothing.
  const double across = std::max(0.0, y * y * c[0][0] - 2 * x * y * c[0][1] + x * x * c[1][1]);
  out.sd = std::sqrt(std::max(0.0, along));
  out.across = std::sqrt(across);
  out.debiased = out.p > 0 && across > 0
                     ? out.p - across * (1 - std::exp(-out.p * out.p / across)) / (2 * out.p)
                     : out.p;
  out.angle_rad = phi < 0 ? phi / 2 + pi : phi / 2;
  const double ratio = out.across > 0 ? out.p / out.across : INFINITY;
  constexpr double linear_from = 4;
  out.angle_sd_rad = ratio >= linear_from ? out.across / (2 * out.p) : angle_half_width(ratio);
  return out;
}

} // namespace umov
