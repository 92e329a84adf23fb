// umov render: the object as the observer sees it.

#include "finishing.h"
#include "job_console.h"
#include "render_options.h"
#include "site_options.h"
#include "verbs.h"

#include <algorithm>
#include <fmt/format.h>
#include <umov/core/text.h>
#include <umov/jobs/render.h>

namespace umov::cli {
namespace {

/// The name of a frame's file: its number where the # stand.
std::string numbered(const std::string &name, std::size_t frame) {
  const std::size_t first = name.find('#');
  if (first == std::string::npos)
    return name;
  const std::size_t end = std::min(name.find_first_not_of('#', first), name.size());
  return fmt::format("{}{:0{}d}{}", name.substr(0, first), frame, end - first, name.substr(end));
}

Result<Vec3<Body>> direction(const std::vector<double> &xyz, const std::string &option) {
  const Vec3<Body> v{xyz[0], xyz[1], xyz[2]};
  if (!(norm(v) > 0))
    return fail(ErrorCode::Usage, option + " 0 0 0: a direction was expected");
  return normalized(v);
}

Result<KeyFrameView> view_of(const RenderOptions &o) {
  if (o.sun.empty() || o.observer.empty())
    return fail(ErrorCode::Usage,
                "--sun and --observer go together: two directions in the body frame");
  UMOV_ASSIGN(sun, direction(o.sun, "--sun"));
  UMOV_ASSIGN(observer, direction(o.observer, "--observer"));
  UMOV_ASSIGN(up, direction(o.up, "--up"));
  return KeyFrameView{{sun, observer}, up};
}

/// Options that would change nothing, which the user should not take for what is seen.
Result<void> check_used(const RenderOptions &o, const Scenario &scenario) {
  const bool is_exr = o.output.ends_with(".exr");
  if (is_exr && o.shade)
    return fail(ErrorCode::Usage, "--shade is of a .png; an .exr has I, Q, U, V as they are");
  if (!o.request.band.empty() && (is_exr || o.shade == "colour"))
    return fail(ErrorCode::Usage, "--band chooses one, and --shade colour takes three and an .exr "
                                  "all of the scene; leave --band out or --set bands.set");
  const bool is_movie =
      o.request.frames > 1 && o.output.ends_with(".png") && o.output.find('#') == std::string::npos;
  if (o.frames_per_s && !is_movie)
    return fail(ErrorCode::Usage, "--fps is the speed of an animation: --frames N, and -o a .png "
                                  "without # were expected");
  if (o.paths && scenario.light.bounces == 1)
    return fail(ErrorCode::Usage,
                "--paths counts those of light that touched several surfaces, and render.bounces "
                "is 1. Pass --set render.bounces=N (N > 1) or leave --paths out");
  return {};
}

jobs::RenderRequest::Shade shade_of(const std::string &word) {
  using Shade = jobs::RenderRequest::Shade;
  return word == "p"          ? Shade::Polarization
         : word == "pa"       ? Shade::PositionAngle
         : word == "material" ? Shade::Material
         : word == "colour"   ? Shade::Colour
                              : Shade::Intensity;
}

Result<jobs::RenderRequest> request_of(const RenderOptions &o) {
  jobs::RenderRequest out = o.request;
  out.is_exr = o.output.ends_with(".exr");
  if (!out.is_exr && !o.output.ends_with(".png"))
    return fail(ErrorCode::Usage,
                "-o " + o.output + ": a name that ends in .png or .exr was expected");
  if (o.object < 1)
    return fail(ErrorCode::Usage, "--object 0: a number from 1 was expected");
  out.shade = shade_of(o.shade.value_or("I"));
  if (!o.sun.empty() || !o.observer.empty()) {
    UMOV_ASSIGN(view, view_of(o));
    out.view = view;
  }
  if (!o.time.empty()) {
    UMOV_ASSIGN(time, time_of("--time", o.time));
    out.time = time;
  }
  out.frames_per_s = o.frames_per_s.value_or(out.frames_per_s);
  out.paths = o.paths.value_or(out.paths);
  out.object = o.object - 1;
  out.has_file_each = o.output.find('#') != std::string::npos;
  UMOV_ASSIGN(part, part_of(o.part));
  out.part = part;
  return out;
}

Result<void> run_render(const RenderOptions &o, const Common &common, Diagnostics &diagnostics) {
  UMOV_ASSIGN(request, request_of(o));
  UMOV_ASSIGN(scenario, read_scenario(o.scene, o.overrides));
  UMOV_TRY(check_used(o, scenario));
  const jobs::JobOptions options = with_elements(job_options(common), o.elements);
  JobConsole console(common, tracing_masks);
  const auto keep = [&](std::size_t frame, const std::string &bytes) {
    return put(numbered(o.output, frame), bytes);
  };
  UMOV_ASSIGN(done,
              jobs::render(scenario, request, keep, options, console.monitor(true), diagnostics));
  std::string when = done.first_utc.empty() ? "" : ", " + done.first_utc;
  if (!when.empty() && done.pictures > 1)
    when += " to " + done.last_utc;
  note(common, fmt::format("{}: {}, {:.4g} m wide{}", o.output, counted(done.pictures, "picture"),
                           done.width_m, when));
  return {};
}

} // namespace

void add_render(CLI::App &app, const Exit &exit_with) {
  auto *verb = app.add_subcommand("render", "The object as the observer sees it: PNG, animated PNG "
                                            "of a pass, OpenEXR with Stokes channels");
  auto o = std::make_shared<RenderOptions>();
  auto common = std::make_shared<Common>();
  add_render_options(*verb, *o);
  add_threads(*verb, *common);
  add_common(*verb, *common, false);
  verb->callback(stoppable(exit_with, common, [o, common](Diagnostics &diagnostics) {
    return run_render(*o, *common, diagnostics);
  }));
}

} // namespace umov::cli
