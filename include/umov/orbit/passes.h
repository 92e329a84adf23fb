#pragma once
// When an object passes over a site.

#include <atomic>
#include <functional>
#include <optional>
#include <span>
#include <umov/core/diagnostics.h>
#include <umov/orbit/ephemeris.h>
#include <umov/orbit/trajectory.h>
#include <vector>

namespace umov {

/// When an object stands above an altitude, within a span of time.
struct PassSpan {
  Epoch<Utc> rise{}, set{}; ///< where it crosses the altitude, to 1 ms
  Epoch<Utc> culmination{}; ///< highest point within the span, to 0.05 s
  bool is_rise_cut = false, ///< above already when the span begins
      is_set_cut = false;   ///< above still when it ends
};

/// Where an orbit can no longer be had.
struct OrbitEnd {
  Epoch<Utc> last{}; ///< the last time at which it can, to 1 ms
  Error error;       ///< what is wrong after it
};

/// A stretch that an ephemeris does not cover, between two that it does.
struct OrbitGap {
  Epoch<Utc> last{}, next{}; ///< the nearest times that it covers, to 1 ms
};

/// The passes between two times, in order. An end of the orbit or of an ephemeris cuts a pass as
/// the ends of the search do.
struct PassSpans {
  std::vector<PassSpan> spans;
  std::vector<OrbitGap> gaps;  ///< those longer than Trajectory::search_step_s, and some shorter
  std::optional<OrbitEnd> end; ///< nothing follows it
};

/// Every stretch of time in which an object stands above `altitude_min` at a site: the altitude on
/// a grid as coarse as the orbit allows (Trajectory::search_step_s), its tops and crossings
/// refined. This is the one search for passes; all other functions on passes build on it. Some may
/// be missing once `cancel` became true.
PassSpans find_pass_spans(const Trajectory &orbit, const Site &site, Epoch<Utc> start,
                          Epoch<Utc> stop, Angle altitude_min,
                          const std::atomic<bool> *cancel = nullptr);

/// Time of culmination to 1 ms of the pass that is above the horizon at `near`, beyond the ends of
/// any span: the altitude is followed uphill from `near`. `near` itself where the altitude goes on
/// growing for an hour, as that of a geostationary object does.
Epoch<Utc> culmination_near(const Trajectory &orbit, const Site &site, Epoch<Utc> near);

/// The middle of the penumbra: half of the Sun's disk is behind the Earth.
struct ShadowCrossing {
  Epoch<Utc> time;
  bool is_entry = true; ///< into the shadow
};

/// A pass as seen from a site, described.
struct SitePass {
  ObservingGeometry rise, set; ///< where it crosses the altitude, or is at the span's end
  /// Highest point of the whole pass, beyond the span's ends too; within them where the orbit ends
  /// or the altitude goes on growing for an hour.
  ObservingGeometry culmination;
  Epoch<Utc> whole_culmination{}; ///< its time to 1 ms: what the pass is named by
  bool is_rise_cut = false,
       is_set_cut = false;            ///< it is above already, or still, at the span's end
  std::vector<ShadowCrossing> shadow; ///< between rise and set, in order
  double range_min_km = 0;
  double sunlit_share = 0;    ///< of the time between rise and set
  double visible_s = 0;       ///< sunlit, with the site's Sun below PassSearch::sun_altitude_max
  Angle visible_altitude_max; ///< highest while visible; 0 if never
  Angle phase_min, phase_max; ///< while sunlit; 0 if never
};

/// What counts as a pass.
struct PassSearch {
  Angle altitude_min = Angle::degrees(10);
  Angle sun_altitude_max = Angle::degrees(-6); ///< of `visible_s`
  ShadowModel shadow = ShadowModel::Ellipsoid;
  /// Called with every pass and its samples, some seconds apart from rise to set.
  std::function<Result<void>(const SitePass &, std::span<const ObservingGeometry>)> on_pass;
  const std::atomic<bool> *cancel = nullptr; ///< ends the search where it comes true
};

/// Passes described, in order, and how far the orbit goes.
struct SitePasses {
  std::vector<SitePass> passes;
  std::vector<OrbitGap> gaps;
  std::optional<OrbitEnd> end;
};

/// All passes of an object between two times, described; times, gaps and end as find_pass_spans has
/// them. The error of PassSearch::on_pass; ErrorCode::Interrupted where PassSearch::cancel comes
/// true.
Result<SitePasses> find_passes(const Trajectory &orbit, const Site &site, Epoch<Utc> start,
                               Epoch<Utc> stop, const PassSearch &search);

} // namespace umov
