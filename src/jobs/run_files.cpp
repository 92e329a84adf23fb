// The files of a run's folder.

#include "jobs/run_report.h"

#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <umov/core/files.h>
#include <umov/core/text.h>
#include <umov/io/light_curve_table.h>
#include <umov/jobs/run.h>

namespace umov::jobs {
namespace {

namespace fs = std::filesystem;

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

fs::path absolute_path(const std::string &path) {
  std::error_code code;
  const auto full = fs::absolute(path, code);
  return (code ? fs::path(path) : full).lexically_normal();
}

/// The folder that all files are under: their places among each other stay (a mesh names its MTL).
fs::path common_folder(const std::vector<fs::path> &files) {
  fs::path out = files.front().parent_path();
  const auto is_under = [&](const fs::path &file) {
    return std::mismatch(out.begin(), out.end(), file.begin(), file.end()).first == out.end();
  };
  while (!std::ranges::all_of(files, is_under) && out.has_relative_path())
    out = out.parent_path();
  return out;
}

void replace_all(std::string &text, const std::string &from, const std::string &to) {
  for (std::size_t at = 0; (at = text.find(from, at)) != text.npos; at += to.size())
    text.replace(at, from.size(), to);
}

/// Copies of the inputs under inputs/, and a lock that names those. Device where one is not any
/// more what was read.
Result<void> keep_inputs(const std::vector<std::pair<std::string, std::string>> &inputs,
                         RunFolder &folder, std::string &lock, std::vector<std::string> &files) {
  std::vector<fs::path> full;
  for (const auto &[path, hash] : inputs)
    full.push_back(absolute_path(path));
  if (full.empty())
    return {};
  const fs::path top = common_folder(full);
  for (std::size_t k = 0; k < full.size(); ++k) {
    UMOV_ASSIGN(bytes, read_file(full[k]));
    if (sha256_hex(bytes) != inputs[k].second)
      return fail(ErrorCode::Device,
                  "was changed while the run went on: no copy of it can be kept. Run again.",
                  {full[k].string()});
    const std::string name = "inputs/" + full[k].lexically_relative(top).generic_string();
    replace_all(lock, toml_text(full[k].string()), toml_text(name));
    folder.add(name, std::move(bytes));
    files.push_back(name);
  }
  return {};
}

} // namespace

RunTables run_tables(const RunResult &run) {
  RunTables out;
  for (const ObjectRun &one : run.objects) {
    out.light_curve.append(light_curve_table(one.outcome.curve, one.request.frame));
    out.passes.append(passes_table(one.outcome.passes, one.outcome.curve));
  }
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
  folder.add("log.txt", log_of(run));
  for (const ObjectRun &one : result.objects) {
    for (const InputFile &input : one.object.inputs)
      if (const std::pair entry{input.path, input.sha256};
          std::find(manifest.inputs.begin(), manifest.inputs.end(), entry) == manifest.inputs.end())
        manifest.inputs.push_back(entry);
    manifest.light.push_back({one.request.object, name_of(one.light.method), one.light.visibility,
                              one.light.instruction_set});
  }
  std::string lock = options_needed(options) + locked_scenario(scenario);
  if (scenario.keeps_inputs)
    UMOV_TRY(keep_inputs(manifest.inputs, folder, lock, manifest.files));
  folder.add("scenario.lock.toml", std::move(lock));
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
