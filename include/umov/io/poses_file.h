#pragma once
// Poses of a signature in files.

#include <cstdint>
#include <string>
#include <string_view>
#include <umov/core/result.h>
#include <umov/scene/pose.h>
#include <vector>

namespace umov {

/// Poses and the numbers that they have in the output.
struct PoseTable {
  std::vector<Pose> poses;
  std::vector<std::int64_t> number;
};

/// CSV with columns sun_x, sun_y, sun_z, obs_x, obs_y, obs_z: directions of any length in body
/// axes; and pose, a whole number: consecutive rows of one number (a pose in several bands) are one
/// pose. Without it rows are counted from 0. BadInput with the line of what is wrong.
Result<PoseTable> read_poses(std::string_view text, const std::string &file);

} // namespace umov
