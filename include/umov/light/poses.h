#pragma once
#include <cstdint>
#include <umov/core/quantity.h>
#include <umov/light/integrator.h>

namespace umov {

/// Pose number `index` of the random stream of `seed`: Sun and observer `phase_angle` apart, turned
/// by a rotation uniform on SO(3) (Shoemake 1992), drawn by Philox from seed and index alone.
Pose random_pose(std::uint64_t seed, std::uint64_t index, Angle phase_angle);

} // namespace umov
