#pragma once
// Private: steps as long, in each direction, as what lies around is wide.

#include "inverse/chords.h"

#include <array>

namespace umov::inverse {

/// Attitudes whose spread around a place shapes the steps from there (localised covariances of an
/// ensemble: Leimkuhler, Matthews & Weare 2018, Stat. Comput. 28, 277). A ring, a sheet and a small
/// peak ask for steps of their own, which no common ones fit.
class LocalSteps {
public:
  /// `least_rad`: no direction is narrower.
  LocalSteps(Chords around, double least_rad)
      : around_(std::move(around)), least_square_(least_rad * least_rad) {}

  /// A lower triangle L; a step from the place is L z, z being normal.
  using Root = std::array<double, 6>; ///< xx, yx, yy, zx, zy, zz
  [[nodiscard]] Root root_at(Quaternion place, double times) const;
  static Vec3<Body> step(const Root &root, const Vec3<Body> &z);
  /// ln of the density of a step, without what is the same for all.
  static double log_density(const Root &root, const Vec3<Body> &step);

private:
  Chords around_;
  double least_square_;
};

} // namespace umov::inverse
