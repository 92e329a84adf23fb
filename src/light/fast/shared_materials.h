#pragma once
// Private: mesh groups of one material are one to the engine.

#include "light/reference/elements.h"

namespace umov {

/// The materials of a slot: of the scene, then of each hypothesis.
std::vector<const Surface *> surfaces_of(const Scene &scene, const std::vector<Scene> &hypotheses,
                                         std::uint32_t slot);

/// Slots in use, by the first of those that have the same materials in the scene and in every
/// hypothesis. `elements` refer to that one from here on.
using SharedSlots = std::vector<std::vector<std::uint32_t>>;
SharedSlots share_materials(const Scene &scene, const std::vector<Scene> &hypotheses,
                            Elements &elements);

} // namespace umov
