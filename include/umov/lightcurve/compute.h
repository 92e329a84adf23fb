#pragma once
// From an orbit, an attitude law and a compiled scene to a light curve over time.

#include <atomic>
#include <functional>
#include <optional>
#include <umov/attitude/attitude.h>
#include <umov/core/diagnostics.h>
#include <umov/lightcurve/earth_light.h>
#include <umov/lightcurve/light_curve.h>
#include <umov/observation/moving_joints.h>
#include <umov/orbit/trajectory.h>

namespace umov {

/// Which epochs are kept.
struct EpochFilter {
  Angle altitude_min = Angle::degrees(0); ///< altitude of the object at least this
  std::optional<Angle> sun_altitude_max;  ///< Sun at the site at most this high
  bool sunlit = true;                     ///< only where some of the solar disk is visible
};

/// Axes that q, u and pa refer to.
enum class PolarizationFrame { Equatorial, AltAz, Scattering };

struct LightCurveRequest {
  std::string object;
  Trajectory orbit;
  Site site;
  Epoch<Utc> start{}, stop{};
  double step_s = 1; ///< > 0; `stop` is included and may equal `start`
  EpochFilter only;
  AttitudeLaw attitude;            ///< complete: no table or inertia to be read
  std::vector<MovingJoint> joints; ///< checked against the scene's mesh
  PolarizationFrame frame = PolarizationFrame::Equatorial;
  ShadowModel shadow = ShadowModel::Ellipsoid;
  std::optional<EarthshineOptions> earthshine; ///< absent: none
  bool has_moonlight = false;
  /// Sunlight at the Earth's edge bent and reddened by its air: I takes `refracted_sunlight` of its
  /// band where `sunlit` of the geometry has none of it.
  bool has_refracted_shadow = false;
  bool has_solar_disk = true; ///< the Sun as a uniform disk at its distance, or a point
  IntegrationOptions integration;
  unsigned threads = 0;
};

/// One passage above `altitude_min`.
struct Pass {
  std::string id;                          ///< NORAD number dash culmination time
  Epoch<Utc> rise{}, culmination{}, set{}; ///< to the step, except the culmination (refined)
  Angle culmination_altitude;
  bool is_open_at_start = false, is_open_at_end = false; ///< goes on beyond the span
  std::size_t rows = 0;                                  ///< epochs kept by the filter
};

struct LightCurveOutcome {
  LightCurve curve;
  std::vector<Pass> passes;     ///< those with at least one kept epoch
  std::size_t passes_seen = 0;  ///< above the altitude limit, kept or not
  std::optional<Error> stopped; ///< Physics or Interrupted: rows before it are complete
};

/// Called from worker threads with the number of finished and of all epochs.
using Progress = std::function<void(std::size_t done, std::size_t total)>;

/// Epochs start, start + step, ... up to `stop`; BadInput if step <= 0, stop < start or more than
/// 10 million epochs.
Result<std::vector<Epoch<Utc>>> time_grid(Epoch<Utc> start, Epoch<Utc> stop, double step_s);

/// Computes the light curve. Results are the same bits for any number of threads. When SGP4 fails
/// (decayed orbit) or `cancel` becomes true the finished rows are kept and `stopped` says why.
Result<LightCurveOutcome> compute_light_curve(const LightCurveRequest &request, const Scene &scene,
                                              const Integrator &integrator,
                                              const Progress &progress,
                                              const std::atomic<bool> &cancel);

/// First pass after `from` that the filter would keep, looked for over `days` in steps of 20 s; for
/// the message when a span has none. Empty if there is none or the orbit cannot be propagated.
struct NextPass {
  Epoch<Utc> first_row{};
  Angle altitude_max;
};
std::optional<NextPass> find_next_pass(const LightCurveRequest &request, Epoch<Utc> from,
                                       double days);

} // namespace umov
