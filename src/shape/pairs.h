#pragma once
// Private: faces that lie upon each other.

#include <atomic>
#include <cstdint>
#include <umov/shape/mesh.h>
#include <vector>

namespace umov {

/// Triangles of the same three corners.
struct FacePairs {
  /// Per triangle: itself; or the first one that it repeats with the same winding; or, with
  /// `is_opposite`, the one whose other side it is.
  std::vector<std::uint32_t> partner;
  std::vector<bool> is_opposite;
};

/// Throws Failure (Interrupted), here and below, once `cancel`, which may be null, became true.
FacePairs find_pairs(const Mesh &mesh, const std::vector<std::uint32_t> &welded,
                     const std::vector<bool> &skip, const std::atomic<bool> *cancel);

/// Two triangles of one plane with an area in common.
struct Overlap {
  std::uint32_t first, second; ///< first < second
  double area_m2;
  double apart_m; ///< farthest corner of the smaller one from the plane of the larger one
  bool is_opposite;
};

struct Overlaps {
  std::vector<Overlap> pairs;   ///< sorted by first, second
  std::size_t not_searched = 0; ///< triangles in a crowd too dense to look at every neighbour
};

/// Every two triangles that lie upon each other, of those that `skip` does not leave out. Corners
/// may lie off the other's plane by the welding distance, or, where the two share a corner, by 1e-3
/// of the smaller one's longest side: a polygon that is not quite flat has other facets when it is
/// cut along another diagonal. Solid parts that stand against each other do not count: nothing sees
/// the faces between them.
Overlaps find_overlaps(const Mesh &mesh, const std::vector<std::uint32_t> &welded,
                       const std::vector<bool> &skip, const std::atomic<bool> *cancel);

/// What lies upon what, face by face however the faces are cut.
struct Coincidence {
  std::size_t duplicates = 0;  ///< triangles that repeat others with the same winding
  std::size_t other_group = 0; ///< of them, those of another group than what they repeat
  std::size_t opposites = 0;   ///< triangles that stay and got a second side
  std::size_t not_searched = 0;
  std::vector<bool> is_dropped;    ///< per triangle
  std::vector<std::uint32_t> back; ///< per triangle: group of its new back side, or no_index
  /// Overlaps that are left because the outlines differ.
  struct Rest {
    std::uint32_t first_group, second_group;
    bool is_opposite;
    double area_m2;
  };
  std::vector<Rest> rest; ///< largest area first
};

Coincidence find_coincidence(const Mesh &mesh, const std::vector<std::uint32_t> &welded,
                             const std::vector<bool> &skip, const std::atomic<bool> *cancel);

} // namespace umov
