#pragma once
// How bright and how polarized an object is along its passes, and when it glints.

#include <memory>
#include <optional>
#include <umov/attitude/attitude.h>
#include <umov/light/glints.h>
#include <umov/light/light_model.h>
#include <umov/observation/track.h>
#include <umov/orbit/passes.h>
#include <umov/scene/scene.h>

namespace umov {

/// What an object is made of and how it moves; ready for many passes.
class PassLight {
public:
  /// A body with an attitude, lit by `method` (rays: to 2 % of I). `attitude` is complete.
  static Result<PassLight> of_body(const Scene &scene, const AttitudeLaw &attitude,
                                   LightMethod method, std::size_t bounces = 1);
  /// A sphere: the same from everywhere.
  static Result<PassLight> of_sphere(double radius_m, const Material &material,
                                     const std::vector<Band> &bands);

  /// Fills magnitudes, largest p and glints of a pass from its samples (those with sunlight), in
  /// one band. Glints: candidates of flats that give more than half of the light at their time.
  Result<void> describe(const Trajectory &orbit, const Site &site, ShadowModel shadow,
                        std::size_t band, std::span<const ObservingGeometry> samples,
                        SitePass &pass) const;
  /// Bands that `describe` can be asked for.
  [[nodiscard]] const std::vector<Band> &bands() const;

private:
  struct State;
  static Result<void> add_glints(const State &state, const Track &track,
                                 std::vector<ObservingGeometry> &lit, SitePass &pass);
  std::shared_ptr<const State> state_;
};

} // namespace umov
