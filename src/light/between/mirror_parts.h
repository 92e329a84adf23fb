#pragma once
// Parts of a mesh that are nearly mirrors: one narrow lobe about nearly one normal.

#include "light/between/bounce_scene.h"

#include <cstdint>
#include <vector>

namespace umov {

/// One side of neighbours of one material, in a rectangle.
struct MirrorPart {
  Vec3<Body> normal{};          ///< mean of its shading normals, out of this side
  Vec3<Body> along{}, across{}; ///< of the rectangle, in its plane
  Vec3<Body> centre{};          ///< [m]
  double half_along_m = 0, half_across_m = 0;
  double width = 0; ///< rms slope of the lobe and of the bend of normals
  NormalSampler normals{{LobeKind::BlinnPhong, 0}}; ///< about `normal`, as wide as both
};

/// Those of a scene: runs of triangles as the mesh lists them. What is none is met by chance alone.
class MirrorParts {
public:
  static constexpr std::uint32_t none = no_index;

  explicit MirrorParts(const BounceScene &scene);

  /// The lobe of such a part: what stands before it is met by few of its directions.
  static bool is_narrow(const Surface &surface);
  [[nodiscard]] const std::vector<MirrorPart> &parts() const { return parts_; }
  /// That on which a point lies, if there is one.
  [[nodiscard]] std::uint32_t part_of(const Vertex &at) const {
    return parts_.empty() ? none : of_[2 * at.triangle + (at.is_front ? 0 : 1)];
  }

private:
  void add(const BounceScene &scene, std::size_t begin, std::size_t end, bool is_front);

  std::vector<MirrorPart> parts_;
  std::vector<std::uint32_t> of_; ///< per triangle and side
};

} // namespace umov
