#pragma once
// Private: the points of each class whose visibility the masks hold, and the groups of 16 classes.

#include "backend/scene_data.h"
#include "light/fast/classes.h"

#include <umov/shape/occluder.h>

namespace umov {

/// Order of the classes in groups, and how many points each has.
struct GroupPlan {
  struct Group {
    std::uint32_t slot = 0;
    std::array<std::uint32_t, backend::lanes> member{}; ///< class, or no_index
    std::uint16_t words = 0;                            ///< per lane: 32 points each
    bool is_large = false;
  };
  std::vector<Group> groups; ///< by slot, then by number of points, then by normal
};

/// Classes in groups; `points` are shared out by area (0: no masks, no points).
GroupPlan plan_groups(const FacetClasses &classes, std::size_t points);

/// Points spread evenly over the area of a class, as ray origins.
struct ClassPoints {
  std::vector<Occluder::Point> origin; ///< in the occluder's coordinates
};
ClassPoints spread_points(const Scene &scene, const Elements &elements, const FacetClasses &classes,
                          std::uint32_t of, std::size_t count, const Occluder &occluder);

} // namespace umov
