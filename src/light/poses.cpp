#include <cmath>
#include <umov/core/random.h>
#include <umov/core/rotation.h>
#include <umov/light/poses.h>

namespace umov {
namespace {

constexpr std::uint32_t pose_stream = 0x706f7365; // "pose": apart from every other use of a seed

} // namespace

Quaternion random_rotation(std::uint64_t seed, std::uint32_t stream, std::uint64_t index) {
  const auto u = uniform4(seed, stream, index);
  const double a = std::sqrt(1 - u[0]), b = std::sqrt(u[0]);
  return {b * std::cos(2 * pi * u[2]), a * std::sin(2 * pi * u[1]), a * std::cos(2 * pi * u[1]),
          b * std::sin(2 * pi * u[2])};
}

Pose random_pose(std::uint64_t seed, std::uint64_t index, Angle phase_angle) {
  const auto body_from_lab = rotation_from<Body, Gcrs>(random_rotation(seed, pose_stream, index));
  const Vec3<Gcrs> sun{1, 0, 0};
  const Vec3<Gcrs> observer{std::cos(phase_angle.radians()), std::sin(phase_angle.radians()), 0};
  return {normalized(body_from_lab * sun), normalized(body_from_lab * observer)};
}

} // namespace umov
