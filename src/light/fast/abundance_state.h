#pragma once
// Private: sums as tables, and materials applied to them.

#include "backend/cuda/card_poses.h"
#include "light/fast/compile.h"

#include <span>
#include <umov/light/abundances.h>
#include <umov/scene/pose.h>

namespace umov {

/// Columns and room for poses, all dark.
void begin_abundances(const CompiledScene &scene, const Mesh &mesh, std::span<const Pose> poses,
                      AbundanceTable &out);
/// Writes one pose's sums to its row.
void put_abundances(const CompiledScene &scene, const backend::PoseSums &sums, std::size_t row,
                    AbundanceTable &out);

/// The same of a pose that a card has summed.
void put_abundances(const CompiledScene &scene, const backend::Weighed<const float> &sums,
                    std::size_t row, AbundanceTable &out);

/// BadInput if a material does not fit the sums, or the mesh groups differ.
Result<MaterialTables> make_material_tables(const Scene &materials, const CompiledScene &sums,
                                            const Mesh &mesh, bool is_intensity_only);

} // namespace umov
