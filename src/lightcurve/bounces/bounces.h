#pragma once
// Private: light that has touched more than one surface before it reaches the observer.

#include "lightcurve/bounces/area_choice.h"

#include "lightcurve/bounces/directions.h"

#include <umov/lightcurve/integrator.h>
#include <umov/shape/occluder.h>

namespace umov {

/// Mean over sampled paths and its 95 % half-widths, per band; no path of one surface is in it.
struct IndirectLight {
  std::vector<BandResult> bands;
  std::uint64_t rays = 0;
};

/// What does not depend on the pose.
class BounceScene {
public:
  explicit BounceScene(const Scene &scene);

  /// Paths of 2 to options.bounces surfaces (docs/theory/bounces.md). Refined until the half-width
  /// of I falls below options.accuracy times the whole, `direct_i` per band included, or
  /// options.max_points paths are spent. The result depends on pose and seed alone.
  [[nodiscard]] IndirectLight light(const Occluder &occluder, const Pose &pose,
                                    const IntegrationOptions &options,
                                    const std::vector<double> &direct_i) const;

private:
  friend class PathSampler;
  /// Neighbours in the mesh of one material and about one normal, of a 400th of the area.
  void group_triangles();

  const Scene &scene_;
  std::vector<VisibleSides> sides_;
  std::vector<Vec3<Body>> normal_; ///< per triangle: unit geometric normal, zero without area
  std::vector<double> area_m2_;
  double size_m_ = 0;
  AreaGroups groups_;
  std::vector<Sampler> front_sampler_, back_sampler_; ///< per mesh group
};

} // namespace umov
