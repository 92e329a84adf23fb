#include "device_options.h"
#include "finishing.h"
#include "job_console.h"
#include "tables.h"
#include "verbs.h"

#include <umov/bench/bench.h>

namespace umov::cli {
namespace {

struct BenchOptions {
  std::string output, orbit;
  std::vector<std::string> columns;
  bench::LightRequest light;
};

Result<void> run_bench(const BenchOptions &o, const Common &common, Diagnostics &diagnostics) {
  UMOV_TRY(check_output(o.output));
  if (!o.orbit.empty()) {
    UMOV_ASSIGN(table, bench::orbit(o.orbit, diagnostics));
    UMOV_ASSIGN(rates, chosen_columns(table, o.columns, {}, o.output, common));
    return put_table(o.output, rates, common);
  }
  note(common,
       "about half a minute of one core per case, less on a quick one; the table comes at the "
       "end (--only NAME measures less)");
  JobConsole console(common);
  bench::LightRequest request = o.light;
  request.device = device_options(common);
  UMOV_ASSIGN(report, bench::light(request, console.monitor(true), diagnostics));
  if (report.stopped)
    return tl::unexpected(stop_table(o.output, std::move(report.table), common, *report.stopped));
  UMOV_ASSIGN(shown, chosen_columns(report.table, o.columns, {}, o.output, common));
  return put_table(o.output, shown, common);
}

} // namespace

void add_bench(CLI::App &app, const Exit &exit_with) {
  auto *verb =
      app.add_subcommand("bench", "Speed and accuracy of the engine on this machine, side by side");
  auto o = std::make_shared<BenchOptions>();
  auto common = std::make_shared<Common>();
  verb->add_option("--mesh", o->light.meshes, "OBJ files (m, +Z up) instead of the standard cases");
  verb->add_option("--orbit", o->orbit, "Catalogue of elements: rates of SGP4 instead");
  verb->add_option("--only", o->light.only, "Cases with this in their name");
  verb->add_option("--geometries", o->light.geometries, "Poses compared with rays; 0: none")
      ->check(CLI::Range(0, 100'000))
      ->capture_default_str();
  verb->add_option("--seed", o->light.seed, "Of the poses that are compared with rays")
      ->capture_default_str();
  verb->add_option("--seconds", o->light.seconds, "Time spent on each rate")
      ->check(CLI::Range(0.01, 1000.0))
      ->capture_default_str();
  add_device(*verb, *common);
  verb->get_option("--orbit")->excludes("--device");
  verb->add_option("--batches", o->light.batches,
                   "Poses that cards are asked for at a time, separated by commas")
      ->delimiter(',')
      ->check(CLI::Range(std::size_t{1}, std::size_t{10'000'000}));
  add_table_output(*verb, o->output);
  add_columns(*verb, o->columns);
  add_common(*verb, *common, true);
  verb->callback(stoppable(exit_with, common, [o, common](Diagnostics &diagnostics) {
    return run_bench(*o, *common, diagnostics);
  }));
}

} // namespace umov::cli
