// umov render: the object as the observer sees it.

#include "job_console.h"
#include "verbs.h"

#include <algorithm>
#include <fmt/format.h>
#include <umov/core/text.h>
#include <umov/core/version.h>
#include <umov/io/exr.h>
#include <umov/io/png.h>
#include <umov/io/report_frames.h>

namespace umov::cli {
namespace {

struct RenderOptions {
  std::string scene, output, shade = "I", band, time;
  std::vector<std::string> overrides;
  std::vector<double> sun, observer, up{0, 0, 1};
  std::size_t object = 1;
  std::uint32_t size = 512, samples = 3;
  std::size_t frames = 1, paths = 16;
  double frames_per_s = 10, half_width_m = 0;
  bool allow_bad_checksum = false, allow_old_elements = false;
};

/// One picture to take: the mesh may have turned parts.
struct Shot {
  KeyFrameView view;
  std::vector<double> joint_angles_rad;
  std::string when; ///< UTC, "" without an orbit
};

Result<Vec3<Body>> direction(const std::vector<double> &xyz, const std::string &option) {
  const Vec3<Body> v{xyz[0], xyz[1], xyz[2]};
  if (!(norm(v) > 0))
    return fail(ErrorCode::Usage, option + " 0 0 0: a direction was expected");
  return normalized(v);
}

/// From directions in the body frame.
Result<std::vector<Shot>> shots_from_directions(const RenderOptions &o) {
  if (o.sun.empty() || o.observer.empty())
    return fail(ErrorCode::Usage,
                "--sun and --observer go together: two directions in the body frame");
  if (o.frames > 1 || !o.time.empty())
    return fail(ErrorCode::Usage, "--time and --frames need a scenario with an orbit; leave --sun "
                                  "and --observer out");
  UMOV_ASSIGN(sun, direction(o.sun, "--sun"));
  UMOV_ASSIGN(observer, direction(o.observer, "--observer"));
  UMOV_ASSIGN(up, direction(o.up, "--up"));
  if (norm(cross(up, observer)) < 1e-6)
    return fail(ErrorCode::Usage, "--up lies along the line of sight; give another direction");
  return std::vector<Shot>{{{{sun, observer}, up}, {}, {}}};
}

/// Epochs of the scenario's orbit, celestial north up.
Result<std::vector<Shot>> shots_from_orbit(const RenderOptions &o, const Scenario &scenario,
                                           const ScenarioObject &named, const LoadedObject &object,
                                           const Common &common) {
  UMOV_TRY(check_complete_for_run(scenario));
  LightCurveRequest request =
      jobs::light_curve_request(scenario, named, object, job_options(common));
  request.earthshine.reset();
  request.has_moonlight = false;
  // Enough to find the brightest moment; the pictures do not use it.
  request.light.accuracy = 0.05;
  request.light.max_points = 1u << 14;
  request.light.bounces = 1;
  if (!o.time.empty()) {
    UMOV_ASSIGN(time, utc_from_iso(o.time));
    request.span.start = request.span.stop = time;
    request.only = {Angle::degrees(-90), {}, false};
  }
  UMOV_ASSIGN(outcome, compute_light_curve(
                           request, object.scene, [](std::size_t, std::size_t) {}, interrupted()));
  if (outcome.stopped)
    return tl::unexpected(*outcome.stopped);
  const LightCurve &curve = outcome.curve;
  std::vector<std::size_t> chosen;
  if (!o.time.empty() && !curve.epochs.empty()) {
    chosen = {0};
  } else { // of the first pass with light
    chosen = choose_key_epochs(curve, o.frames);
    std::erase_if(chosen, [&, first = chosen.empty() ? 0 : chosen.front()](std::size_t i) {
      return curve.epochs[i].pass_id != curve.epochs[first].pass_id;
    });
  }
  if (chosen.empty())
    return fail(ErrorCode::Nothing, "nothing to show: no lit epoch in the span of [time]. Give "
                                    "--time, or --sun and --observer.");
  std::vector<Shot> out;
  for (const std::size_t i : chosen) {
    const LightCurveEpoch &at = curve.epochs[i];
    out.push_back({{at.pose, celestial_north(at)}, at.joint_angles_rad, to_iso(at.geometry.time)});
  }
  return out;
}

const std::map<std::string, KeyFrameShading> shadings{{"I", KeyFrameShading::Intensity},
                                                      {"p", KeyFrameShading::Polarization},
                                                      {"pa", KeyFrameShading::PositionAngle},
                                                      {"material", KeyFrameShading::Material}};

/// 8-bit pictures, one exposure for all.
Result<std::string> png_of(const RenderOptions &o,
                           const std::vector<std::vector<KeyFrameRaster>> &all) {
  std::vector<KeyFrameRaster> flat;
  for (const auto &rasters : all)
    flat.insert(flat.end(), rasters.begin(), rasters.end());
  const double white = common_exposure(flat);
  std::vector<std::vector<std::uint8_t>> frames;
  for (const auto &rasters : all) {
    if (o.shade == "colour") {
      UMOV_ASSIGN(rgb, shade_colour(rasters, white));
      frames.push_back(std::move(rgb));
    } else {
      frames.push_back(shade(rasters.front(), shadings.at(o.shade), white));
    }
  }
  return frames.size() == 1 ? encode_png(o.size, o.size, frames.front())
                            : encode_animation(o.size, o.size, frames, o.frames_per_s);
}

Result<std::string> exr_of(const RenderOptions &o, const std::vector<Band> &bands, const Shot &shot,
                           const std::vector<KeyFrameRaster> &rasters, std::size_t bounces) {
  std::vector<PictureChannel> channels;
  for (std::size_t b = 0; b < rasters.size(); ++b)
    for (PictureChannel &channel : stokes_channels(rasters[b], bands[b].name + "."))
      channels.push_back(std::move(channel));
  const std::vector<std::pair<std::string, std::string>> notes{
      {"umov_version", version},
      {"POLCCONV", "IAU"},
      {"frame", shot.when.empty()
                    ? "+Q along the picture's up, +U 45 deg from it to the left"
                    : "+Q north-south, +U north-east to south-west; north up, east left"},
      {"unit",
       fmt::format("1/sr: radiance per unit solar irradiance, light that touched up to {}; A: "
                   "covered share",
                   counted(bounces, "surface"))},
      {"width_m", shortest(2 * rasters.front().half_width_m)},
      {"time_utc", shot.when}};
  return encode_exr(o.size, o.size, channels, notes);
}

Result<void> render(const RenderOptions &o, const Common &common, Diagnostics &diagnostics) {
  const bool is_exr = o.output.ends_with(".exr");
  if (!is_exr && !o.output.ends_with(".png"))
    return fail(ErrorCode::Usage,
                "-o " + o.output + ": a name that ends in .png or .exr was expected");
  if (is_exr && o.frames > 1)
    return fail(ErrorCode::Usage, "--frames makes an animated .png; an .exr holds one picture");
  UMOV_ASSIGN(scenario, read_scenario(o.scene, o.overrides));
  if (o.object < 1 || o.object > scenario.objects.size())
    return fail(ErrorCode::Usage, fmt::format("--object {}: the scenario has {}", o.object,
                                              counted(scenario.objects.size(), "object")));
  const ScenarioObject &named = scenario.objects[o.object - 1];
  UMOV_ASSIGN(object, load_object(scenario, o.object - 1,
                                  {o.allow_bad_checksum, o.allow_old_elements}, diagnostics));
  UMOV_ASSIGN(band, jobs::band_index(o.band, object.scene.bands));
  std::vector<std::size_t> bands{band};
  if (is_exr) {
    bands.clear();
    for (std::size_t b = 0; b < object.scene.bands.size(); ++b)
      bands.push_back(b);
  } else if (o.shade == "colour") {
    if (object.scene.bands.size() != 3)
      return fail(ErrorCode::Usage,
                  fmt::format("--shade colour takes three bands, blue to red; the scene has {}",
                              object.scene.bands.size()));
    bands = {2, 1, 0};
  }
  const bool has_directions = !o.sun.empty() || !o.observer.empty();
  UMOV_ASSIGN(shots, has_directions ? shots_from_directions(o)
                                    : shots_from_orbit(o, scenario, named, object, common));
  std::vector<std::vector<KeyFrameRaster>> all;
  const std::size_t bounces = scenario.light.bounces;
  const KeyFrameStage stage(object.scene, joints_of(named.parts), bounces);
  const KeyFrameOptions options{
      o.size,  o.samples, band,         o.half_width_m, static_cast<unsigned>(common.threads),
      bounces, o.paths,   scenario.seed};
  ProgressBar bar("pictures", common);
  for (const Shot &shot : shots) {
    if (interrupted())
      return fail(ErrorCode::Interrupted, "stopped by the user; nothing was written");
    UMOV_ASSIGN(rasters, stage.trace(shot.view, shot.joint_angles_rad, options, bands));
    all.push_back(std::move(rasters));
    bar.update(all.size(), shots.size());
  }
  UMOV_ASSIGN(bytes, is_exr ? exr_of(o, object.scene.bands, shots.front(), all.front(), bounces)
                            : png_of(o, all));
  UMOV_TRY(put(o.output, bytes));
  note(common, fmt::format("{}: {}, {:.4g} m wide{}", o.output, counted(all.size(), "picture"),
                           2 * all.front().front().half_width_m,
                           shots.front().when.empty()
                               ? ""
                               : ", " + shots.front().when +
                                     (shots.size() > 1 ? " to " + shots.back().when : "")));
  return {};
}

} // namespace

void add_render(CLI::App &app, const Exit &exit_with) {
  auto *verb = app.add_subcommand("render", "The object as the observer sees it: PNG, animated PNG "
                                            "of a pass, OpenEXR with Stokes channels");
  auto o = std::make_shared<RenderOptions>();
  auto common = std::make_shared<Common>();
  verb->add_option("scene", o->scene, "Scenario file (TOML)")->required();
  verb->add_option("-o,--output", o->output, "File: .png, or .exr with I, Q, U, V of every band")
      ->required();
  verb->add_option("--shade", o->shade,
                   "I, p, pa, material, or colour (three bands as blue, green, red)")
      ->check(CLI::IsMember({"I", "p", "pa", "material", "colour"}))
      ->capture_default_str();
  verb->add_option("--band", o->band,
                   "Of the picture, as the scene spells it; default: the middle one");
  verb->add_option("--time", o->time,
                   "UTC; default: the brightest moment of the first pass in [time]");
  verb->add_option("--frames", o->frames, "Pictures of the first pass, as an animated PNG")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  verb->add_option("--fps", o->frames_per_s, "Frames per second of the animation")
      ->check(CLI::Range(0.1, 60.0))
      ->capture_default_str();
  verb->add_option("--sun", o->sun, "Direction in the body frame, instead of an orbit: X Y Z")
      ->expected(3);
  verb->add_option("--observer", o->observer, "The same for the observer")->expected(3);
  verb->add_option("--up", o->up, "What is up in the picture, with --observer")
      ->expected(3)
      ->capture_default_str();
  verb->add_option("--size", o->size, "Pixels per side")
      ->check(CLI::Range(16, 4096))
      ->capture_default_str();
  verb->add_option("--samples", o->samples, "Rays per pixel and axis")
      ->check(CLI::Range(1, 8))
      ->capture_default_str();
  verb->add_option("--paths", o->paths,
                   "Per ray, of light that touched several surfaces (render.bounces > 1)")
      ->check(CLI::Range(1, 4096))
      ->capture_default_str();
  verb->add_option("--half-width", o->half_width_m,
                   "Half the picture's side [m]; default: the whole object")
      ->check(CLI::PositiveNumber);
  verb->add_option("--object", o->object, "Which [[object]], from 1")->capture_default_str();
  verb->add_option("--set", o->overrides, "KEY=VALUE over a key of the scenario");
  verb->add_flag("--allow-bad-checksum", o->allow_bad_checksum,
                 "Read elements with a bad checksum");
  verb->add_flag("--allow-old-elements", o->allow_old_elements, "Take elements over 30 days old");
  add_threads(*verb, *common);
  add_common(*verb, *common, false);
  verb->callback([o, common, exit_with] {
    watch_interrupts();
    Diagnostics diagnostics;
    const auto done = render(*o, *common, diagnostics);
    report(diagnostics, *common);
    exit_with(done ? 0 : report(done.error()));
  });
}

} // namespace umov::cli
