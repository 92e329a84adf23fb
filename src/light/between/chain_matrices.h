#pragma once
// Private: Mueller matrices of what lies between the ends of a chain, of one set of materials.

#include "light/between/chain.h"

#include <umov/optics/stokes.h>
#include <umov/scene/scene.h>

namespace umov {

/// Follows one chain after another from its first end on.
class ChainMatrices {
public:
  using Matrix = Mueller<ScatteringPlane, ScatteringPlane>;
  /// Both must live; `mesh` is that on which chains were drawn, `sides` what it is made of.
  ChainMatrices(const Scene &sides, const Mesh &mesh);

  /// From an end, by its axis and the direction into the chain.
  void start(Vec3<Body> axis, Vec3<Body> along);
  /// Over a surface.
  void pass(const ChainVertex &at);
  /// From the axis of an end that lies where the last direction leads to that of the first end.
  [[nodiscard]] Matrix from(Vec3<Body> axis, std::size_t band) const;
  /// M00 of a band, the largest of the bands, and their mean.
  [[nodiscard]] double transmitted(std::size_t band) const { return matrix_[band].m[0][0]; }
  [[nodiscard]] double strongest() const;
  [[nodiscard]] double transmitted() const;

private:
  const Scene &sides_;
  const Mesh &mesh_;
  std::vector<Matrix> matrix_; ///< per band, to the axis of the first end
  Vec3<Body> axis_{};          ///< that they start from, of the beam along back_
  Vec3<Body> back_{};
};

} // namespace umov
