#include <cmath>
#include <umov/core/random.h>
#include <umov/core/rotation.h>
#include <umov/light/poses.h>

namespace umov {
namespace {

constexpr std::uint32_t pose_stream = 0x706f7365; // "pose": apart from every other use of a seed

} // namespace

Pose random_pose(std::uint64_t seed, std::uint64_t index, Angle phase_angle) {
  const auto u = uniform4(seed, pose_stream, index);
  // Shoemake 1992 (Graphics Gems III): a uniform unit quaternion from three uniform numbers.
  const double a = std::sqrt(1 - u[0]), b = std::sqrt(u[0]);
  const Quaternion q{b * std::cos(2 * pi * u[2]), a * std::sin(2 * pi * u[1]),
                     a * std::cos(2 * pi * u[1]), b * std::sin(2 * pi * u[2])};
  const auto body_from_lab = rotation_from<Body, Gcrs>(q);
  const Vec3<Gcrs> sun{1, 0, 0};
  const Vec3<Gcrs> observer{std::cos(phase_angle.radians()), std::sin(phase_angle.radians()), 0};
  return {normalized(body_from_lab * sun), normalized(body_from_lab * observer)};
}

} // namespace umov
