#pragma once
// Private: which points of each class are free in each direction of a grid, by rays.

#include "light/fast/mask_points.h"
#include "light/fast/stores.h"

#include <atomic>

namespace umov {

struct MaskSize {
  std::size_t small_cells = 64, large_cells = 64; ///< per edge of the octahedron's square, even
};

/// All that the plan decides: groups, entries, cells, the sizes of the lists. No direction is
/// traced: everything is hidden.
MaskStore empty_masks(const GroupPlan &plan, const MaskSize &size);

/// Where a row begins that has not been traced.
inline constexpr std::uint32_t untraced = 0xFFFFFFFF;

/// Points of the lanes of an entry: a whole group, or one class with words of its own.
struct MaskEntry {
  std::size_t blocks = 0; ///< of 64 bytes
  bool is_large = false;
  std::vector<Vec3<Body>> normal;  ///< per lane; one for a large entry
  std::vector<ClassPoints> points; ///< per lane
};

/// Traces every point towards directions of a grid, as far as its class can face them. The same
/// bytes of a row for any number of threads and any order of the rows. `occluder` must live.
class MaskTracer {
public:
  /// Throws Failure (Interrupted) once `cancel`, which may be null, became true.
  MaskTracer(const Scene &scene, const Elements &elements, const FacetClasses &classes,
             const GroupPlan &plan, const Occluder &occluder, const std::atomic<bool> *cancel);
  /// Adds the rows of directions that have none yet; none of them once `cancel`, which may be null,
  /// became true.
  void trace(std::span<const std::uint32_t> directions, bool is_large, unsigned threads,
             MaskStore &masks, const std::atomic<bool> *cancel) const;
  /// What the bits of a lane stand for, in their order.
  [[nodiscard]] std::span<const Occluder::Point> points(const backend::GroupMask &group,
                                                        std::uint32_t lane) const {
    return group.is_large ? large_[group.entry + lane].points[0].origin
                          : small_[group.entry].points[lane].origin;
  }

private:
  std::vector<MaskEntry> small_, large_;
  const Occluder &occluder_;
};

/// Adds the rows that `known` has and `masks` lacks; both of one plan and size.
void add_rows(const MaskStore &known, MaskStore &masks);

/// Bytes that the masks hold.
std::size_t memory_of(const MaskStore &masks);

} // namespace umov
