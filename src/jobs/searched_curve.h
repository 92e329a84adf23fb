#pragma once
// Private: the curve that a search asks, where a night has more rows than directions.

#include <umov/inverse/likelihood.h>
#include <umov/scene/scene.h>

namespace umov::jobs {

/// What all attitudes at rest are compared with: a curve of over a hundred epochs with those joined
/// between which the top of the object's narrowest glint changes by a quarter of the floor at most;
/// else the curve itself. Not with clouds, of which each epoch has its own, nor with outliers,
/// which a mean would spread.
ObservedCurve searched_curve(const ObservedCurve &curve, const Scene &scene,
                             const CurveErrors &errors);

} // namespace umov::jobs
