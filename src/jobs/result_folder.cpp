#include "jobs/result_folder.h"

#include "jobs/kept_inputs.h"

#include <algorithm>
#include <umov/jobs/tallies.h>

namespace umov::jobs {

bool wants(const Scenario &scenario, const char *format) {
  return std::ranges::find(scenario.formats, format) != scenario.formats.end();
}

Result<std::vector<std::string>> add_table(const Table &table, const std::string &name,
                                           const Scenario &scenario, RunFolder &folder) {
  std::vector<std::string> out;
  const auto put = [&](const char *ending, std::string bytes) {
    out.push_back(name + ending);
    folder.add(out.back(), std::move(bytes));
  };
  if (wants(scenario, "ecsv"))
    put(".ecsv", to_ecsv(table));
  if (wants(scenario, "csv"))
    put(".csv", to_csv(table));
  if (wants(scenario, "fits")) {
    UMOV_ASSIGN(bytes, to_fits(table));
    put(".fits", std::move(bytes));
  }
  return out;
}

std::string warning_lines(const Diagnostics &diagnostics) {
  std::string out;
  for (const Warning &warning : diagnostics.warnings())
    out += "warning: " + warning.text() + "\n";
  return out;
}

std::vector<std::string> messages_of(const Diagnostics &diagnostics) {
  std::vector<std::string> out;
  out.reserve(diagnostics.warnings().size());
  for (const Warning &warning : diagnostics.warnings())
    out.push_back(warning.message);
  return out;
}

void note_warnings(Table &table, const Diagnostics &diagnostics) {
  note_warnings(table, messages_of(diagnostics));
}

Result<void> add_records(const Scenario &scenario, const std::string &options_needed,
                         std::string log, const std::vector<InputFile> &inputs,
                         const Diagnostics &diagnostics, ManifestInput manifest,
                         RunFolder &folder) {
  folder.add("log.txt", std::move(log));
  for (const InputFile &input : inputs)
    if (const std::pair entry{input.path, input.sha256};
        std::ranges::find(manifest.inputs, entry) == manifest.inputs.end())
      manifest.inputs.push_back(entry);
  std::string lock = options_needed + locked_scenario(scenario);
  if (scenario.keeps_inputs)
    UMOV_TRY(keep_inputs(manifest.inputs, folder, lock, manifest.files));
  folder.add("scenario.lock.toml", std::move(lock));
  manifest.seed = scenario.seed;
  for (const Warning &warning : diagnostics.warnings())
    manifest.warnings.push_back(warning.text());
  folder.add("manifest.json", make_manifest(manifest));
  return {};
}

} // namespace umov::jobs
