#pragma once
// Private: which points of each class are free in each direction of a grid, by rays.

#include "light/fast/mask_points.h"
#include "light/fast/stores.h"

namespace umov {

struct MaskSize {
  std::size_t small_cells = 64, large_cells = 64; ///< per edge of the octahedron's square, even
};

/// Traces every point towards every direction that its class can face. The same bytes for any
/// number of threads.
MaskStore build_masks(const Scene &scene, const Elements &elements, const FacetClasses &classes,
                      const GroupPlan &plan, const Occluder &occluder, const MaskSize &size,
                      unsigned threads);

/// Bytes that the masks hold.
std::size_t memory_of(const MaskStore &masks);

} // namespace umov
