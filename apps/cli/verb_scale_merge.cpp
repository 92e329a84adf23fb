// umov scale merge.

#include "job_console.h"
#include "scale_folder_verb.h"
#include "tables.h"

#include <umov/scale/merge.h>

namespace umov::cli {

void add_scale_merge(CLI::App &scale, const Exit &exit_with) {
  auto output = std::make_shared<std::string>(), table = std::make_shared<std::string>();
  auto *verb = add_folder_verb(
      scale, exit_with, "merge", "The table that the plain command would have written", false,
      [=](const scale::JobFolder &folder, const Common &common) -> Result<void> {
        UMOV_TRY(check_output(*output));
        JobConsole console(common);
        const auto sink = sink_for(*output, common);
        const jobs::Monitor monitor = console.monitor(false);
        UMOV_TRY(scale::merge(folder, table->empty() ? folder.lock().tables.front() : *table, *sink,
                              monitor));
        return scale::check_answers(folder, monitor);
      });
  add_table_output(*verb, *output);
  verb->add_option(
      "--table", *table,
      "Of a run: lightcurve (default) or passes; of an observation: counts (default) or truth; of "
      "curves: curves (default) or those of an answer");
}

} // namespace umov::cli
