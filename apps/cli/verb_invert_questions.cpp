// umov invert pose, spin, track, material and health: their own options and their jobs.

#include "invert_each.h"

namespace umov::cli {
namespace {

void add_pose(CLI::App &invert, const Exit &exit_with) {
  auto *verb =
      invert.add_subcommand("pose", "Which fixed attitudes explain a light curve, and how surely");
  auto o = std::make_shared<InvertVerb>();
  auto each = std::make_shared<EachOptions>();
  const EachJob many = pose_options(*verb, o, *each);
  run_invert_or_each(
      *verb, o, each, exit_with,
      [](const Scenario &scenario, const InvertVerb &asked, const jobs::Monitor &monitor,
         Diagnostics &diagnostics) {
        return jobs::invert_pose(scenario, asked.request, job_options(asked.common), monitor,
                                 diagnostics);
      },
      many);
}

void add_spin(CLI::App &invert, const Exit &exit_with) {
  auto *verb = invert.add_subcommand(
      "spin", "Which constant spins explain a light curve: period with aliases, axis, attitude");
  auto o = std::make_shared<InvertVerb>();
  auto spin = std::make_shared<jobs::SpinOptions>();
  auto axis = std::make_shared<std::string>("any");
  add_invert_options(*verb, o);
  add_material_errors(*verb, o);
  verb->add_option("--period", spin->period_s,
                   "Of a whole turn [s], good to a few per cent; else from the periodogram")
      ->check(CLI::Range(1e-3, 1e7));
  verb->add_flag_callback(
      "--no-aliases", [spin] { spin->has_aliases = false; }, "Try that period alone");
  verb->add_option("--axis", *axis, "Of the body: x, y, z (either sense), or any")
      ->check(CLI::IsMember({"x", "y", "z", "any"}))
      ->capture_default_str();
  run_invert(*verb, o, exit_with,
             [spin, axis](const Scenario &scenario, const InvertVerb &asked,
                          const jobs::Monitor &monitor, Diagnostics &diagnostics) {
               spin->axis = *axis == "any" ? '\0' : axis->front();
               return jobs::invert_spin(scenario, asked.request, *spin, job_options(asked.common),
                                        monitor, diagnostics);
             });
}

void add_track(CLI::App &invert, const Exit &exit_with) {
  auto *verb = invert.add_subcommand(
      "track", "Follow attitudes that are known through later observations, with weights");
  auto o = std::make_shared<InvertVerb>();
  auto track = std::make_shared<jobs::TrackRequest>();
  o->visibility = "masks"; // live: rays take a thousand times as long
  add_observations(*verb, o);
  verb->add_option("--start", track->start,
                   "Answer of umov invert pose, spin or track about earlier observations: its "
                   "folder, or its modes.ecsv");
  verb->add_option(
          "--rate-noise", track->rate_noise,
          "Random walk of the rate about each body axis [deg/s/sqrt(s)]; 0: it is constant")
      ->check(CLI::Range(0.0, 10.0))
      ->capture_default_str();
  verb->add_option("--rate-sd", track->rate_sd,
                   "How well it is known that attitudes of umov invert pose stand still [deg/s]")
      ->check(CLI::Range(1e-9, 10.0))
      ->capture_default_str();
  add_material_sds(*verb, o);
  run_invert(*verb, o, exit_with,
             [track](const Scenario &scenario, const InvertVerb &asked,
                     const jobs::Monitor &monitor, Diagnostics &diagnostics) {
               return jobs::invert_track(scenario, asked.request, *track, job_options(asked.common),
                                         monitor, diagnostics);
             });
}

void add_unmixing(CLI::App &invert, const Exit &exit_with) {
  auto *verb = invert.add_subcommand(
      "material", "What a part is made of, in the scenario's attitude: which, or how much of each");
  auto o = std::make_shared<InvertVerb>();
  auto material = std::make_shared<jobs::MaterialOptions>();
  add_invert_options(*verb, o);
  verb->add_option("--group", material->group, "Group of the mesh")->required();
  verb->add_option("--candidates", material->candidates, "Materials, separated by commas")
      ->delimiter(',')
      ->required();
  run_invert(*verb, o, exit_with,
             [material](const Scenario &scenario, const InvertVerb &asked,
                        const jobs::Monitor &monitor, Diagnostics &diagnostics) {
               return jobs::invert_material(scenario, asked.request, *material,
                                            job_options(asked.common), monitor, diagnostics);
             });
}

void add_health(CLI::App &invert, const Exit &exit_with) {
  auto *verb = invert.add_subcommand(
      "health",
      "What has changed on the body, in the scenario's attitude, and the least that shows");
  auto o = std::make_shared<InvertVerb>();
  auto health = std::make_shared<jobs::HealthOptions>();
  add_invert_options(*verb, o);
  verb->add_option("--drift", health->drifts,
                   "GROUP=MATERIAL: a group of the mesh and what it may be turning into")
      ->required();
  verb->add_option("--baseline", health->baseline,
                   "Light curves of before: changes are counted from them");
  verb->add_option("--attitude-sd", health->attitude_sd_deg,
                   "How well the attitude is known, about each axis [deg]")
      ->check(CLI::Range(0.0, 30.0))
      ->capture_default_str();
  run_invert(*verb, o, exit_with,
             [health](const Scenario &scenario, const InvertVerb &asked,
                      const jobs::Monitor &monitor, Diagnostics &diagnostics) {
               return jobs::invert_health(scenario, asked.request, *health,
                                          job_options(asked.common), monitor, diagnostics);
             });
}

} // namespace

EachJob pose_options(CLI::App &verb, const std::shared_ptr<InvertVerb> &o, EachOptions &each) {
  add_invert_options(verb, o);
  add_material_errors(verb, o);
  add_each(verb, each);
  return [](const Scenario &scenario, const InvertVerb &asked, const jobs::JobOptions &options,
            const jobs::Monitor &monitor, Diagnostics &diagnostics) {
    return jobs::ranged_poses(scenario, asked.request, options, monitor, diagnostics);
  };
}

void add_invert(CLI::App &app, const Exit &exit_with) {
  auto *invert = app.add_subcommand("invert", "From a light curve back to what made it");
  invert->require_subcommand(1);
  add_pose(*invert, exit_with);
  add_spin(*invert, exit_with);
  add_track(*invert, exit_with);
  add_unmixing(*invert, exit_with);
  add_health(*invert, exit_with);
  add_invert_plan(*invert, exit_with);
}

} // namespace umov::cli
