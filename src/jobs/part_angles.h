#pragma once
// Private: how the parts of an object stand where there is no orbit.

#include <span>
#include <umov/core/diagnostics.h>
#include <umov/observation/moving_joints.h>
#include <umov/scene/pose.h>
#include <vector>

namespace umov::jobs {

/// Angles of parts for directions alone: those that follow the Sun or the observer, or stand at an
/// angle, do so; for others there is no direction, and they stand as in the mesh.
class PartAngles {
public:
  /// Warns of parts that cannot turn here. `has_sun`: the source of the poses is the Sun.
  PartAngles(std::span<const MovingJoint> parts, bool has_sun, const std::string &file,
             Diagnostics &diagnostics);
  [[nodiscard]] const std::vector<Joint> &joints() const { return joints_; }
  /// [pose * parts + part] [rad].
  [[nodiscard]] std::vector<double> of(std::span<const Pose> poses) const;

private:
  enum class Follows { Nothing, Sun, Observer };
  std::vector<Joint> joints_;
  std::vector<Follows> follows_;
  std::vector<double> fixed_rad_;
};

} // namespace umov::jobs
