#pragma once
// Private: the order in which a batch of poses is taken.

#include <cstdint>
#include <span>
#include <umov/light/integrator.h>
#include <vector>

namespace umov {

/// Poses in an order in which neighbours look up nearby directions, of the Sun and of the observer:
/// in their own order random poses fetch six rows of the masks each from far memory, and wait for
/// them. `row_bytes` is the size of one direction's row. Results do not depend on it.
std::vector<std::uint32_t> order_for_masks(std::span<const Pose> poses, std::size_t directions,
                                           std::size_t row_bytes, unsigned threads);

} // namespace umov
