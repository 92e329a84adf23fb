#include "jobs/searched_curve.h"

#include <algorithm>
#include <cmath>
#include <umov/core/quantity.h>
#include <umov/inverse/joined_epochs.h>

namespace umov::jobs {
namespace {

/// Slope of the narrowest lobe of any surface, or of a mirror's, which is the Sun's disk.
double narrowest_glint(const Scene &scene) {
  constexpr double of_disk = 0.0012; // a quarter of its radius: standard deviation of the bisector
  double out = 1;
  for (const auto *side : {&scene.front, &scene.back})
    for (const Surface &surface : *side)
      out = std::min(out, std::max(surface.width(), of_disk));
  return out;
}

} // namespace

ObservedCurve searched_curve(const ObservedCurve &curve, const Scene &scene,
                             const CurveErrors &errors) {
  constexpr std::size_t few = 100; // epochs, which are lit in no time
  if (curve.epochs.size() <= few || errors.has_clouds || errors.outlier_share > 0)
    return curve;
  // (x/s)^2/24 = F/16, joined_epochs.h. Within a degree directions change what scatters widely by
  // some per cent, and in proportion, so that means are right.
  constexpr double widest_rad = pi / 180, least_floor = 0.002;
  const double x = narrowest_glint(scene) * std::sqrt(1.5 * std::max(errors.floor, least_floor));
  double halfway = std::min(x, widest_rad);
  // A burst changes within what a pass may join: no curve is to say less than one of a hundred
  // epochs. After ten halves its directions are the same to a second of arc.
  constexpr int most_halves = 10;
  for (int halves = 0;; ++halves, halfway /= 2) {
    ObservedCurve out = joined_epochs(curve, {halfway, 2 * halfway});
    if (out.epochs.size() >= few || halves == most_halves)
      return out;
  }
}

} // namespace umov::jobs
