#pragma once
// Private: facets of equal normal and material joined, as one facet costs what a class costs.

#include "light/reference/elements.h"

#include <atomic>
#include <span>

namespace umov {

/// One side of elements that share normal and slot.
struct FacetClass {
  Vec3<Body> normal; ///< unit, out of the side that scatters
  double area_m2 = 0;
  std::uint32_t slot = 0;
  float side = 1;                     ///< +1 front, -1 back of its elements
  double spread2 = 0;                 ///< mean square deviation of the joined normals [rad2]
  std::uint32_t first = 0, count = 0; ///< into FacetClasses::element
};

struct FacetClasses {
  std::vector<FacetClass> list;
  std::vector<std::uint32_t> element; ///< of Elements::list, by class
};

/// Normals nearer than this are one [rad]: rounding of a mesh file's digits.
inline constexpr double equal_normals_rad = 1e-5;

/// Joins sides of elements whose normals lie within the tolerance of their slot of the first of the
/// class.
/// Curved elements count with the normal at their middle, and those that turn less than an element
/// may are joined up to that turn: classes follow the curvature, however fine the mesh.
/// Throws Failure (Interrupted) once `cancel`, which may be null, became true.
FacetClasses join_facets(const Elements &elements, std::span<const double> tolerance_rad,
                         const std::atomic<bool> *cancel = nullptr);

} // namespace umov
