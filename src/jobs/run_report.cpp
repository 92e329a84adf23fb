#include "jobs/run_report.h"

#include "jobs/haze_spread.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <nlohmann/json.hpp>
#include <umov/attitude/tumble.h>
#include <umov/core/text.h>
#include <umov/core/version.h>
#include <umov/io/report.h>
#include <umov/io/report_frames.h>
#include <umov/jobs/run.h>

namespace umov::jobs {
namespace {

/// The whole passage above the altitude limit, in the Earth's shadow too.
std::vector<SkyTrackPoint> sky_track(const LightCurveRequest &request,
                                     const std::vector<Pass> &passes) {
  std::vector<SkyTrackPoint> out;
  constexpr double points_per_pass = 200;
  for (const Pass &pass : passes) {
    const double length = seconds_between(pass.set, pass.rise);
    for (double k = 0; k <= points_per_pass; ++k) {
      const Epoch<Utc> time = plus_seconds(pass.rise, length * k / points_per_pass);
      const auto state = request.track.orbit.at(time);
      if (!state)
        continue;
      const ObservingGeometry g = observe(*state, time, request.track.site, request.track.shadow);
      out.push_back({time, pass.id, g.azimuth, g.altitude, g.sunlit});
    }
  }
  return out;
}

/// Only what does not depend on the machine: the page has the same bytes wherever it is made.
std::vector<std::pair<std::string, std::string>> manifest_lines(const Scenario &scenario,
                                                                const LoadedObject &object) {
  std::vector<std::pair<std::string, std::string>> out{
      {"umov", fmt::format("{} ({})", version, source_revision)},
      {"seed", fmt::format("{}", scenario.seed)},
      {"accuracy", fmt::format("{}", scenario.light.accuracy)}};
  for (const InputFile &input : object.inputs)
    out.emplace_back(std::filesystem::path(input.path).filename().string(), input.sha256);
  return out;
}

struct PassNumbers {
  double brightest = std::numeric_limits<double>::infinity(), faintest = -brightest;
  std::size_t brightest_at = 0; ///< epoch
  double p_max = 0, phase_min = 180, phase_max = 0;
  bool has_limit = false; ///< samples fainter than can be told
};

/// A band as people write it: 550 nm.
std::string spelt(const std::string &band) {
  return band.starts_with("nm:") ? band.substr(3) + " nm" : band;
}

/// Of one band, the middle one: a range over several would mix the object's colour into it.
PassNumbers numbers_of(const LightCurve &curve, const std::string &id) {
  PassNumbers out;
  const std::size_t bands = curve.bands.size(), band = bands / 2;
  for (std::size_t i = 0; i < curve.epochs.size(); ++i) {
    if (curve.epochs[i].pass_id != id)
      continue;
    const double phase = curve.epochs[i].geometry.phase_angle.degrees();
    out.phase_min = std::min(out.phase_min, phase);
    out.phase_max = std::max(out.phase_max, phase);
    const LightCurveSample &s = curve.samples[i * bands + band];
    if (std::isnan(s.magnitude))
      continue;
    out.faintest = std::max(out.faintest, s.magnitude);
    if (has_magnitude_limit(s)) {
      out.has_limit = true;
      continue;
    }
    if (s.magnitude < out.brightest) {
      out.brightest = s.magnitude;
      out.brightest_at = i;
    }
    if (!std::isnan(s.p) && is_p_known(s.intensity, s.half_width))
      out.p_max = std::max(out.p_max, s.p);
  }
  return out;
}

} // namespace

namespace {

std::string title_of(const Scenario &scenario, const LightCurveRequest &request) {
  if (scenario.title.empty())
    return request.object;
  return scenario.objects.size() == 1 ? scenario.title : scenario.title + ": " + request.object;
}

} // namespace

std::vector<TurningPeriod> turning_periods(const AttitudeLaw &law) {
  std::vector<TurningPeriod> out;
  if (const auto *spin = std::get_if<SpinLaw>(&law); spin && spin->rate_rad_s != 0)
    out.push_back({"spin", 2 * pi / std::abs(spin->rate_rad_s)});
  if (const auto *tumble = std::get_if<TumbleLaw>(&law))
    if (const auto motion = TorqueFreeMotion::make(tumble->inertia, tumble->rate_rad_s)) {
      if (motion->precession_rate_rad_s() != 0)
        out.push_back({"precession", 2 * pi / std::abs(motion->precession_rate_rad_s())});
      if (std::isfinite(motion->body_period_s()))
        out.push_back({"rotation in the body", motion->body_period_s()});
    }
  if (const auto *pieces = std::get_if<PiecewiseLaw>(&law))
    for (const AttitudePiece &piece : pieces->pieces)
      for (TurningPeriod &one : turning_periods(*piece.law))
        out.push_back(std::move(one));
  if (const auto *unsteady = std::get_if<LibrationLaw>(&law))
    return turning_periods(*unsteady->law);
  return out;
}

Result<std::string> make_run_report(const Scenario &scenario, const LoadedObject &object,
                                    const LightCurveRequest &request,
                                    const LightCurveOutcome &outcome,
                                    const Diagnostics &diagnostics) {
  ReportInput input{.curve = outcome.curve,
                    .title = title_of(scenario, request),
                    .site = request.track.site,
                    .frame = request.frame,
                    .passes = outcome.passes};
  input.sky_track = sky_track(request, outcome.passes);
  input.pure_materials = pure_material_curves(object.scene.front, object.scene.grid);
  // Few pictures of many passes: the page stays a page.
  const std::size_t per_pass = outcome.passes.size() > 4 ? 1 : 4;
  std::vector<std::size_t> epochs = choose_key_epochs(outcome.curve, per_pass);
  if (epochs.size() > 12)
    epochs.resize(12);
  UMOV_ASSIGN(frames, make_key_frames(object.scene, outcome.curve, epochs,
                                      {.band = object.scene.bands.size() / 2,
                                       .threads = request.threads,
                                       .bounces = request.light.bounces,
                                       .paths = 4,
                                       .seed = request.light.seed},
                                      joints_of(request.track.joints)));
  input.key_frames = std::move(frames);
  UMOV_ASSIGN(
      film,
      make_film(object.scene, outcome.curve, 36,
                {.size = 200, .band = object.scene.bands.size() / 2, .threads = request.threads},
                joints_of(request.track.joints)));
  input.film = std::move(film);
  input.key_frame_materials = material_names(object.scene);
  input.turning = turning_periods(request.track.attitude);
  input.manifest = manifest_lines(scenario, object);
  if (outcome.stopped)
    input.warnings.push_back("PARTIAL RESULT: " + outcome.stopped->message);
  for (const Warning &warning : diagnostics.warnings())
    input.warnings.push_back(warning.text());
  return make_report(input);
}

std::string summarize(const LightCurveOutcome &outcome) {
  const LightCurve &curve = outcome.curve;
  std::string out = fmt::format(
      "{} ({}): {} x {} in {}{}\n", curve.object.empty() ? "object" : curve.object,
      curve.norad_cat_id, counted(curve.epochs.size(), "epoch"),
      counted(curve.bands.size(), "band"), counted(outcome.passes.size(), "pass", "passes"),
      outcome.stopped ? ", PARTIAL: the run stopped early" : "");
  for (const Pass &pass : outcome.passes) {
    const PassNumbers n = numbers_of(curve, pass.id);
    const bool is_outside = seconds_between(pass.culmination, pass.rise) < 0 ||
                            seconds_between(pass.set, pass.culmination) < 0;
    out += fmt::format("  {}  max alt {:.0f} deg{}  phase {:.0f}-{:.0f} deg", pass.id,
                       pass.culmination_altitude.degrees(),
                       is_outside ? " (not among the epochs)" : "", n.phase_min, n.phase_max);
    if (std::isfinite(n.brightest)) {
      const ObservingGeometry &best = curve.epochs[n.brightest_at].geometry;
      out += fmt::format(
          "  {}: mag {:.1f} to {}{:.1f} {}, brightest {} at phase {:.0f}  p up to {:.0f} %",
          spelt(curve.bands[curve.bands.size() / 2].name), n.brightest, n.has_limit ? "> " : "",
          n.faintest, name_of(curve.magnitudes), to_iso(best.time).substr(11, 8),
          best.phase_angle.degrees(), 100 * n.p_max);
    } else if (n.has_limit)
      out += "  too faint for a magnitude throughout: see mag_limit";
    out += "\n";
  }
  out += describe_spread(curve);
  const auto dark = std::count_if(curve.epochs.begin(), curve.epochs.end(),
                                  [](const LightCurveEpoch &e) { return e.is_dark; });
  if (dark > 0)
    out += fmt::format("  {} with nothing both lit and seen: intensity 0, q and u empty\n",
                       counted(static_cast<std::size_t>(dark), "epoch"));
  return out;
}

std::string summary_json(const LightCurveOutcome &outcome) {
  using Json = nlohmann::ordered_json;
  const LightCurve &curve = outcome.curve;
  Json bands = Json::array(), passes = Json::array();
  for (const Band &band : curve.bands)
    bands.push_back(band.name);
  for (const Pass &pass : outcome.passes) {
    const PassNumbers n = numbers_of(curve, pass.id);
    const bool is_known = std::isfinite(n.brightest);
    passes.push_back({{"pass_id", pass.id},
                      {"alt_max", pass.culmination_altitude.degrees()},
                      {"phase_min", n.phase_min},
                      {"phase_max", n.phase_max},
                      {"mag_min", is_known ? Json(n.brightest) : Json(nullptr)},
                      {"mag_max", is_known ? Json(n.faintest) : Json(nullptr)},
                      {"has_limit", n.has_limit},
                      {"p_max", n.p_max}});
  }
  const auto dark = std::count_if(curve.epochs.begin(), curve.epochs.end(),
                                  [](const LightCurveEpoch &e) { return e.is_dark; });
  Json out{
      {"name", curve.object},          {"norad_cat_id", curve.norad_cat_id},
      {"epochs", curve.epochs.size()}, {"dark", dark},
      {"bands", std::move(bands)},     {"band_of_passes", curve.bands[curve.bands.size() / 2].name},
      {"passes", std::move(passes)}};
  if (const MagnitudeSpread spread = magnitude_spread(curve); spread.samples > 0)
    out["haze"] = {{"mag_median", spread.median}, {"mag_most", spread.most}};
  return out.dump(-1, ' ', false, Json::error_handler_t::replace);
}

} // namespace umov::jobs
