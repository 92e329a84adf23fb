#pragma once
// How bright and how polarized an object is along its passes, and when it glints.

#include <memory>
#include <optional>
#include <umov/attitude/attitude.h>
#include <umov/light/glints.h>
#include <umov/orbit/passes.h>
#include <umov/scene/scene.h>

namespace umov {

/// What an object is made of and how it moves; ready for many passes.
class PassLight {
public:
  /// A body with an attitude. `attitude` is complete. For `is_for_many` passes of a body that hides
  /// itself masks are prepared first (seconds), else each sample is traced. With light between
  /// surfaces (`bounces` > 1) all samples are, to 2 % of I.
  static PassLight of_body(const Scene &scene, const AttitudeLaw &attitude, bool is_for_many,
                           std::size_t bounces = 1);
  /// A sphere: the same from everywhere.
  static Result<PassLight> of_sphere(double radius_m, const Material &material,
                                     const std::vector<Band> &bands);

  /// Fills magnitudes, largest p and glints of a pass from its samples (those with sunlight), in
  /// one band. Glints: candidates of flats that give more than half of the light at their time.
  Result<void> describe(const Trajectory &orbit, const Site &site, ShadowModel shadow,
                        std::size_t band, std::span<const ObservingGeometry> samples,
                        SitePass &pass) const;
  [[nodiscard]] const std::vector<Band> &bands() const;

private:
  struct State;
  std::shared_ptr<const State> state_;
};

} // namespace umov
