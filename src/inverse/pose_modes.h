#pragma once
// Private: from fits to modes.

#include "inverse/turning_fit.h"

#include <umov/inverse/pose_search.h>

namespace umov::inverse {

/// Fits, best first, as modes: those that are one and the same peak joined, those that hold less
/// than e^-15 of the best left out; weights by Laplace's integral.
///
/// Spins are one peak within an ellipsoid about the better fit whose half axes, in the principal
/// directions of its covariance, are 1 deg or three standard deviations, and .2 rad in the one that
/// it knows least: along a valley, whose floor is rough, fits end in dents. Attitudes are one peak
/// within 1 deg or three standard deviations of that direction, whichever way.
std::vector<PoseMode> modes_of(const std::vector<TurningFit> &fits, double span_s);

} // namespace umov::inverse
