#pragma once
// Private: a scene made ready for light that touches more than one surface.

#include "light/between/area_choice.h"

#include "light/between/directions.h"

#include <umov/scene/scene.h>
#include <umov/shape/topology.h>

namespace umov {

/// What does not depend on the pose.
class BounceScene {
public:
  /// Both must live. `sides` of the scene's mesh.
  BounceScene(const Scene &scene, const std::vector<VisibleSides> &sides);

private:
  friend class PathSampler;
  /// Neighbours in the mesh of one material and about one normal, of a 400th of the area.
  void group_triangles();

  const Scene &scene_;
  const std::vector<VisibleSides> &sides_;
  std::vector<Vec3<Body>> normal_; ///< per triangle: unit geometric normal, zero without area
  std::vector<double> area_m2_;
  double size_m_ = 0;
  AreaGroups groups_;
  std::vector<Sampler> front_sampler_, back_sampler_; ///< per mesh group
};

} // namespace umov
