#pragma once
// Private: a scene made ready for light that touches more than one surface.

#include "light/between/area_choice.h"

#include "light/between/directions.h"

#include <memory>
#include <umov/scene/scene.h>
#include <umov/shape/occluder.h>
#include <umov/shape/topology.h>

namespace umov {

/// A point of the surface, on the side that faces where the path came from.
struct Vertex {
  Vec3<Body> point{}, face{}, normal{}; ///< face: geometric, normal: shading; out of that side
  Vec3<Body> field{};
  const Surface *surface = nullptr;
  const Sampler *sampler = nullptr;
  bool is_by_mirror = false; ///< the path goes on from here (towards the Sun) as from a mirror
  std::uint32_t triangle = 0, slot = 0; ///< slot: of the surface (surface_of_slot)
  bool is_front = true;
};

class MirrorParts;

/// What does not depend on the pose.
class BounceScene {
public:
  /// Both must live. `sides` of the scene's mesh.
  BounceScene(const Scene &scene, const std::vector<VisibleSides> &sides);
  ~BounceScene();

  /// The point of a triangle with two barycentric coordinates, lifted off the side faced.
  [[nodiscard]] Vertex vertex_on(std::uint32_t t, double b1, double b2, Vec3<Body> towards) const;
  /// The next surface along a ray, if there is one.
  bool next(const Occluder &occluder, const Vertex &from, Vec3<Body> direction, Vertex &to,
            double &distance) const;
  [[nodiscard]] const Scene &scene() const { return scene_; }
  /// Per triangle.
  [[nodiscard]] const std::vector<VisibleSides> &sides() const { return sides_; }
  [[nodiscard]] const std::vector<double> &areas() const { return area_m2_; }
  [[nodiscard]] Vec3<Body> normal(std::uint32_t triangle) const { return normal_[triangle]; }
  [[nodiscard]] const MirrorParts &mirrors() const { return *mirrors_; }

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
  std::unique_ptr<const MirrorParts> mirrors_;
  std::vector<Sampler> front_sampler_, back_sampler_; ///< per mesh group
};

} // namespace umov
