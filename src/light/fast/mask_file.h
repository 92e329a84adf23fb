#pragma once
// Private: masks on disk, as their preparation may take minutes.

#include "light/fast/mask_points.h"
#include "light/fast/masks.h"

#include <filesystem>
#include <umov/core/result.h>

namespace umov {

/// What masks depend on: the mesh, its classes and their order, points and directions.
std::uint64_t mask_key(const Mesh &mesh, const FacetClasses &classes, const GroupPlan &plan,
                       const MaskSize &size);

/// Whole or not at all. Device if it cannot be written.
Result<void> write_masks(const std::filesystem::path &path, const MaskStore &masks,
                         std::uint64_t key);
/// BadInput for a file that is none, is damaged, was made with another key, or does not hold the
/// groups and directions of the plan.
Result<MaskStore> read_masks(const std::filesystem::path &path, std::uint64_t key,
                             const GroupPlan &plan, const MaskSize &size);

} // namespace umov
