#pragma once
// Private: which vertices are the same point.

#include <atomic>
#include <cstdint>
#include <umov/shape/mesh.h>
#include <vector>

namespace umov {

/// Length of the diagonal of the bounding box of all positions in use [m].
double mesh_size(const Mesh &mesh);

/// For each position the index of the first one within `distance` of it (in order of the list).
/// Throws Failure (Interrupted) once `cancel`, which may be null, became true.
std::vector<std::uint32_t> weld(const Mesh &mesh, double distance, const std::atomic<bool> *cancel);

/// Distance at which corners count as one: 1e-6 of the size of the mesh.
double weld_distance(const Mesh &mesh);

/// True if the triangle has no area: two corners are one point, or its height is below `distance`
/// squared over its size.
bool is_degenerate(const Mesh &mesh, const Triangle &t, const std::vector<std::uint32_t> &welded);

} // namespace umov
