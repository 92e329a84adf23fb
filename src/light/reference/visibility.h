#pragma once
// Private: how much of the light of each element is both lit and seen, by rays from points.

#include "light/reference/elements_lit.h"

#include <umov/shape/occluder.h>

namespace umov {

/// What is lit and seen at the same point, with its sampling variance.
struct VisibleSums {
  std::vector<double> specular; ///< [slot * lobes + lobe]: integral of D G / 4 [m2/sr]
  std::vector<Stokes<ScatteringPlane>> diffuse; ///< [slot * bands + band] [m2/sr]
  double glint = 0;              ///< part of the reflected light in band 0 from flats in glint
  std::vector<double> intensity; ///< per band [m2/sr]
  std::vector<Stokes<ScatteringPlane>> half_width;    ///< per band, 95 %, sampling alone
  std::vector<Stokes<ScatteringPlane>> rule_variance; ///< per band: of the rule, over what is seen
  std::uint64_t points = 0, rays = 0;
  bool is_any_seen = false;
};

/// Sums without any hiding: for a convex mesh.
VisibleSums sum_unhidden(const Scene &scene, const LitElements &lit);

/// Sums by ray-tested points, refined until the half-width of I is `options.accuracy` times I in
/// each band or `options.max_points` are used (docs/theory/visibility.md). Throws Failure
/// (Interrupted) once `cancel`, which may be null, became true.
VisibleSums sum_visible(const Scene &scene, const Elements &elements, const Occluder &occluder,
                        const PoseGeometry &pose, const LitElements &lit,
                        const IntegrationOptions &options, const std::atomic<bool> *cancel);

/// Two-sided 95 % quantile of Student's t for `freedom` >= 1 (Abramowitz & Stegun 1972, 26.7.5).
double student_95(double freedom);

} // namespace umov
