#include <umov/jobs/render.h>

#include "jobs/part_angles.h"

#include <algorithm>
#include <fmt/format.h>
#include <umov/core/stop.h>
#include <umov/core/text.h>
#include <umov/core/version.h>
#include <umov/io/exr.h>
#include <umov/io/png.h>
#include <umov/io/report_frames.h>
#include <umov/light/point_budget.h>

namespace umov::jobs {
namespace {

using Shade = RenderRequest::Shade;

/// One picture to take: the mesh may have turned parts.
struct Shot {
  KeyFrameView view;
  std::vector<double> joint_angles_rad;
  std::string when; ///< UTC, "" without an orbit
};

/// What is rendered, read and checked.
struct Subject {
  LoadedObject object;
  std::vector<std::size_t> bands; ///< in the order of the channels
  std::vector<Shot> shots;
  std::size_t first = 0; ///< number of the first shot among the frames asked for
};

/// Which epochs of a light curve are shown: of the first pass with light, or the one time.
std::vector<std::size_t> epochs_to_show(const RenderRequest &request, const LightCurve &curve) {
  if (request.time && !curve.epochs.empty())
    return {0};
  std::vector<std::size_t> out = choose_key_epochs(curve, request.frames);
  std::erase_if(out, [&, first = out.empty() ? 0 : out.front()](std::size_t i) {
    return curve.epochs[i].pass_id != curve.epochs[first].pass_id;
  });
  return out;
}

/// A picture at a time that the user chose is drawn in full sunlight whatever stands between: what
/// nobody would see is told.
void tell_of_unseen(const ObservingGeometry &at, Diagnostics &diagnostics) {
  const bool is_below = at.altitude.radians() < 0;
  if (at.sunlit >= 1 && !is_below)
    return;
  std::string why = at.sunlit >= 1  ? ""
                    : at.sunlit > 0 ? "partly in the Earth's or the Moon's shadow"
                                    : "in the Earth's shadow";
  if (is_below)
    why += why.empty() ? "below the horizon" : " and below the horizon";
  diagnostics.warn(fmt::format("at {} the object is {} (sunlit share {:.3g}, altitude {:.1f} deg): "
                               "it is drawn as if in full sunlight and in sight",
                               to_iso(at.time), why, at.sunlit, at.altitude.degrees()));
}

/// Epochs of the scenario's orbit, celestial north up.
Result<std::vector<Shot>> shots_from_orbit(const RenderRequest &request, const Scenario &scenario,
                                           const LoadedObject &object, const JobOptions &options,
                                           const Monitor &monitor, Diagnostics &diagnostics) {
  UMOV_TRY(check_complete_for_run(scenario));
  UMOV_TRY(check_magnitudes(scenario));
  LightCurveRequest wanted =
      light_curve_request(scenario, scenario.objects[request.object], object, options);
  wanted.earthshine.reset();
  wanted.has_moonlight = false;
  // Enough to find the brightest moment; the pictures do not use it.
  wanted.light.accuracy = 0.05;
  wanted.light.max_points = most_points::to_find_the_brightest;
  wanted.light.bounces = 1;
  if (request.time) {
    wanted.span.start = wanted.span.stop = *request.time;
    wanted.only = {Angle::degrees(-90), {}, false};
  }
  UMOV_ASSIGN(outcome,
              compute_light_curve(
                  wanted, object.scene, [](std::size_t, std::size_t) {}, monitor.cancel_flag()));
  if (outcome.stopped)
    return tl::unexpected(*outcome.stopped);
  std::vector<Shot> out;
  for (const std::size_t i : epochs_to_show(request, outcome.curve)) {
    const LightCurveEpoch &at = outcome.curve.epochs[i];
    if (request.time)
      tell_of_unseen(at.geometry, diagnostics);
    out.push_back({{at.pose, celestial_north(at)}, at.joint_angles_rad, to_iso(at.geometry.time)});
  }
  if (out.empty())
    return fail(ErrorCode::Nothing, "nothing to show: no lit epoch in the span of [time]. Give "
                                    "--time, or --sun and --observer.");
  return out;
}

/// Which bands are traced, in the order in which the file takes them.
Result<std::vector<std::size_t>> bands_of(const RenderRequest &request, std::size_t band,
                                          std::size_t count) {
  if (request.is_exr) {
    std::vector<std::size_t> all(count);
    for (std::size_t b = 0; b < count; ++b)
      all[b] = b;
    return all;
  }
  if (request.shade != Shade::Colour)
    return std::vector<std::size_t>{band};
  if (count != 3)
    return fail(
        ErrorCode::Usage,
        fmt::format("--shade colour takes three bands, blue to red; the scene has {}", count));
  return std::vector<std::size_t>{2, 1, 0};
}

Result<void> check(const RenderRequest &request, const Scenario &scenario) {
  if (request.is_exr && request.frames > 1 && !request.has_file_each)
    return fail(ErrorCode::Usage,
                "--frames makes an animated .png; an .exr holds one picture. Write # where the "
                "number of each frame shall stand: -o pass_###.exr");
  if (!request.part.is_whole() && !(request.is_exr && request.has_file_each))
    return fail(
        ErrorCode::Usage,
        "--shard and --range take frames in files of their own, -o pass_###.exr; pictures of .png "
        "share the exposure of the whole pass");
  if (request.object >= scenario.objects.size())
    return fail(ErrorCode::Usage,
                fmt::format("--object {}: the scenario has {}", request.object + 1,
                            counted(scenario.objects.size(), "object")));
  if (request.view && (request.frames > 1 || request.time))
    return fail(ErrorCode::Usage, "--time and --frames need a scenario with an orbit; leave --sun "
                                  "and --observer out");
  if (request.time && request.frames > 1)
    return fail(ErrorCode::Usage, "--time shows one moment, --frames those of a pass; leave one of "
                                  "them out");
  if (request.view && norm(cross(request.view->up, request.view->pose.observer)) < 1e-6)
    return fail(ErrorCode::Usage, "--up lies along the line of sight; give another direction");
  return {};
}

KeyFrameShading shading_of(Shade shade) {
  switch (shade) {
  case Shade::Polarization:
    return KeyFrameShading::Polarization;
  case Shade::PositionAngle:
    return KeyFrameShading::PositionAngle;
  case Shade::Material:
    return KeyFrameShading::Material;
  case Shade::Intensity:
  case Shade::Colour: // has its own way
    break;
  }
  return KeyFrameShading::Intensity;
}

using Rasters = std::vector<KeyFrameRaster>; ///< of one shot, a band each

/// 8-bit pictures, one exposure for all.
Result<void> put_png(const RenderRequest &request, const std::vector<Rasters> &all,
                     const PictureSink &sink, const Monitor &monitor) {
  Rasters flat;
  if (all.size() > 1) // a single large picture takes gigabytes
    for (const Rasters &rasters : all)
      flat.insert(flat.end(), rasters.begin(), rasters.end());
  const double white = common_exposure(all.size() > 1 ? flat : all.front());
  std::vector<std::vector<std::uint8_t>> frames;
  for (const Rasters &rasters : all) {
    if (request.shade == Shade::Colour) {
      UMOV_ASSIGN(rgb, shade_colour(rasters, white, monitor.cancel));
      frames.push_back(std::move(rgb));
    } else {
      frames.push_back(shade(rasters.front(), shading_of(request.shade), white, monitor.cancel));
      draw_colour_bar(frames.back(), request.side, shading_of(request.shade));
    }
  }
  if (monitor.is_cancelled())
    return fail(ErrorCode::Interrupted, "stopped by the user; nothing was written");
  if (frames.size() > 1 && !request.has_file_each) {
    UMOV_ASSIGN(movie, encode_animation(request.side, request.side, frames, request.frames_per_s));
    return sink(0, std::move(movie));
  }
  for (std::size_t k = 0; k < frames.size(); ++k) {
    UMOV_ASSIGN(picture, encode_png(request.side, request.side, frames[k]));
    UMOV_TRY(sink(k, std::move(picture)));
  }
  return {};
}

Result<std::string> exr_of(const RenderRequest &request, const std::vector<Band> &bands,
                           const Shot &shot, const Rasters &rasters, std::size_t bounces) {
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
  return encode_exr(request.side, request.side, channels, notes);
}

/// What is left of tracing.
struct Traced {
  std::vector<Rasters> kept; ///< of PNG files: they wait for their exposure
  double width_m = 0;
};

/// Traces each shot; those of OpenEXR are written at once.
Result<Traced> trace(const RenderRequest &request, const Scenario &scenario, const Subject &subject,
                     const KeyFrameOptions &how, const PictureSink &sink, const Monitor &monitor) {
  return without_failures([&]() -> Result<Traced> {
    const KeyFrameStage stage(subject.object.scene,
                              joints_of(scenario.objects[request.object].parts), how.bounces,
                              how.cancel);
    Traced out;
    for (std::size_t k = 0; k < subject.shots.size(); ++k) {
      const Shot &shot = subject.shots[k];
      if (monitor.is_cancelled())
        return fail(ErrorCode::Interrupted,
                    request.is_exr && k > 0
                        ? fmt::format("stopped by the user; {} written", counted(k, "picture"))
                        : "stopped by the user; nothing was written");
      UMOV_ASSIGN(rasters, stage.trace(shot.view, shot.joint_angles_rad, how, subject.bands));
      out.width_m = 2 * rasters.front().half_width_m;
      if (request.is_exr) {
        UMOV_ASSIGN(file, exr_of(request, subject.object.scene.bands, shot, rasters, how.bounces));
        UMOV_TRY(sink(subject.first + k, std::move(file)));
      } else {
        out.kept.push_back(std::move(rasters));
      }
      monitor.advance("pictures", k + 1, subject.shots.size());
    }
    return out;
  });
}

/// Keeps the shots of the part that was asked for.
Result<void> take_part(const JobPart &part, Subject &subject) {
  UMOV_ASSIGN(range, part.of(subject.shots.size(), "frames"));
  subject.first = range.first;
  subject.shots.erase(subject.shots.begin() + static_cast<std::ptrdiff_t>(range.end()),
                      subject.shots.end());
  subject.shots.erase(subject.shots.begin(),
                      subject.shots.begin() + static_cast<std::ptrdiff_t>(range.first));
  if (subject.shots.empty())
    return fail(ErrorCode::Nothing, "no frame is in the part that was asked for");
  return {};
}

} // namespace

Result<Rendered> render(const Scenario &scenario, const RenderRequest &request,
                        const PictureSink &sink, const JobOptions &options, const Monitor &monitor,
                        Diagnostics &diagnostics) {
  UMOV_TRY(check(request, scenario));
  UMOV_ASSIGN(object, load_object(scenario, request.object,
                                  {.allow_bad_checksum = options.allow_bad_checksum,
                                   .allow_old_elements = options.allow_old_elements,
                                   .turns_in_time = !request.view,
                                   .cancel = monitor.cancel,
                                   .at = request.time},
                                  diagnostics));
  const std::vector<Band> &bands = object.scene.bands;
  UMOV_ASSIGN(band, band_index(request.band, bands));
  UMOV_ASSIGN(traced, bands_of(request, band, bands.size()));
  Subject subject{std::move(object), std::move(traced), {}, 0};
  if (request.view) {
    const PartAngles parts(scenario.objects[request.object].parts, true, scenario.file,
                           diagnostics);
    subject.shots.push_back({*request.view, parts.of({&request.view->pose, 1}), {}});
  } else {
    UMOV_ASSIGN(shots,
                shots_from_orbit(request, scenario, subject.object, options, monitor, diagnostics));
    subject.shots = std::move(shots);
  }
  const KeyFrameOptions how{request.side,         request.samples, band,
                            request.half_width_m, options.threads, scenario.light.bounces,
                            request.paths,        scenario.seed,   monitor.cancel};
  UMOV_TRY(take_part(request.part, subject));
  UMOV_ASSIGN(traced_all, trace(request, scenario, subject, how, sink, monitor));
  if (!request.is_exr)
    UMOV_TRY(put_png(request, traced_all.kept, sink, monitor));
  return Rendered{subject.shots.size(), traced_all.width_m, subject.shots.front().when,
                  subject.shots.back().when};
}

} // namespace umov::jobs
