#pragma once
#include <cstdint>
#include <umov/core/quantity.h>
#include <umov/core/rotation.h>
#include <umov/light/integrator.h>

namespace umov {

/// Rotation number `index` of a random stream of `seed`, all alike (Shoemake 1992, Graphics Gems
/// III, 124: a uniform unit quaternion from three uniform numbers), drawn by Philox from these.
Quaternion random_rotation(std::uint64_t seed, std::uint32_t stream, std::uint64_t index);
/// Pose number `index` of the random stream of `seed`: Sun and observer `phase_angle` apart, turned
/// by a random rotation.
Pose random_pose(std::uint64_t seed, std::uint64_t index, Angle phase_angle);

} // namespace umov
