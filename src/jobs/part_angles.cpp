#include "jobs/part_angles.h"

#include <fmt/format.h>

namespace umov::jobs {

PartAngles::PartAngles(std::span<const MovingJoint> parts, bool has_sun, const std::string &file,
                       Diagnostics &diagnostics) {
  for (const MovingJoint &part : parts) {
    joints_.push_back(part.joint);
    const auto *fixed = std::get_if<double>(&part.motion);
    const auto *direction = std::get_if<Direction>(&part.motion);
    const auto *target = direction != nullptr ? std::get_if<Target>(direction) : nullptr;
    const bool follows_sun = target != nullptr && *target == Target::Sun && has_sun;
    const bool follows_observer = target != nullptr && *target == Target::Observer;
    fixed_rad_.push_back(fixed != nullptr ? *fixed : 0);
    follows_.push_back(follows_sun        ? Follows::Sun
                       : follows_observer ? Follows::Observer
                                          : Follows::Nothing);
    if (fixed == nullptr && !follows_sun && !follows_observer)
      diagnostics.warn(fmt::format("part \"{}\" stands as in the mesh: what it follows has no "
                                   "direction without an orbit and a time",
                                   part.joint.name),
                       {file});
  }
}

std::vector<double> PartAngles::of(std::span<const Pose> poses) const {
  std::vector<double> out;
  out.reserve(poses.size() * joints_.size());
  std::vector<double> angles(joints_.size());
  for (const Pose &pose : poses) {
    for (std::size_t k = 0; k < joints_.size(); ++k)
      angles[k] = follows_[k] == Follows::Sun ? following_angle(joints_, k, angles, pose.sun)
                  : follows_[k] == Follows::Observer
                      ? following_angle(joints_, k, angles, pose.observer)
                      : fixed_rad_[k];
    out.insert(out.end(), angles.begin(), angles.end());
  }
  return out;
}

} // namespace umov::jobs
