#pragma once
// Private: the normals of classes of curved parts, where a lobe is narrower than the elements.

#include "light/fast/compile.h"
#include "light/fast/mask_points.h"

#include <atomic>

namespace umov {

/// Adds to `out`, whose groups are those of `plan`, what the normals of curved elements take on, in
/// slots with a lobe that is narrower than elements are cut (element_turn_min_rad). Throws Failure
/// (Interrupted) once `cancel`, which may be null, became true.
void add_patches(const Elements &elements, const FacetClasses &classes, const GroupPlan &plan,
                 CompiledScene &out, const std::atomic<bool> *cancel);

} // namespace umov
