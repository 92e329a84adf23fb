#pragma once
// Rows of a dense curve that see the object from next to the same directions, as one.

#include <umov/inverse/observed_curve.h>

namespace umov {

/// How far directions may lie apart among epochs that are joined.
struct JoinLimits {
  double halfway_rad = 0;    ///< of the bisector of Sun and observer, which glints follow
  double directions_rad = 0; ///< of the Sun and of the observer themselves
};

/// A curve of a body at rest with the epochs of a stretch of next to the same directions as one:
/// the mean of their samples, the sum of their counts, at their mean time and directions. Rows are
/// joined with their like: of one band, with errors within a factor of two, with and without q and
/// u apart, counts by analysers that stand alike, in exposures within a factor of two and with as
/// many channels (each of a sequence of analysers at its own mean time). They belong to no `set`.
/// Over a stretch of a width x the light at its middle is off from the mean by x^2/24 of the
/// curvature: t slopes s from the middle of a normal lobe by (t^2 - 1) (x/s)^2/24 of it. What it
/// changes by from one end to the other is no longer told. A curve that is not dense comes back as
/// it is.
ObservedCurve joined_epochs(const ObservedCurve &curve, const JoinLimits &limits);

} // namespace umov
