// The files of an observation's folder.

#include "jobs/observe_pages.h"
#include "jobs/result_folder.h"

#include <fmt/format.h>
#include <umov/core/text.h>
#include <umov/jobs/observe.h>

namespace umov::jobs {

Result<void> write_observation(const Observation &observation, const Scenario &scenario,
                               ManifestInput manifest, const Diagnostics &diagnostics,
                               RunFolder &folder) {
  for (const auto &[name, table] :
       {std::pair<const char *, const Table *>{"counts", &observation.counts},
        {"truth", &observation.truth}}) {
    UMOV_ASSIGN(files, add_table(*table, name, scenario, folder));
    manifest.files.insert(manifest.files.end(), files.begin(), files.end());
  }
  manifest.light = observation.light;
  if (wants(scenario, "html")) {
    const std::string title = scenario.title.empty() ? "Counts" : scenario.title;
    UMOV_ASSIGN(page, observation_page(observation, title, diagnostics));
    folder.add("report.html", std::move(page));
  }
  const std::string log =
      fmt::format("{}, {} rows of counts\n", counted(observation.exposures, "exposure"),
                  observation.counts.rows()) +
      warning_lines(diagnostics);
  UMOV_TRY(
      add_records(scenario, "", log, observation.inputs, diagnostics, std::move(manifest), folder));
  return folder.commit();
}

} // namespace umov::jobs
