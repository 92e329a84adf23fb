#pragma once
// Private: the curve that a search asks, where a night has more rows than directions.

#include <umov/inverse/likelihood.h>
#include <umov/scene/scene.h>

namespace umov::jobs {

/// What all attitudes at rest are compared with: a curve of over a hundred epochs with those of
/// next to the same directions joined, down to a hundred at least; else the curve itself. Means
/// over the narrowest glint of any surface are right to a sixteenth of the floor at its top, to
/// half of it three slopes away. Not with clouds, of which each epoch has its own, nor with
/// outliers, which a mean would spread.
ObservedCurve searched_curve(const ObservedCurve &curve, const Scene &scene,
                             const CurveErrors &errors);

} // namespace umov::jobs
