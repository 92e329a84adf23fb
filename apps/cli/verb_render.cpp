// umov render: the object as the observer sees it.

#include "doubtful_elements.h"
#include "job_console.h"
#include "site_options.h"
#include "verbs.h"

#include <fmt/format.h>
#include <umov/core/text.h>
#include <umov/jobs/render.h>

namespace umov::cli {
namespace {

struct RenderOptions {
  jobs::RenderRequest request;
  std::string scene, output, shade = "I", time;
  std::vector<std::string> overrides;
  std::vector<double> sun, observer, up{0, 0, 1};
  std::size_t object = 1;
  DoubtfulElements elements;
};

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

Result<jobs::RenderRequest> request_of(const RenderOptions &o) {
  using Shade = jobs::RenderRequest::Shade;
  jobs::RenderRequest out = o.request;
  out.is_exr = o.output.ends_with(".exr");
  if (!out.is_exr && !o.output.ends_with(".png"))
    return fail(ErrorCode::Usage,
                "-o " + o.output + ": a name that ends in .png or .exr was expected");
  if (o.object < 1)
    return fail(ErrorCode::Usage, "--object 0: a number from 1 was expected");
  out.shade = o.shade == "p"          ? Shade::Polarization
              : o.shade == "pa"       ? Shade::PositionAngle
              : o.shade == "material" ? Shade::Material
              : o.shade == "colour"   ? Shade::Colour
                                      : Shade::Intensity;
  if (!o.sun.empty() || !o.observer.empty()) {
    UMOV_ASSIGN(view, view_of(o));
    out.view = view;
  }
  if (!o.time.empty()) {
    UMOV_ASSIGN(time, time_of("--time", o.time));
    out.time = time;
  }
  out.object = o.object - 1;
  return out;
}

Result<void> run_render(const RenderOptions &o, const Common &common, Diagnostics &diagnostics) {
  UMOV_ASSIGN(request, request_of(o));
  UMOV_ASSIGN(scenario, read_scenario(o.scene, o.overrides));
  const jobs::JobOptions options = with_elements(job_options(common), o.elements);
  JobConsole console(common, tracing_masks);
  UMOV_ASSIGN(done, jobs::render(scenario, request, options, console.monitor(true), diagnostics));
  UMOV_TRY(put(o.output, done.bytes));
  std::string when = done.first_utc.empty() ? "" : ", " + done.first_utc;
  if (!when.empty() && done.pictures > 1)
    when += " to " + done.last_utc;
  note(common, fmt::format("{}: {}, {:.4g} m wide{}", o.output, counted(done.pictures, "picture"),
                           done.width_m, when));
  return {};
}

void add_what(CLI::App &verb, RenderOptions &o) {
  verb.add_option("scene", o.scene, "Scenario file (TOML)")->required();
  verb.add_option("-o,--output", o.output, "File: .png, or .exr with I, Q, U, V of every band")
      ->required();
  verb.add_option("--shade", o.shade,
                  "I, p, pa, material, or colour (three bands as blue, green, red)")
      ->check(CLI::IsMember({"I", "p", "pa", "material", "colour"}))
      ->capture_default_str();
  verb.add_option("--band", o.request.band,
                  "Of the picture, as the scene spells it; default: the middle one");
  verb.add_option("--time", o.time,
                  "UTC; default: the brightest moment of the first pass in [time]");
  verb.add_option("--frames", o.request.frames, "Pictures of the first pass, as an animated PNG")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  verb.add_option("--fps", o.request.frames_per_s, "Frames per second of the animation")
      ->check(CLI::Range(0.1, 60.0))
      ->capture_default_str();
  verb.add_option("--sun", o.sun, "Direction in the body frame, instead of an orbit: X Y Z")
      ->expected(3);
  verb.add_option("--observer", o.observer, "The same for the observer")->expected(3);
  verb.add_option("--up", o.up, "What is up in the picture, with --observer")
      ->expected(3)
      ->capture_default_str();
  verb.add_option("--object", o.object, "Which [[object]], from 1")->capture_default_str();
  verb.add_option("--set", o.overrides, "KEY=VALUE over a key of the scenario");
  add_elements(verb, o.elements);
}

void add_picture(CLI::App &verb, RenderOptions &o) {
  verb.add_option("--size", o.request.side, "Pixels per side")
      ->check(CLI::Range(16, 4096))
      ->capture_default_str();
  verb.add_option("--samples", o.request.samples, "Rays per pixel and axis")
      ->check(CLI::Range(1, 8))
      ->capture_default_str();
  verb.add_option("--paths", o.request.paths,
                  "Per ray, of light that touched several surfaces (render.bounces > 1)")
      ->check(CLI::Range(1, 4096))
      ->capture_default_str();
  verb.add_option("--half-width", o.request.half_width_m,
                  "Half the picture's side [m]; default: the whole object")
      ->check(CLI::Range(1e-6, 1e6));
}

} // namespace

void add_render(CLI::App &app, const Exit &exit_with) {
  auto *verb = app.add_subcommand("render", "The object as the observer sees it: PNG, animated PNG "
                                            "of a pass, OpenEXR with Stokes channels");
  auto o = std::make_shared<RenderOptions>();
  auto common = std::make_shared<Common>();
  add_what(*verb, *o);
  add_picture(*verb, *o);
  add_threads(*verb, *common);
  add_common(*verb, *common, false);
  verb->callback([o, common, exit_with] {
    watch_interrupts();
    Diagnostics diagnostics;
    const auto done = run_render(*o, *common, diagnostics);
    report(diagnostics, *common);
    exit_with(done ? 0 : report(done.error()));
  });
}

} // namespace umov::cli
