// The files of a run's folder.

#include "jobs/result_folder.h"
#include "jobs/run_report.h"

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

Result<void> add_tables(const Written &run, RunFolder &folder) {
  const auto [table, passes] = run_tables(run.result);
  if (run.result.stopped)
    folder.spare_complete_run();
  folder.add("passes.ecsv", to_ecsv(passes));
  UMOV_TRY(add_table(table, "lightcurve", run.scenario, folder));
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
  out += warning_lines(run.diagnostics);
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

void append_tables(const ObjectRun &object, RunTables &tables) {
  const LightCurveOutcome &outcome = object.outcome;
  tables.light_curve.append(light_curve_table(outcome.curve, object.request.frame));
  tables.passes.append(passes_table(outcome.passes, outcome.curve));
}

RunTables run_tables(const RunResult &run) {
  RunTables out;
  for (const ObjectRun &one : run.objects)
    append_tables(one, out);
  if (run.has_all_csv_digits)
    out.light_curve.clear_precision();
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
  std::vector<InputFile> inputs;
  for (const ObjectRun &one : result.objects) {
    inputs.insert(inputs.end(), one.object.inputs.begin(), one.object.inputs.end());
    manifest.light.push_back({one.request.object, name_of(one.light.method), one.light.visibility,
                              one.light.instruction_set, one.light.device});
  }
  if (result.stopped)
    manifest.stopped = result.stopped->text();
  UMOV_TRY(add_records(scenario, options_needed(options), log_of(run), inputs, diagnostics,
                       std::move(manifest), folder));
  UMOV_TRY(folder.commit());
  if (!result.stopped || result.stopped->code != ErrorCode::Interrupted)
    result.journal.finish();
  return {};
}

} // namespace umov::jobs
