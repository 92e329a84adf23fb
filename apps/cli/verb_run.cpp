#include "console.h"
#include "run_outputs.h"
#include "scenario_jobs.h"
#include "verbs.h"

#include <algorithm>
#include <chrono>
#include <fmt/format.h>
#include <mutex>
#include <umov/core/parallel.h>
#include <umov/core/text.h>
#include <umov/io/light_curve_table.h>
#include <umov/io/run_folder.h>
#include <umov/io/scenario.h>

namespace umov::cli {
namespace {

struct RunOptions {
  std::string scenario, device = "auto";
  std::vector<std::string> overrides;
  std::int64_t seed = -1;
  double accuracy = 0;
  bool dry_run = false, allow_bad_checksum = false, allow_old_elements = false;
};

Result<Scenario> read_with_options(const RunOptions &o) {
  std::vector<std::string> overrides = o.overrides;
  if (o.seed >= 0)
    overrides.push_back(fmt::format("seed={}", o.seed));
  if (o.accuracy > 0)
    overrides.push_back(fmt::format("render.accuracy={:.17g}", o.accuracy));
  UMOV_ASSIGN(scenario, read_scenario(o.scenario, overrides));
  UMOV_TRY(check_complete_for_run(scenario));
  return scenario;
}

/// No row is a result of its own kind: it says when there will be one.
Error nothing_found(const LightCurveRequest &request) {
  const double span_days = seconds_between(request.stop, request.start) / 86400;
  if (const auto missed = find_next_pass(request, request.start, span_days))
    return {ErrorCode::Nothing,
            fmt::format("no epoch of the grid falls in a pass, but there is one near {}Z, max alt "
                        "{:.0f}: step_s = {:g} is longer than the pass. Take a shorter step.",
                        to_iso(missed->first_row).substr(0, 16), missed->altitude_max.degrees(),
                        request.step_s),
            {}};
  std::string text = fmt::format(
      "no {}pass of {} above {:g} deg{} from \"{}\" in that span.",
      request.only.sunlit ? "sunlit " : "", request.orbit.id(), request.only.altitude_min.degrees(),
      request.only.sun_altitude_max
          ? fmt::format(" with the Sun below {:g} deg", request.only.sun_altitude_max->degrees())
          : "",
      request.site.name);
  constexpr double days = 14; // beyond it the elements say little
  if (const auto next = find_next_pass(request, request.stop, days))
    text += fmt::format(" The next one: {}Z, max alt {:.0f}.",
                        to_iso(next->first_row).substr(0, 16), next->altitude_max.degrees());
  else
    text += fmt::format(" None in the next {:.0f} days either.", days);
  return {ErrorCode::Nothing, text, {}};
}

/// Rows whose numerical error stayed above what was asked are told, not hidden.
void warn_of_accuracy(const LightCurveOutcome &outcome, double accuracy, Diagnostics &diagnostics) {
  const LightCurve &curve = outcome.curve;
  const std::size_t bands = curve.bands.size();
  std::size_t count = 0;
  double worst = 0;
  for (std::size_t i = 0; i < curve.epochs.size(); ++i) {
    double error = 0;
    for (std::size_t b = 0; b < bands; ++b)
      if (const LightCurveSample &s = curve.samples[i * bands + b]; s.intensity > 0)
        error = std::max(error, s.half_width.i / s.intensity);
    count += error > 1.001 * accuracy ? 1u : 0u;
    worst = std::max(worst, error);
  }
  if (count > 0)
    diagnostics.warn(fmt::format("{} of {} epochs did not reach the accuracy {} asked of I (worst "
                                 "{:.2g}); they are faint. See intensity_err.",
                                 count, curve.epochs.size(), accuracy, worst));
}

/// The same of the Earth's light, whose patches are cut up to a bound.
void warn_of_earth(const LightCurveOutcome &outcome, const EarthshineOptions &options,
                   Diagnostics &diagnostics) {
  std::size_t count = 0;
  double worst = 0;
  const std::size_t bands = outcome.curve.bands.size();
  for (const SecondLight &light : outcome.curve.second_lights)
    for (std::size_t i = 0; light.name == "earth" && i < outcome.curve.epochs.size(); ++i) {
      double error = 0;
      for (std::size_t b = 0; b < bands; ++b)
        if (const double full = light.intensity[i * bands + b].i; full > 0)
          error = std::max(error, light.half_width[i * bands + b].i / full);
      count += error > 1.5 * options.accuracy ? 1u : 0u; // the mask's own error comes on top
      worst = std::max(worst, error);
    }
  if (count > 0)
    diagnostics.warn(
        fmt::format("{} of {} epochs did not reach the accuracy {} asked of earth_I with {} "
                    "sources (worst {:.2g}); see earth_I_err. A larger patches in earthshine "
                    "raises the bound, which is {} times as many.",
                    count, outcome.curve.epochs.size(), options.accuracy,
                    patches_bound * options.patches, worst, patches_bound));
}

bool wants(const Scenario &scenario, const char *format) {
  return std::find(scenario.formats.begin(), scenario.formats.end(), format) !=
         scenario.formats.end();
}

/// One object of the run: what it is and what came of it.
struct ObjectRun {
  LoadedObject object;
  LightCurveRequest request;
  LightCurveOutcome outcome;
};

/// Everything that a finished run knows.
struct Finished {
  const RunOptions &options;
  const Common &common;
  const Scenario &scenario;
  const std::vector<ObjectRun> &objects;
  const std::optional<Error> &stopped;
  const Diagnostics &diagnostics;
  std::chrono::system_clock::time_point started;
};

Result<void> add_tables(const Finished &run, RunFolder &folder) {
  Table table, passes;
  for (const ObjectRun &one : run.objects) {
    table.append(light_curve_table(one.outcome.curve, one.request.frame));
    passes.append(passes_table(one.outcome.passes, one.outcome.curve));
  }
  if (run.stopped) {
    folder.spare_complete_run();
    table.note("status", "stopped early: " + run.stopped->message);
    passes.note("status", "stopped early: " + run.stopped->message);
  }
  folder.add("passes.ecsv", to_ecsv(passes));
  if (wants(run.scenario, "ecsv"))
    folder.add("lightcurve.ecsv", to_ecsv(table));
  if (wants(run.scenario, "csv"))
    folder.add("lightcurve.csv", to_csv(table));
  if (wants(run.scenario, "fits")) {
    UMOV_ASSIGN(bytes, to_fits(table));
    folder.add("lightcurve.fits", std::move(bytes));
  }
  return {};
}

/// The first object's page is report.html, the others' are numbered from 2.
Result<void> add_reports(const Finished &run, RunFolder &folder) {
  if (!wants(run.scenario, "html"))
    return {};
  for (std::size_t k = 0; k < run.objects.size(); ++k) {
    const ObjectRun &one = run.objects[k];
    if (one.outcome.curve.epochs.empty())
      continue;
    UMOV_ASSIGN(
        page, make_run_report(run.scenario, one.object, one.request, one.outcome, run.diagnostics));
    folder.add(k == 0 ? "report.html" : fmt::format("report_{}.html", k + 1), std::move(page));
  }
  return {};
}

std::string log_of(const Finished &run) {
  std::string out;
  for (const ObjectRun &one : run.objects)
    out += summarize(one.outcome);
  for (const Warning &warning : run.diagnostics.warnings())
    out += "warning: " + warning.text() + "\n";
  if (run.stopped)
    out += "error: " + run.stopped->text() + "\n";
  return out;
}

Result<void> write_folder(const Finished &run, RunFolder &folder) {
  UMOV_TRY(add_tables(run, folder));
  UMOV_TRY(add_reports(run, folder));
  std::string needed;
  if (run.options.allow_bad_checksum)
    needed += " --allow-bad-checksum";
  if (run.options.allow_old_elements)
    needed += " --allow-old-elements";
  folder.add("scenario.lock.toml",
             (needed.empty() ? "" : "# This run was made with" + needed + ".\n") +
                 locked_scenario(run.scenario));
  folder.add("log.txt", log_of(run));
  ManifestInput manifest = manifest_of_command(run.common, run.started);
  for (const ObjectRun &one : run.objects)
    for (const InputFile &input : one.object.inputs)
      if (const std::pair entry{input.path, input.sha256};
          std::find(manifest.inputs.begin(), manifest.inputs.end(), entry) == manifest.inputs.end())
        manifest.inputs.push_back(entry);
  manifest.seed = run.scenario.seed;
  for (const Warning &warning : run.diagnostics.warnings())
    manifest.warnings.push_back(warning.text());
  if (run.stopped)
    manifest.stopped = run.stopped->text();
  folder.add("manifest.json", make_manifest(manifest));
  return folder.commit();
}

Result<std::vector<ObjectRun>> load_all(const RunOptions &o, const Scenario &scenario,
                                        const Common &common, Diagnostics &diagnostics) {
  std::vector<ObjectRun> out;
  for (std::size_t k = 0; k < scenario.objects.size(); ++k) {
    UMOV_ASSIGN(object, load_object(scenario, k, {o.allow_bad_checksum, o.allow_old_elements},
                                    diagnostics));
    LightCurveRequest request = light_curve_request(scenario, scenario.objects[k], object, common);
    if (common.verbose)
      for (const InputFile &input : object.inputs)
        note(common, fmt::format("read {} (SHA-256 {})", input.path, input.sha256));
    out.push_back({std::move(object), std::move(request), {}});
  }
  return out;
}

Result<LightCurveOutcome> compute(const ObjectRun &one, bool is_alone, const Common &common) {
  const Integrator integrator(one.object.scene);
  ProgressBar bar(is_alone ? "light curve" : one.request.object, common);
  std::mutex one_at_a_time;
  return compute_light_curve(
      one.request, one.object.scene, integrator,
      [&](std::size_t done, std::size_t total) {
        const std::lock_guard lock(one_at_a_time);
        bar.update(done, total);
      },
      interrupted());
}

/// Computes object after object; the first stop ends it, with the rows so far kept.
Result<std::optional<Error>> compute_all(std::vector<ObjectRun> &objects, const Scenario &scenario,
                                         const Common &common, Diagnostics &diagnostics) {
  std::optional<Error> stopped;
  std::size_t with_rows = 0;
  for (std::size_t k = 0; k < objects.size(); ++k) {
    auto outcome = compute(objects[k], objects.size() == 1, common);
    if (!outcome && objects.size() == 1)
      return tl::unexpected(outcome.error());
    if (outcome) {
      objects[k].outcome = std::move(*outcome);
      stopped = objects[k].outcome.stopped;
    } else {
      stopped = outcome.error();
    }
    const bool is_empty = objects[k].outcome.curve.epochs.empty();
    with_rows += is_empty ? 0u : 1u;
    if (!is_empty)
      warn_of_accuracy(objects[k].outcome, scenario.accuracy, diagnostics);
    if (!is_empty && scenario.earthshine)
      warn_of_earth(objects[k].outcome, *scenario.earthshine, diagnostics);
    if (stopped) {
      objects.resize(k + 1);
      break;
    }
    if (is_empty && objects.size() > 1)
      diagnostics.warn(nothing_found(objects[k].request).message);
  }
  if (with_rows == 0)
    return tl::unexpected(stopped ? *stopped : nothing_found(objects.front().request));
  std::erase_if(objects, [](const ObjectRun &one) { return one.outcome.curve.epochs.empty(); });
  return stopped;
}

Result<void> run(const RunOptions &o, const Common &common, Diagnostics &diagnostics) {
  const auto started = std::chrono::system_clock::now();
  UMOV_ASSIGN(scenario, read_with_options(o));
  UMOV_ASSIGN(folder, RunFolder::open(scenario.output_dir, common.force));
  UMOV_ASSIGN(objects, load_all(o, scenario, common, diagnostics));
  if (constexpr double long_step_s = 300; scenario.time->step_s > long_step_s)
    diagnostics.warn(
        fmt::format("step_s = {:g} is long against a pass: passes may be missed or joined",
                    scenario.time->step_s));
  warn_if_beyond_leap_seconds(scenario.time->stop, diagnostics);
  warn_if_outside_eop(scenario.time->start, scenario.time->stop, diagnostics);
  if (o.dry_run) {
    for (const ObjectRun &one : objects)
      note(common, fmt::format("{}: fine; {}, {}", o.scenario,
                               counted(one.object.scene.mesh.triangles.size(), "triangle"),
                               counted(one.object.scene.bands.size(), "band")));
    return {};
  }
  UMOV_ASSIGN(stopped, compute_all(objects, scenario, common, diagnostics));
  UMOV_TRY(write_folder({o, common, scenario, objects, stopped, diagnostics, started}, folder));
  if (!common.quiet) {
    for (const ObjectRun &one : objects)
      fmt::print("{}", summarize(one.outcome));
    fmt::print("written to {}\n", folder.path().string());
  }
  if (common.verbose)
    note(common,
         fmt::format(
             "{:.1f} s on {} threads",
             std::chrono::duration<double>(std::chrono::system_clock::now() - started).count(),
             resolve_threads(static_cast<unsigned>(common.threads))));
  if (stopped) {
    Error kept = *stopped;
    kept.message +=
        sentence_end(kept.message) + " The finished rows are in " + folder.path().string() + ".";
    return tl::unexpected(kept);
  }
  return {};
}

} // namespace

void add_run(CLI::App &app, const Exit &exit_with) {
  auto *verb = app.add_subcommand("run", "Light curve of a scenario: tables, report, manifest");
  auto o = std::make_shared<RunOptions>();
  auto common = std::make_shared<Common>();
  verb->add_option("scenario", o->scenario, "Scenario file (TOML); see umov schema")->required();
  verb->add_option("--set", o->overrides, "KEY=VALUE over a key of the scenario");
  verb->add_option("--seed", o->seed, "Over the scenario's seed")
      ->check(CLI::Range(std::int64_t{0}, std::int64_t{1} << 53));
  verb->add_option("--accuracy", o->accuracy, "Relative 95 % half-width asked of I")
      ->check(CLI::Range(1e-6, 1.0));
  verb->add_option("--device", o->device, "cpu or auto")->capture_default_str();
  verb->add_flag("--dry-run", o->dry_run, "Read and check everything, compute nothing");
  verb->add_flag("--force", common->force, "Write into a folder that umov did not make");
  verb->add_flag("--allow-bad-checksum", o->allow_bad_checksum,
                 "Read elements with a bad checksum");
  verb->add_flag("--allow-old-elements", o->allow_old_elements, "Take elements over 30 days old");
  verb->add_flag("-v,--verbose", common->verbose, "Also say what was read and how long it took");
  add_threads(*verb, *common);
  add_common(*verb, *common, false);
  verb->callback([o, common, exit_with] {
    if (o->device != "cpu" && o->device != "auto") {
      exit_with(
          report(Error{ErrorCode::Device,
                       "--device " + o->device +
                           ": this build has no such device. Use --device cpu; see umov doctor.",
                       {}}));
      return;
    }
    watch_interrupts();
    Diagnostics diagnostics;
    const auto done = run(*o, *common, diagnostics);
    report(diagnostics, *common);
    exit_with(done ? 0 : report(done.error()));
  });
}

} // namespace umov::cli
