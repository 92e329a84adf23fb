#include "render_options.h"

#include <fmt/format.h>
#include <umov/core/text.h>

namespace umov::cli {
namespace {

void add_what(CLI::App &verb, RenderOptions &o) {
  verb.add_option("scene", o.scene, "Scenario file (TOML)")->required();
  verb.add_option(
          "-o,--output", o.output,
          "File: .png, or .exr with I, Q, U, V of every band; pass_###.exr: a file for each frame")
      ->required();
  verb.add_option("--shade", o.shade,
                  "Of a .png: I, p, pa, material, or colour (three bands as blue, green, red)")
      ->check(CLI::IsMember({"I", "p", "pa", "material", "colour"}))
      ->default_str("I");
  verb.add_option("--band", o.request.band,
                  "Of the picture, as the scene spells it; default: the middle one");
  verb.add_option("--time", o.time,
                  "UTC; default: the brightest moment of the first pass in [time]");
  verb.add_option("--frames", o.request.frames,
                  "Pictures of the first pass, as an animated PNG or in files of their own")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  verb.add_option("--fps", o.frames_per_s, "Frames per second of the animation, with --frames")
      ->check(CLI::Range(0.1, 60.0))
      ->default_str(shortest(o.request.frames_per_s));
  verb.add_option("--sun", o.sun, "Direction in the body frame, instead of an orbit: X Y Z")
      ->expected(3);
  auto *observer =
      verb.add_option("--observer", o.observer, "The same for the observer")->expected(3);
  verb.add_option("--up", o.up, "What is up in the picture, with --observer")
      ->expected(3)
      ->capture_default_str()
      ->needs(observer);
  verb.add_option("--object", o.object, "Which [[object]], from 1")->capture_default_str();
  verb.add_option("--set", o.overrides, "KEY=VALUE over a key of the scenario");
  add_part(verb, o.part, "frames");
  add_elements(verb, o.elements);
}

void add_picture(CLI::App &verb, RenderOptions &o) {
  verb.add_option("--size", o.request.side, "Pixels per side")
      ->check(CLI::Range(16, 4096))
      ->capture_default_str();
  verb.add_option("--samples", o.request.samples, "Rays per pixel and axis")
      ->check(CLI::Range(1, 8))
      ->capture_default_str();
  verb.add_option("--paths", o.paths,
                  "Per ray, of light that touched several surfaces (render.bounces > 1)")
      ->check(CLI::Range(1, 4096))
      ->default_str(fmt::format("{}", o.request.paths));
  verb.add_option("--half-width", o.request.half_width_m,
                  "Half the picture's side [m]; default: the whole object")
      ->check(CLI::Range(1e-6, 1e6));
}

} // namespace

void add_render_options(CLI::App &verb, RenderOptions &options) {
  add_what(verb, options);
  add_picture(verb, options);
}

} // namespace umov::cli
