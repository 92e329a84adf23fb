#include "finishing.h"
#include "job_console.h"
#include "reduce_model.h"
#include "tables.h"
#include "verbs.h"

#include <algorithm>
#include <chrono>
#include <fmt/chrono.h>
#include <optional>
#include <umov/core/files.h>
#include <umov/jobs/calibrate.h>
#include <umov/jobs/measurement_files.h>
#include <umov/jobs/reduce.h>

namespace umov::cli {
namespace {

struct ReduceVerb {
  std::string counts, output, page, calibration, tdm, score, model = "static";
  std::vector<std::string> columns;
  std::vector<double> errors = std::vector<double>(jobs::reduce_priors().size(), 0); ///< as given
  std::optional<double> colour;
};

void put_errors(const ReduceVerb &o, jobs::ReduceOptions &out) {
  const auto priors = jobs::reduce_priors();
  for (std::size_t k = 0; k < priors.size(); ++k)
    priors[k].of(out) = o.errors[k] * priors[k].unit;
  out.colour = o.colour;
}

/// The forms in which others take magnitudes.
Result<void> put_measurements(const ReduceVerb &o, const CountsFile &counts, const Table &stokes) {
  const auto now = std::chrono::floor<std::chrono::seconds>(std::chrono::system_clock::now());
  const std::time_t seconds = std::chrono::system_clock::to_time_t(now);
  const jobs::MeasurementNotes notes{counts.notes, o.output == "-" ? "" : o.output,
                                     fmt::format("{:%Y-%m-%dT%H:%M:%S}", fmt::gmtime(seconds))};
  std::vector<std::pair<std::string, std::string>> files; // written once each can be
  if (!o.tdm.empty()) {
    UMOV_ASSIGN(text, jobs::as_tdm(stokes, notes));
    files.emplace_back(o.tdm, std::move(text));
  }
  if (!o.score.empty()) {
    UMOV_ASSIGN(text, jobs::score_text(stokes, notes));
    files.emplace_back(o.score, std::move(text));
  }
  for (const auto &[path, text] : files)
    UMOV_TRY(put(path, text));
  return {};
}

Result<void> run_reduce(const ReduceVerb &o, const Common &common, Diagnostics &diagnostics) {
  UMOV_TRY(check_output(o.output));
  UMOV_TRY(check_page("--page", o.page));
  UMOV_TRY(check_apart({o.counts, o.calibration}, {o.output, o.page, o.tdm, o.score}));
  jobs::ReduceOptions options;
  UMOV_TRY(read_reduce_model(o.model, options));
  put_errors(o, options);
  options.threads = static_cast<unsigned>(common.threads);
  constexpr std::size_t largest = 1u << 31;
  UMOV_ASSIGN(text, read_file(o.counts, largest));
  UMOV_ASSIGN(counts, read_counts_text(text, o.counts, diagnostics));
  if (!o.calibration.empty()) {
    UMOV_ASSIGN(read, read_file(o.calibration));
    UMOV_ASSIGN(file, read_calibration_text(read, o.calibration));
    UMOV_TRY(jobs::check_calibration(file, counts, o.calibration, diagnostics));
    options.calibration = file.calibration;
    options.photometry = file.photometry;
  }
  JobConsole console(common);
  UMOV_ASSIGN(
      table, of_file(jobs::reduce(counts, options, console.monitor(false), diagnostics), o.counts));
  if (!o.page.empty()) {
    UMOV_ASSIGN(page, jobs::stokes_page(table, "Stokes parameters of " + o.counts, diagnostics));
    UMOV_TRY(put(o.page, page));
  }
  UMOV_TRY(put_measurements(o, counts, table));
  UMOV_ASSIGN(shown, chosen_columns(table, o.columns,
                                    {"time_utc", "band", "mag", "q", "u", "v", "p_debiased", "p_lo",
                                     "p_hi", "pa", "pa_reach", "flags"},
                                    o.output, common));
  return put_table(o.output, shown, common);
}

void add_errors(CLI::App &verb, ReduceVerb &o) {
  const auto priors = jobs::reduce_priors();
  for (std::size_t k = 0; k < priors.size(); ++k) {
    std::string name = std::string("--") + priors[k].name;
    std::ranges::replace(name, '_', '-');
    verb.add_option(name, o.errors[k], priors[k].text)
        ->check(CLI::Range(0.0, 1e5))
        ->capture_default_str();
  }
}

} // namespace

void add_reduce(CLI::App &app, const Exit &exit_with) {
  auto *verb = app.add_subcommand("reduce", "Stokes parameters with errors from counts");
  auto o = std::make_shared<ReduceVerb>();
  auto common = std::make_shared<Common>();
  verb->add_option("counts", o->counts, "Counts of umov observe, or your own (ECSV, CSV, FITS)")
      ->required();
  verb->add_option("--calibration", o->calibration,
                   "Of umov calibrate: taken out of q and u, or of I");
  verb->add_option("--colour", o->colour,
                   "Of the object, in the index of the photometric standards; without it the Sun's "
                   "B - V")
      ->check(CLI::Range(-10.0, 20.0));
  verb->add_option("--model", o->model,
                   "static: every set by itself; fourier:PERIOD_S: brightness as a series over "
                   "time, q and u constant; spline:KNOTS_S: the same without a period")
      ->capture_default_str();
  add_errors(*verb, *o);
  verb->add_option("--tdm", o->tdm, "Also magnitudes as a CCSDS Tracking Data Message");
  verb->add_option("--score", o->score,
                   "Also magnitudes as a table for the IAU's repository SCORE");
  verb->add_option("--page", o->page, "Also a page of plots: x.html");
  add_table_output(*verb, o->output);
  add_columns(*verb, o->columns);
  add_threads(*verb, *common);
  add_common(*verb, *common, true);
  verb->callback(finishing(exit_with, common, [o, common](Diagnostics &diagnostics) {
    return run_reduce(*o, *common, diagnostics);
  }));
}

} // namespace umov::cli
