#include "surface/masking.h"

#include "kernel/gauss.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <umov/core/quantity.h>

namespace umov {
namespace {

constexpr std::size_t cells_of_slope = 2048;

/// Integral over azimuth of max(a + b cos phi, 0); closed (of g in microfacet.md, Eq. 4).
double azimuth_integral(double a, double b) {
  if (a >= b)
    return 2 * pi * a;
  const double ratio = std::clamp(-a / b, -1.0, 1.0);
  const double phi = std::acos(ratio);
  return 2 * (a * phi + b * std::sqrt(1 - ratio * ratio));
}

} // namespace

double Masking::integral(double n_k, const std::function<double(double)> &density,
                         double reach_rad) {
  const double sine = std::sqrt(std::max(0.0, (1 - n_k) * (1 + n_k)));
  const auto integrand = [&](double theta) {
    const double c = std::cos(theta), s = std::sin(theta);
    return density(std::max(c, 0.0)) * s * azimuth_integral(c * n_k, s * sine);
  };
  const double last = std::min(pi / 2, reach_rad);
  // Facets tilted by more than 90 deg - theta_k are cut by the horizon of k: a kink.
  const double kink = std::min(last, std::asin(std::min(1.0, n_k)));
  double sum = gauss_integral(0, kink, integrand);
  // Just past the kink the integrand rises like a power 3/2: t^2 makes it smooth.
  const double width = std::sqrt(last - kink);
  sum += gauss_integral(0, width, [&](double t) { return 2 * t * integrand(kink + t * t); });
  return sum;
}

Masking::Masking(const std::function<double(double)> &density, double reach_rad)
    : limit_(std::min(1.0, std::sin(std::min(reach_rad, pi / 2)))),
      per_cell_(cells_of_slope / limit_) {
  for (std::size_t i = 0; i <= cells_of_slope; ++i)
    values_.push_back(
        integral(limit_ * static_cast<double>(i) / cells_of_slope, density, reach_rad));
}

double Masking::operator()(double n_k) const {
  if (n_k <= 0)
    return 0;
  if (n_k >= limit_)
    return limit_ < 1 ? 1 : std::min(1.0, n_k / values_.back());
  const double x = n_k * per_cell_;
  const auto i = std::clamp<std::size_t>(static_cast<std::size_t>(x), 1, cells_of_slope - 2);
  const double t = x - static_cast<double>(i);
  // Lagrange's cubic through i-1, i, i+1, i+2.
  const double *v = &values_[i - 1];
  const double a = t + 1, b = t, c = t - 1, d = t - 2;
  const double value =
      -v[0] * b * c * d / 6 + v[1] * a * c * d / 2 - v[2] * a * b * d / 2 + v[3] * a * b * c / 6;
  return std::min(1.0, n_k / value);
}

} // namespace umov
