#pragma once
// Glints of flats: found by bounding how fast they can come, not by chance of the step.

#include <atomic>
#include <functional>
#include <umov/core/result.h>
#include <umov/scene/scene.h>
#include <vector>

namespace umov {

/// Half width of the widest lobe that still mirrors the Sun: a paint that shines all over does not.
inline constexpr double widest_glint_rad = 0.2;

/// Facets of one normal and material, seen from the side that the normal faces.
struct GlintFlat {
  Vec3<Body> normal;         ///< unit, out of the side that reflects
  double half_width_rad = 0; ///< of the lobe, between normal and half vector
  double area_m2 = 0;
  std::uint32_t group = 0; ///< of the mesh
};

/// Flats that can glint: of `flat` normals, at least `least_share` of the largest one's area, lobes
/// no wider than `widest_rad`; the largest first. Throws Failure (Interrupted) once `cancel` became
/// true.
std::vector<GlintFlat> glint_flats(const Scene &scene, double least_share = 0.02,
                                   double widest_rad = widest_glint_rad,
                                   const std::atomic<bool> *cancel = nullptr);

/// Unit vectors to Sun and observer, body frame.
struct GlintView {
  Vec3<Body> sun, observer;
};
/// The view at seconds from some origin.
using GlintPath = std::function<Result<GlintView>(double seconds)>;

/// A stretch of time in which a flat mirrors the Sun to the observer.
struct Glint {
  double seconds = 0;   ///< when normal and half vector are nearest
  double miss_rad = 0;  ///< their angle then
  double width_s = 0;   ///< for how long the angle stays below the limit, within the span
  std::size_t flat = 0; ///< into the list asked for
};

/// Every stretch between two times in which the half vector comes within the lobe's half width plus
/// `half_disk_rad` (half the Sun's radius: what the disk makes of the half vector) of a flat's
/// normal; times to 0.1 ms. `rate_rad_s` bounds how fast the half vector can move in the body
/// frame: with it none is missed. In order of time.
Result<std::vector<Glint>> find_glints(const std::vector<GlintFlat> &flats, const GlintPath &path,
                                       double first_s, double last_s, double rate_rad_s,
                                       double half_disk_rad);

} // namespace umov
