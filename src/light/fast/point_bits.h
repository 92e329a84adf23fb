#pragma once
// Private: what the masks know of each point of a class around the directions of a pose.

#include "backend/scene_data.h"

#include <vector>

namespace umov {

/// A point of which the three directions around the Sun, or around the observer, do not say the
/// same.
struct DoubtfulPoint {
  std::uint32_t of = 0;    ///< which of the classes that are asked together
  std::uint32_t index = 0; ///< among the class's points
  bool asks_sun = false, asks_observer = false;
};

/// Splits the points of a class into those that are free towards both whichever of the directions
/// around is asked (their number is returned), those hidden likewise, and the others, which go to
/// the end of `doubtful` as those of class `of`.
std::size_t split_points(const backend::Masks &masks, const backend::PoseData<double> &pose,
                         std::uint32_t group, std::uint32_t lane, std::uint32_t of,
                         std::vector<DoubtfulPoint> &doubtful);

} // namespace umov
