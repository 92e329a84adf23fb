#include <umov/observation/moving_joints.h>

#include <algorithm>

namespace umov {
namespace {

double angle_in(const AngleTable &table, Epoch<Utc> time) {
  const auto after =
      std::upper_bound(table.time.begin(), table.time.end(), time,
                       [](Epoch<Utc> a, Epoch<Utc> b) { return seconds_between(b, a) > 0; });
  if (after == table.time.begin())
    return table.angle_rad.front();
  if (after == table.time.end())
    return table.angle_rad.back();
  const auto k = static_cast<std::size_t>(after - table.time.begin());
  const double share =
      seconds_between(time, table.time[k - 1]) / seconds_between(table.time[k], table.time[k - 1]);
  return table.angle_rad[k - 1] + share * (table.angle_rad[k] - table.angle_rad[k - 1]);
}

} // namespace

std::vector<Joint> joints_of(const std::vector<MovingJoint> &moving) {
  std::vector<Joint> out;
  out.reserve(moving.size());
  for (const MovingJoint &one : moving)
    out.push_back(one.joint);
  return out;
}

Result<std::vector<double>> joint_angles(const std::vector<MovingJoint> &moving,
                                         const AttitudeContext &now,
                                         const Rotation<Body, Gcrs> &body_from_gcrs) {
  const std::vector<Joint> joints = joints_of(moving);
  std::vector<double> out(moving.size(), 0);
  for (std::size_t k = 0; k < moving.size(); ++k) {
    if (const auto *fixed = std::get_if<double>(&moving[k].motion)) {
      out[k] = *fixed;
    } else if (const auto *table = std::get_if<AngleTable>(&moving[k].motion)) {
      out[k] = angle_in(*table, now.time);
    } else {
      UMOV_ASSIGN(direction, direction_to(std::get<Direction>(moving[k].motion), now));
      out[k] = following_angle(joints, k, out, body_from_gcrs * direction);
    }
  }
  return out;
}

} // namespace umov
