// The files of a run's folder.

#include "jobs/run_report.h"

#include <algorithm>
#include <fmt/format.h>
#include <umov/io/light_curve_table.h>
#include <umov/jobs/run.h>

namespace umov::jobs {
namespace {

/// Everything that a finished run knows.
struct Written {
  const RunResult &result;
  const Scenario &scenario;
  const JobOptions &options;
  const Diagnostics &diagnostics;
};

bool wants(const Scenario &scenario, const char *format) {
  return std::find(scenario.formats.begin(), scenario.formats.end(), format) !=
         scenario.formats.end();
}

Result<void> add_tables(const Written &run, RunFolder &folder) {
  const auto [table, passes] = run_tables(run.result);
  if (run.result.stopped)
    folder.spare_complete_run();
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
Result<void> add_reports(const Written &run, RunFolder &folder) {
  if (!wants(run.scenario, "html"))
    return {};
  for (std::size_t k = 0; k < run.result.objects.size(); ++k) {
    const ObjectRun &one = run.result.objects[k];
    if (one.outcome.curve.epochs.empty())
      continue;
    UMOV_ASSIGN(
        page, make_run_report(run.scenario, one.object, one.request, one.outcome, run.diagnostics));
    folder.add(k == 0 ? "report.html" : fmt::format("report_{}.html", k + 1), std::move(page));
  }
  return {};
}

std::string log_of(const Written &run) {
  std::string out;
  for (const ObjectRun &one : run.result.objects)
    out += summarize(one.outcome);
  for (const Warning &warning : run.diagnostics.warnings())
    out += "warning: " + warning.text() + "\n";
  if (run.result.stopped)
    out += "error: " + run.result.stopped->text() + "\n";
  return out;
}

/// What the options of the command need besides the scenario, to repeat the run.
std::string options_needed(const JobOptions &options) {
  std::string out;
  if (options.allow_bad_checksum)
    out += " --allow-bad-checksum";
  if (options.allow_old_elements)
    out += " --allow-old-elements";
  return out.empty() ? "" : "# This run was made with" + out + ".\n";
}

} // namespace

RunTables run_tables(const RunResult &run) {
  RunTables out;
  for (const ObjectRun &one : run.objects) {
    out.light_curve.append(light_curve_table(one.outcome.curve, one.request.frame));
    out.passes.append(passes_table(one.outcome.passes, one.outcome.curve));
  }
  if (run.stopped) {
    out.light_curve.note("status", "stopped early: " + run.stopped->message);
    out.passes.note("status", "stopped early: " + run.stopped->message);
  }
  return out;
}

Result<void> write_run(RunResult &result, const Scenario &scenario, const JobOptions &options,
                       ManifestInput manifest, const Diagnostics &diagnostics, RunFolder &folder) {
  const Written run{result, scenario, options, diagnostics};
  UMOV_TRY(add_tables(run, folder));
  UMOV_TRY(add_reports(run, folder));
  folder.add("scenario.lock.toml", options_needed(options) + locked_scenario(scenario));
  folder.add("log.txt", log_of(run));
  for (const ObjectRun &one : result.objects) {
    for (const InputFile &input : one.object.inputs)
      if (const std::pair entry{input.path, input.sha256};
          std::find(manifest.inputs.begin(), manifest.inputs.end(), entry) == manifest.inputs.end())
        manifest.inputs.push_back(entry);
    manifest.light.push_back({one.request.object, name_of(one.light.method), one.light.visibility,
                              one.light.instruction_set});
  }
  manifest.seed = scenario.seed;
  for (const Warning &warning : diagnostics.warnings())
    manifest.warnings.push_back(warning.text());
  if (result.stopped)
    manifest.stopped = result.stopped->text();
  folder.add("manifest.json", make_manifest(manifest));
  UMOV_TRY(folder.commit());
  if (!result.stopped || result.stopped->code != ErrorCode::Interrupted)
    result.journal.finish();
  return {};
}

} // namespace umov::jobs
