#pragma once
// How bright and how polarized an object is along its passes, and when it glints.

#include <limits>
#include <memory>
#include <optional>
#include <umov/attitude/attitude.h>
#include <umov/light/glints.h>
#include <umov/light/light_model.h>
#include <umov/lightcurve/extinction.h>
#include <umov/observation/track.h>
#include <umov/orbit/ephemeris.h>
#include <umov/scene/scene.h>
#include <vector>

namespace umov {

/// A body, how it is turned and how its parts move.
struct PassBody {
  Scene scene;
  AttitudeLaw attitude;            ///< complete
  std::vector<MovingJoint> joints; ///< checked against the mesh
  bool has_solar_disk = true;      ///< the Sun as a uniform disk at its distance, or a point
  MagnitudeSystem magnitudes = MagnitudeSystem::AB;
  std::optional<SiteAir> air = {}; ///< absent: magnitudes above the air alone
};

/// Light for ranges over a pass: magnitudes to a few hundredths, so accuracy .02.
LightOptions pass_light_options(LightMethod method = LightMethod::Auto);

/// A flat that mirrors the Sun to the site.
struct PassGlint {
  Epoch<Utc> time;    ///< normal and half vector nearest
  double width_s = 0; ///< for which the half vector is within the lobe
};

/// The light of a pass while it is sunlit; NaN and none where nothing is known of it.
struct PassBrightness {
  static constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  double magnitude_min = unknown;     ///< the brightest
  double magnitude_max = unknown;     ///< the faintest, or a limit
  double magnitude_obs_min = unknown; ///< the brightest behind the air, where there is one
  double magnitude_obs_max = unknown; ///< the faintest behind the air, or a limit
  double p_max = unknown;             ///< largest degree of polarization
  bool has_limit = false; ///< at times it is fainter than can be told: `magnitude_max` is a limit
  std::optional<Epoch<Utc>> brightest = {}; ///< when the magnitude is the least, above the air
  std::vector<PassGlint> glints;            ///< in order
};

/// An epoch of a pass and the light that the object gives then.
struct PassSample {
  ObservingGeometry geometry;
  BandResult light;
  bool is_dark = false; ///< nothing is both lit and seen
};

/// What an object is made of and how it moves; ready for many passes.
class PassLight {
public:
  /// A body with an attitude.
  static Result<PassLight> of_body(PassBody body, const LightOptions &options,
                                   const std::atomic<bool> *cancel = nullptr);
  /// A sphere: the same from everywhere.
  static Result<PassLight> of_sphere(double radius_m, const Material &material,
                                     const std::vector<Band> &bands);

  /// Magnitudes, largest p and glints of a pass from its samples (those with sunlight), in one
  /// band; of a body also from times between the brightest of them and their neighbours, down to a
  /// fortieth of the step: what flashes and fades between two samples without a glint is not seen.
  /// Samples whose I is not three times its half-width count as limits (shown_magnitude), for the
  /// faintest alone; those whose p is not known to 0.1 not for p. Glints: candidates of flats, of
  /// parts that turn too, that give more than half of the light at their time. Interrupted if
  /// `cancel` became true.
  Result<PassBrightness> describe(const Trajectory &orbit, const Site &site, ShadowModel shadow,
                                  std::size_t band, std::span<const ObservingGeometry> samples,
                                  const std::atomic<bool> *cancel = nullptr) const;
  /// LightModel::keep_masks.
  [[nodiscard]] Result<void> keep_masks() const;

private:
  struct State;
  static Result<std::vector<PassGlint>> glints_of(const State &state, const Track &track,
                                                  const std::atomic<bool> *cancel,
                                                  std::vector<ObservingGeometry> &lit);
  static Result<std::vector<PassSample>> light_of(const State &state, const Track &track,
                                                  std::size_t band,
                                                  std::span<const ObservingGeometry> at,
                                                  const std::atomic<bool> *cancel);
  std::shared_ptr<const State> state_;
};

} // namespace umov
