// Whether a measured table gives more than it gets.
#include <umov/surface/measured.h>

#include "kernel/gauss.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <umov/core/quantity.h>

namespace umov {
namespace {

/// Each albedo takes some ten thousand values of the table, one to two milliseconds: of one with
/// more wavelengths and incidences, those are asked that its own nodes make the brightest.
constexpr std::size_t most_asked = 100;

/// Calls `take(at, weight)` with a node of `axis` and what it counts in the integral of
/// `integrand` times the linear interpolation of the nodes, from `begin` to `end`; the nodes at the
/// ends are held. `Points` of a rule for each step.
template <std::size_t Points, class Integrand, class Take>
void for_weights(const std::vector<double> &axis, double begin, double end,
                 const Integrand &integrand, const Take &take) {
  const auto add = [&](double a, double b, std::size_t low, std::size_t high) {
    if (!(b > a))
      return;
    take(low,
         gauss_integral<Points>(a, b, [&](double x) { return integrand(x) * (b - x); }) / (b - a));
    take(high,
         gauss_integral<Points>(a, b, [&](double x) { return integrand(x) * (x - a); }) / (b - a));
  };
  add(begin, axis.front(), 0, 0);
  for (std::size_t k = 1; k < axis.size(); ++k)
    add(axis[k - 1], axis[k], k - 1, k);
  add(axis.back(), end, axis.size() - 1, axis.size() - 1);
}

std::vector<double> in_radians(std::vector<double> axis) {
  for (double &angle : axis)
    angle *= pi / 180;
  return axis;
}

/// What the value at the observer's angle s in the plane of incidence (positive on the mirror's
/// side) counts in the albedo at incidence i, by radian of s [rad]. It stands for half vectors of
/// its tilt t all around the normal, with d omega_o = 4 cos(d) d omega_h, and shares them with the
/// value of the same tilt at 2i - s, linearly in the incidence d on the half vector, unless one of
/// them alone was measured, up to `last`.
double share_of_ring(double i, double s, double last) {
  const bool is_alone = std::abs(s) <= last && std::abs(2 * i - s) > last;
  if (std::abs(s) > last && std::abs(2 * i - s) <= last)
    return 0;
  const double t = std::abs(i - s) / 2;
  const double near = std::abs(i - t), far = i + t;
  const double here = s < i ? near : far, there = s < i ? far : near;
  return std::sin(t) * gauss_integral<6>(0, pi, [&](double azimuth) {
           const double c =
               std::cos(i) * std::cos(t) + std::sin(i) * std::sin(t) * std::cos(azimuth);
           const double up = 2 * c * std::cos(t) - std::cos(i); // cos(theta_o)
           if (!(up > 0 && c > 0))
             return 0.0;
           double share = is_alone ? 1 : 0.5; // half: both are the same at normal incidence
           if (!is_alone && here != there)
             share = std::clamp((std::acos(std::min(1.0, c)) - there) / (here - there), 0.0, 1.0);
           return 4 * c * up * share;
         });
}

} // namespace

std::vector<double> MeasuredBrdf::node_weights(double theta_i_deg) const {
  const std::vector<double> theta = in_radians(axes_[2]), phi = in_radians(axes_[3]);
  std::vector<double> out(theta.size() * phi.size());
  if (is_in_plane_) {
    // Along s from one horizon to the other: the observer's angles twice, at phi 0 and 180.
    std::vector<double> along;
    for (std::size_t k = theta.size(); k-- > 0;)
      along.push_back(-theta[k]);
    along.insert(along.end(), theta.begin(), theta.end());
    const double i = theta_i_deg * pi / 180;
    for_weights<2>(
        along, -pi / 2, pi / 2, [&](double s) { return share_of_ring(i, s, theta.back()); },
        [&](std::size_t at, double weight) {
          out[at < theta.size() ? 2 * (theta.size() - 1 - at) : 2 * (at - theta.size()) + 1] +=
              weight;
        });
    return out;
  }
  std::vector<double> around(phi.size());
  for_weights<2>(
      phi, 0, pi, [](double) { return 2.0; },
      [&](std::size_t at, double weight) { around[at] += weight; });
  for_weights<6>(
      theta, 0, pi / 2, [](double o) { return std::cos(o) * std::sin(o); },
      [&](std::size_t at, double weight) {
        for (std::size_t p = 0; p < phi.size(); ++p)
          out[at * phi.size() + p] += weight * around[p];
      });
  return out;
}

std::vector<MeasuredBrdf::Albedo> MeasuredBrdf::albedos_by_nodes() const {
  const std::size_t stride = axes_[2].size() * axes_[3].size();
  std::vector<Albedo> out;
  std::vector<double> weights;
  for (std::size_t i = 0; i < axes_[1].size() && axes_[1][i] < 90; ++i) {
    if (i == 0 || is_in_plane_) // the others' are the same at all incidences
      weights = node_weights(axes_[1][i]);
    for (std::size_t w = 0; w < axes_[0].size(); ++w) {
      Albedo one{0, axes_[0][w], axes_[1][i]};
      for (std::size_t k = 0; k < stride; ++k)
        one.value += weights[k] * values_[(w * axes_[1].size() + i) * stride + k][0];
      out.push_back(one);
    }
  }
  return out;
}

MeasuredBrdf::Albedo MeasuredBrdf::largest_albedo(std::vector<std::string> &remarks) const {
  std::vector<Albedo> all = albedos_by_nodes();
  const std::size_t count = all.size(), asked = std::min(count, most_asked);
  // Stable: those of one brightness keep the order of the table, whatever the library.
  std::ranges::stable_sort(all, std::ranges::greater{}, &Albedo::value);
  all.resize(asked);
  Albedo largest;
  for (const Albedo &one : all) {
    const double a = albedo(one.wavelength_nm, one.theta_i_deg * pi / 180);
    if (a > largest.value)
      largest = {a, one.wavelength_nm, one.theta_i_deg};
  }
  if (asked < count)
    remarks.push_back(fmt::format("whether the table gives more than it gets was asked at the {} "
                                  "brightest of {} pairs of wavelength and theta_i",
                                  asked, count));
  return largest;
}

} // namespace umov
