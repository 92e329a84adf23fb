#include "signature_options.h"

#include "device_options.h"
#include "tables.h"

namespace umov::cli {
namespace {

/// Many a file of poses is handed over here: the message names the option that takes one.
CLI::Validator number_of_poses() {
  return {[](std::string &text) {
            const bool is_number =
                !text.empty() && text.find_first_not_of("0123456789") == std::string::npos;
            if (is_number && text.size() < 9 && std::stol(text) >= 1 &&
                std::stol(text) <= 10'000'000)
              return std::string();
            return text + " is no number of random poses; 1 to 10000000 was expected" +
                   (is_number ? "" : ". A file of poses is given with --geometry FILE.csv");
          },
          "INT in [1 - 10000000]"};
}

} // namespace

void add_signature_options(CLI::App &verb, SignatureOptions &o, Common &common) {
  verb.add_option("scene", o.scene, "Scenario file; orbit, time and observer are not used")
      ->required();
  o.geometry_option =
      verb.add_option("--geometry", o.geometry,
                      "CSV with columns sun_x sun_y sun_z obs_x obs_y obs_z, body frame; with a "
                      "column pose, rows in turn of one number are one pose and keep it");
  o.poses_option = verb.add_option("--poses", o.poses, "Random poses for each phase angle")
                       ->check(number_of_poses());
  auto *phase = verb.add_option("--phase", o.phases_deg, "Phase angles [deg], separated by commas")
                    ->delimiter(',');
  o.geometry_option->excludes(o.poses_option)->excludes(phase);
  o.poses_option->needs(phase);
  phase->needs(o.poses_option);
  verb.add_option("--source", o.source,
                  "sun, laser: a point source of any polarization, or thermal: the body's own "
                  "heat; give the "
                  "wavelength of the last two as the band")
      ->check(CLI::IsMember({"sun", "laser", "thermal"}))
      ->capture_default_str();
  verb.add_option("--state", o.state,
                  "Laser: Stokes I Q U V of the incoming light in the scattering frame")
      ->expected(4);
  verb.add_option("--temperature", o.temperatures,
                  "Thermal: K of the whole body, or GROUP=K of a part; may stand several times")
      ->allow_extra_args(false);
  o.seed_option = verb.add_option("--seed", o.seed, "Of the random poses; default: the scenario's")
                      ->check(CLI::Range(std::int64_t{0}, std::int64_t{1} << 53));
  verb.add_option("--set", o.overrides, "KEY=VALUE over a key of the scenario");
  verb.add_option(
          "--accuracy", o.accuracy,
          "Relative 95 % half-width asked of I. Default: the scenario's render.accuracy; "
          "where it has none, 0.05 of I, or of 0.02 of the typical light where that is more "
          "(most rows are known ten times better), and 0.005 with rays, or with "
          "light between surfaces")
      ->check(CLI::Range(1e-6, 1.0));
  verb.add_option("--visibility", o.visibility,
                  "rays: each pose to the accuracy asked; masks: looked up between directions "
                  "traced beforehand, thousands of times faster, each row with its error; auto: "
                  "masks, and rays where they miss the accuracy. Default: the scenario's "
                  "render.method")
      ->check(CLI::IsMember({"auto", "rays", "masks"}));
  verb.add_option("--masks", o.masks,
                  "File to keep the masks in: read if it exists, made if not. For one mesh, its "
                  "material groups and one accuracy");
  add_part(verb, o.part, "poses");
  add_table_output(verb, o.output);
  add_device(verb, common);
  add_threads(verb, common);
  add_cache(verb, common);
  add_common(verb, common, true);
}

Result<void> check_directions(SignatureOptions &o) {
  o.has_seed = o.seed_option->count() > 0;
  if ((o.geometry_option->count() == 0 || o.geometry.empty()) && o.poses_option->count() == 0)
    return fail(ErrorCode::Usage,
                "say for which directions: --geometry TABLE, or --poses N --phase DEG");
  return {};
}

jobs::SignatureRequest request_of(const SignatureOptions &o) {
  using Source = jobs::SignatureRequest::Source;
  jobs::SignatureRequest out;
  out.source = o.source == "laser"     ? Source::Laser
               : o.source == "thermal" ? Source::Thermal
                                       : Source::Sun;
  out.state = {o.state[0], o.state[1], o.state[2], o.state[3]};
  out.temperatures = o.temperatures;
  if (!o.visibility.empty())
    out.method = o.visibility == "rays"    ? LightMethod::Rays
                 : o.visibility == "masks" ? LightMethod::Masks
                                           : LightMethod::Auto;
  if (o.accuracy > 0)
    out.accuracy = o.accuracy;
  if (o.has_seed)
    out.seed = o.seed;
  out.mask_file = o.masks;
  return out;
}

Result<jobs::PoseList> poses_of(const SignatureOptions &o, const Scenario &scenario) {
  if (!o.geometry.empty())
    return jobs::poses_from_file(o.geometry);
  return jobs::random_poses(o.poses, o.phases_deg, o.has_seed ? o.seed : scenario.seed);
}

} // namespace umov::cli
