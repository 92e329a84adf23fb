#pragma once
// Private: errors of looked-up visibility (docs/theory/engine.md), calibrated against dense runs
// (tests/engine_errors_test.cpp).

#include "backend/colours.h"

namespace umov {

inline constexpr backend::MaskErrorModel mask_error{1.5F, 0.25F};
using backend::mask_alike;

/// Poses of a series look up the same few directions and err together, so that what is off stays
/// off for many of them: variances of single looked-up facets are taken so much larger, for
/// half-widths to cover nine in ten of a series too (HST, Agena, box-wing and crumpled foil against
/// dense rays).
inline constexpr float mask_series = 2;
/// Of sums in which nothing is taken for certain.
inline constexpr backend::MaskErrorModel doubtful_error{mask_error.points * mask_series,
                                                        mask_error.grid *mask_series, true};

/// The first look at a class by rays: enough points to bring its error down to a third of what may
/// be left, if its whole light is `weight` times that.
std::size_t first_points(double weight);
/// Variance of the share of a class of which `points` found `share` to be lit and seen.
double share_variance(double share, double points);

/// Adds to the variances what the classes' errors have in common.
inline void add_alike(backend::PoseSums &sums) {
  const auto add = [](backend::View<double> linear, backend::View<double> variance) {
    for (std::size_t k = 0; k < linear.size(); ++k)
      variance[k] += mask_alike * linear[k] * linear[k];
  };
  add(sums.specular_linear, sums.specular_variance);
  add(sums.product_linear, sums.product_variance);
}

} // namespace umov
