#include "surface/albedo.h"

#include "kernel/fresnel.inl.h"
#include "kernel/microfacet.inl.h"
#include "surface/gauss.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace umov {
namespace {

constexpr double pi = std::numbers::pi;
/// Even, for Simpson's rule; equal steps of sqrt(n.k) because R bends near grazing.
constexpr std::size_t cells = 96;

double fresnel_mean(double cosine, const std::complex<double> *eta) {
  if (eta == nullptr)
    return 1;
  return kernel::reflection(
             kernel::fresnel(cosine, kernel::Complex<double>{eta->real(), eta->imag()}))
      .a;
}

/// Over directions of the observer, for wide lobes: the kink of min(P(l), P(v)) lies at n.v = n.l,
/// and panels that grow away from the mirror direction follow the peak at grazing incidence.
double albedo_over_directions(double n_l, const std::complex<double> *eta,
                              const SpecularWeight &weight) {
  const double s_l = std::sqrt((1 - n_l) * (1 + n_l));
  const auto at = [&](double n_v, double phi) {
    const double l_v = n_l * n_v - s_l * std::sqrt((1 - n_v) * (1 + n_v)) * std::cos(phi);
    return weight(n_l, n_v, l_v, kernel::half_cosine(n_l, n_v, l_v)) *
           fresnel_mean(std::sqrt(std::max(0.0, (1 + l_v) / 2)), eta);
  };
  const auto over_azimuth = [&](double n_v) { // phi counts from the forward direction
    double sum = 0, from = 0;
    for (double to = std::max(n_l, 1e-3); from < pi; to *= 5) {
      sum += gauss_integral<20>(from, std::min(to, pi), [&](double phi) { return at(n_v, phi); });
      from = to;
    }
    return 2 * sum;
  };
  double sum = 0, from = 0;
  for (double to = n_l; from < 1; to *= 5) {
    sum += gauss_integral<20>(from, std::min(to, 1.0), over_azimuth);
    from = to;
  }
  return sum / n_l;
}

/// Over microfacet normals, dw_v = 4 (h.l) dw_h, for narrow lobes: as smooth as D.
double albedo_over_normals(double n_l, double exponent, const std::complex<double> *eta,
                           const SpecularWeight &weight) {
  const double sine = std::sqrt((1 - n_l) * (1 + n_l));
  const double last = std::min(pi / 2, 9 / std::sqrt(exponent + 2));
  const auto over_azimuth = [&](double theta) {
    const double c = std::cos(theta), s = std::sin(theta);
    const auto term = [&](double phi) {
      const double h_l = c * n_l + s * sine * std::cos(phi);
      const double n_v = 2 * h_l * c - n_l;
      if (h_l <= 0 || n_v <= 0)
        return 0.0;
      const double l_v = std::min(1.0, 2 * h_l * h_l - 1);
      return weight(n_l, n_v, l_v, c) * 4 * h_l * fresnel_mean(h_l, eta);
    };
    // n.v > 0 needs cos(phi) above a limit: integrate up to it, not across the cut.
    const double limit = s * sine > 0 ? (n_l / (2 * c) - c * n_l) / (s * sine) : -1;
    const double end = std::acos(std::clamp(limit, -1.0, 1.0));
    return 2 * s * gauss_integral(0, end, term);
  };
  // The cut begins where the mirrored direction reaches the horizon.
  const double kink = std::min(last, (pi / 2 - std::acos(n_l)) / 2);
  double sum = gauss_integral(0, kink, over_azimuth);
  if (last > kink)
    sum += gauss_integral(0, std::sqrt(last - kink),
                          [&](double t) { return 2 * t * over_azimuth(kink + t * t); });
  return sum / n_l;
}

} // namespace

double directional_albedo(double n_k, double exponent, const std::complex<double> *eta,
                          const SpecularWeight &weight) {
  const double n_l = std::clamp(n_k, 1e-6, 1.0); // the limit at grazing is reached long before
  return exponent < 20 ? albedo_over_directions(n_l, eta, weight)
                       : albedo_over_normals(n_l, exponent, eta, weight);
}

BodyTable::BodyTable(double reflectance, double exponent, std::complex<double> eta,
                     const SpecularWeight &weight)
    : factor_(0) {
  double mean = 0;
  for (std::size_t i = 0; i <= cells; ++i) {
    const double root = static_cast<double>(i) / cells;
    // Without an interface nothing is reflected: exactly R_sub / pi.
    const double r = eta == 1.0 ? 0 : directional_albedo(root * root, exponent, &eta, weight);
    passed_.push_back(1 - r);
    const double simpson = i == 0 || i == cells ? 1 : i % 2 == 1 ? 4 : 2;
    mean += simpson * r * 4 * root * root * root / (3.0 * cells); // 2 R mu dmu, mu = root^2
  }
  factor_ = reflectance / (pi * (1 - mean));
}

double BodyTable::passed(double n_k) const {
  const double x = std::sqrt(n_k) * cells;
  const auto i = std::clamp<std::size_t>(static_cast<std::size_t>(x), 1, cells - 2);
  const double t = x - static_cast<double>(i);
  const double *v = &passed_[i - 1];
  const double a = t + 1, b = t, c = t - 1, d = t - 2;
  return -v[0] * b * c * d / 6 + v[1] * a * c * d / 2 - v[2] * a * b * d / 2 + v[3] * a * b * c / 6;
}

double BodyTable::operator()(double n_l, double n_v) const {
  return factor_ * passed(n_l) * passed(n_v) * n_l * n_v;
}

} // namespace umov
