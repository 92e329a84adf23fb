#include "console.h"
#include "finishing.h"
#include "tables.h"
#include "verbs.h"

#include <umov/core/files.h>
#include <umov/jobs/calibrate.h>

namespace umov::cli {
namespace {

struct CalibrateOptions {
  std::string counts, standards, output;
};

Result<void> run_calibrate(const CalibrateOptions &o, Diagnostics &diagnostics) {
  constexpr std::size_t largest = 1u << 31;
  UMOV_ASSIGN(text, read_file(o.counts, largest));
  UMOV_ASSIGN(counts, read_counts_text(text, o.counts, diagnostics));
  UMOV_ASSIGN(stars, read_file(o.standards));
  UMOV_ASSIGN(standards, read_standards_text(stars, o.standards));
  UMOV_ASSIGN(found, of_file(jobs::calibrate(counts, standards, diagnostics), o.counts));
  return put(o.output, calibration_as_toml(found));
}

} // namespace

void add_calibrate(CLI::App &app, const Exit &exit_with) {
  auto *verb = app.add_subcommand(
      "calibrate", "Efficiency, angle and own polarization of an instrument from standard stars");
  auto o = std::make_shared<CalibrateOptions>();
  auto common = std::make_shared<Common>();
  verb->add_option("counts", o->counts, "Counts of the standards, their names in the column name")
      ->required();
  verb->add_option("--standards", o->standards,
                   "Table of name, p_percent and pa_deg; p_err_percent and pa_err_deg where known")
      ->required();
  verb->add_option("-o,--output", o->output, "TOML file for umov reduce --calibration");
  add_common(*verb, *common, false);
  verb->callback(finishing(
      exit_with, common, [=](Diagnostics &diagnostics) { return run_calibrate(*o, diagnostics); }));
}

} // namespace umov::cli
