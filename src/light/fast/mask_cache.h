#pragma once
// Private: masks of earlier jobs, in a folder that anybody may empty at any time.

#include "light/fast/mask_file.h"

#include <optional>

namespace umov {

/// The masks of that key, if the folder holds them whole. Whatever is wrong with a file is no
/// matter: it is made anew.
std::optional<MaskStore> read_cached_masks(const std::filesystem::path &folder, std::uint64_t key,
                                           const GroupPlan &plan, const MaskSize &size);
/// Puts them there, whole or not at all, beside the rows that the folder holds already, and removes
/// what was not asked for the longest until there is no more than a gigabyte. What cannot be
/// written is left: nothing depends on it.
void cache_masks(const std::filesystem::path &folder, std::uint64_t key, const GroupPlan &plan,
                 const MaskSize &size, const MaskStore &masks);

} // namespace umov
