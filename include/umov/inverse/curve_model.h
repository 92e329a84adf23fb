#pragma once
// Light that an object gives at the epochs of a curve, for many attitudes or spins at once.

#include <functional>
#include <span>
#include <umov/core/rotation.h>
#include <umov/inverse/likelihood.h>
#include <umov/inverse/observed_curve.h>
#include <umov/light/stokes_table.h>
#include <umov/scene/pose.h>
#include <vector>

namespace umov {

/// Light of poses in the bands of a curve; false if it is to stop. Of a model with parts the bands
/// stand several times: all of the light, then of each part its own and, where its slopes are not
/// known, that of smaller and of larger ones.
using PoseLighting = std::function<bool(std::span<const Pose>, StokesTable &)>;

/// How a body is turned: an attitude at second 0 of the curve, and a constant turn from there on.
struct Turning {
  Quaternion attitude;   ///< body_from_gcrs at second 0
  Vec3<Body> rate_rad_s; ///< body axes; 0: fixed among the stars
};
/// Attitude at a time.
Quaternion attitude_at(const Turning &turning, double seconds);
/// Sun and observer in the body at an epoch.
Pose pose_at(const Turning &turning, const ObservedEpoch &epoch);

/// Light of many turnings, kept for the epochs that were asked for.
class CurveModel {
public:
  /// `light` and `curve` must outlive it. `bands`: of the light, of which column `column[b]` is
  /// band b of the curve.
  CurveModel(const ObservedCurve &curve, PoseLighting light, std::vector<std::size_t> column,
             std::vector<PartKind> parts = {});

  /// Calls `take(k, light)` for turning k, from any thread: light at `epochs` (all, if none are
  /// named), the rest is 0. False if it was stopped.
  [[nodiscard]] bool
  for_each(std::span<const Turning> turnings, std::span<const std::size_t> epochs, unsigned threads,
           const std::function<void(std::size_t, const ModelLight &)> &take) const;
  /// Poses that were lit so far.
  [[nodiscard]] std::size_t poses_lit() const { return poses_lit_; }
  /// The curve.
  [[nodiscard]] const ObservedCurve &curve() const { return curve_; }
  /// Parts of the light that are not quite known.
  [[nodiscard]] const std::vector<PartKind> &parts() const { return parts_; }

private:
  const ObservedCurve &curve_;
  PoseLighting light_;
  std::vector<std::size_t> column_, all_;
  std::vector<PartKind> parts_;
  mutable std::size_t poses_lit_ = 0;
};

} // namespace umov
