// umov period: how the brightness of a light curve repeats.

#include "finishing.h"
#include "tables.h"
#include "verbs.h"

#include <umov/core/files.h>
#include <umov/jobs/period.h>

namespace umov::cli {
namespace {

struct PeriodVerb {
  std::string observations, output, page;
  std::vector<std::string> columns;
  jobs::PeriodRequest request;
};

Result<void> run_period(const PeriodVerb &o, const Common &common, Diagnostics &diagnostics) {
  UMOV_TRY(check_output(o.output));
  UMOV_TRY(check_page("--page", o.page));
  constexpr std::size_t largest = 1u << 30;
  UMOV_ASSIGN(text, read_file(o.observations, largest));
  UMOV_ASSIGN(rows, read_observations_text(text, o.observations, diagnostics));
  UMOV_ASSIGN(table, jobs::period(rows, o.request, diagnostics));
  UMOV_ASSIGN(shown, chosen_columns(table, o.columns, {}, o.output, common));
  UMOV_TRY(put_table(o.output, shown, common));
  if (!o.page.empty()) {
    UMOV_ASSIGN(page, jobs::period_page(rows, o.request));
    UMOV_TRY(put(o.page, page));
  }
  for (const auto &[key, said] : table.notes())
    if (key == "spin")
      note(common, said);
  return {};
}

} // namespace

void add_period(CLI::App &app, const Exit &exit_with) {
  auto *verb = app.add_subcommand("period", "Periods that a light curve shows, ours or your own");
  auto o = std::make_shared<PeriodVerb>();
  auto common = std::make_shared<Common>();
  verb->add_option("observations", o->observations,
                   "CSV or ECSV with time_utc (or mjd_utc) and mag or flux; lightcurve.ecsv of a "
                   "run, stokes.ecsv of umov reduce. Each counts alike, whatever its error says")
      ->required();
  verb->add_option("--band", o->request.band, "Only this band; else each by itself");
  verb->add_option("--peaks", o->request.peaks, "How many of each stretch and band")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  verb->add_option("--shortest-s", o->request.shortest_s, "Leave out shorter periods [s]")
      ->check(CLI::Range(0.0, 1e9));
  verb->add_option("--longest-s", o->request.longest_s, "Leave out longer periods [s]")
      ->check(CLI::Range(0.0, 1e9));
  verb->add_option("--gap-s", o->request.gap_s, "A longer gap begins a new stretch [s]")
      ->check(CLI::Range(1.0, 1e9))
      ->capture_default_str();
  verb->add_option("--false-alarm", o->request.false_alarm,
                   "Leave out peaks that noise alone has more often than this; 1: none")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
  verb->add_option("--page", o->page,
                   "Also a page of figures: brightness, periodogram, the curve folded: x.html");
  add_table_output(*verb, o->output);
  add_columns(*verb, o->columns);
  add_common(*verb, *common, true);
  verb->callback(finishing(exit_with, common, [o, common](Diagnostics &diagnostics) {
    return run_period(*o, *common, diagnostics);
  }));
}

} // namespace umov::cli
