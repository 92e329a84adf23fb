// Passes described: where the object is along them, how it is lit.

#include "orbit/pass_search.h"

#include <algorithm>
#include <cmath>
#include <umov/core/quantity.h>

namespace umov {
namespace {

using passes::Stretch;

/// The object over the site, at seconds after the start.
class View {
public:
  View(const Trajectory &orbit, const Site &site, Epoch<Utc> start, ShadowModel shadow)
      : orbit_(orbit), site_(site), start_(start), shadow_(shadow) {}

  /// Zeros where the orbit cannot be had.
  ObservingGeometry operator()(double seconds) const {
    const Epoch<Utc> time = plus_seconds(start_, seconds);
    const auto state = orbit_.at(time);
    return state ? observe(*state, time, site_, shadow_) : ObservingGeometry{};
  }

private:
  const Trajectory &orbit_;
  const Site &site_;
  Epoch<Utc> start_;
  ShadowModel shadow_;
};

bool is_dark(const ObservingGeometry &at, const PassSearch &search) {
  return at.sun_altitude.radians() < search.sun_altitude_max.radians();
}

/// Takes a sunlit point into the highest that is visible: samples, where the shadow begins or ends
/// between two of them, the highest point within the span.
void raise_visible(SitePass &pass, const ObservingGeometry &at, const PassSearch &search) {
  if (is_dark(at, search) && at.altitude.radians() > pass.visible_altitude_max.radians())
    pass.visible_altitude_max = at.altitude;
}

/// The highest point beyond an end of the span that cuts the pass, where the orbit can be had
/// there.
void raise_culmination(const View &view, double whole_s, SitePass &pass) {
  const ObservingGeometry whole = view(whole_s);
  if (whole.range_km > 0 && whole.altitude.radians() > pass.culmination.altitude.radians())
    pass.culmination = whole;
}

/// Everything along a pass that needs samples: shadow, phase, range. Its culmination is that within
/// the span. Returns the samples if they are wanted.
std::vector<ObservingGeometry> describe(const View &view, const Stretch &stretch,
                                        const PassSearch &search, SitePass &out) {
  std::vector<ObservingGeometry> samples;
  constexpr double step_max = 5;
  const double length = stretch.set_s - stretch.rise_s;
  const auto steps =
      static_cast<std::size_t>(std::clamp(std::ceil(length / step_max), 1.0, 2000.0));
  const auto light = [&](double t) { return view(t).sunlit - 0.5; };
  double before = 0, previous_time = stretch.rise_s;
  std::size_t lit = 0, visible = 0;
  out.range_min_km = out.culmination.range_km;
  for (std::size_t k = 0; k <= steps; ++k) {
    const double t = stretch.rise_s + length * static_cast<double>(k) / static_cast<double>(steps);
    const ObservingGeometry at = view(t);
    if (!(at.range_km > 0)) // a gap that the search did not meet
      continue;
    if (search.on_pass)
      samples.push_back(at);
    const double now = at.sunlit - 0.5;
    if (k > 0 && (now > 0) != (before > 0)) {
      const ObservingGeometry edge = view(passes::crossing(light, previous_time, t));
      out.shadow.push_back({edge.time, before > 0});
      raise_visible(out, edge, search);
    }
    before = now;
    previous_time = t;
    out.range_min_km = std::min(out.range_min_km, at.range_km);
    if (!(at.sunlit > 0))
      continue;
    out.phase_min =
        lit == 0 ? at.phase_angle
                 : Angle::radians(std::min(out.phase_min.radians(), at.phase_angle.radians()));
    out.phase_max =
        lit == 0 ? at.phase_angle
                 : Angle::radians(std::max(out.phase_max.radians(), at.phase_angle.radians()));
    ++lit;
    visible += is_dark(at, search) ? 1u : 0u;
    raise_visible(out, at, search);
  }
  if (out.culmination.sunlit > 0)
    raise_visible(out, out.culmination, search);
  const double share = 1 / static_cast<double>(steps + 1);
  out.sunlit_share = static_cast<double>(lit) * share;
  out.visible_s = static_cast<double>(visible) * share * length;
  return samples;
}

} // namespace

Result<SitePasses> find_passes(const Trajectory &orbit, const Site &site, Epoch<Utc> start,
                               Epoch<Utc> stop, const PassSearch &search) {
  passes::Found found =
      passes::search(orbit, site, start, stop, search.altitude_min, search.cancel);
  const auto is_cancelled = [&search] { return search.cancel != nullptr && *search.cancel; };
  const View view(orbit, site, start, search.shadow);
  SitePasses out{{}, std::move(found.gaps), std::move(found.end)};
  for (const Stretch &stretch : found.stretches) {
    if (is_cancelled())
      break;
    SitePass pass;
    pass.rise = view(stretch.rise_s);
    pass.culmination = view(stretch.top_s);
    pass.set = view(stretch.set_s);
    pass.whole_culmination = culmination_near(orbit, site, pass.culmination.time);
    pass.is_rise_cut = stretch.is_rise_cut;
    pass.is_set_cut = stretch.is_set_cut;
    const auto along = describe(view, stretch, search, pass);
    if (pass.is_rise_cut || pass.is_set_cut)
      raise_culmination(view, seconds_between(pass.whole_culmination, start), pass);
    if (search.on_pass)
      UMOV_TRY(search.on_pass(pass, along));
    out.passes.push_back(std::move(pass));
  }
  if (is_cancelled())
    return fail(ErrorCode::Interrupted, "stopped by the user in a search for passes");
  return out;
}

} // namespace umov
