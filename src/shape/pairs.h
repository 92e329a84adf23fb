#pragma once
// Private: triangles that lie exactly upon each other.

#include <cstdint>
#include <umov/shape/mesh.h>
#include <vector>

namespace umov {

struct FacePairs {
  std::size_t duplicates = 0, opposites = 0;
  /// Per triangle: itself; or the first one that it repeats with the same winding; or, with
  /// `is_opposite`, the one whose other side it is.
  std::vector<std::uint32_t> partner;
  std::vector<bool> is_opposite;
};

FacePairs find_pairs(const Mesh &mesh, const std::vector<std::uint32_t> &welded,
                     const std::vector<bool> &skip);

} // namespace umov
