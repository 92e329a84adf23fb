#pragma once
// How the joints of an object move in time.

#include <umov/attitude/attitude.h>
#include <umov/scene/articulation.h>
#include <variant>

namespace umov {

/// An angle of its own at given times, linear between them and constant beyond.
struct AngleTable {
  std::vector<Epoch<Utc>> time;
  std::vector<double> angle_rad;
};
/// A joint that follows a direction, stands at an angle, or obeys a table.
struct MovingJoint {
  Joint joint;
  std::variant<Direction, double, AngleTable> motion = Direction(Target::Sun);
};

/// Angles of all joints [rad], in order. Physics where a target has no direction.
Result<std::vector<double>> joint_angles(const std::vector<MovingJoint> &joints,
                                         const AttitudeContext &now,
                                         const Rotation<Body, Gcrs> &body_from_gcrs);

/// The joints alone.
std::vector<Joint> joints_of(const std::vector<MovingJoint> &moving);

} // namespace umov
