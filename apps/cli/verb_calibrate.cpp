#include "console.h"
#include "finishing.h"
#include "tables.h"
#include "verbs.h"

#include <fmt/ranges.h>
#include <umov/core/files.h>
#include <umov/jobs/calibrate.h>

namespace umov::cli {
namespace {

struct CalibrateOptions {
  std::string counts, standards, output;
  bool has_second_order = false, is_polarizer = false;
};

constexpr std::size_t largest = 1u << 31;

Result<void> run_polarizer(const CalibrateOptions &o, const Common &common,
                           Diagnostics &diagnostics) {
  UMOV_TRY(check_output(o.output));
  UMOV_ASSIGN(text, read_file(o.counts, largest));
  UMOV_ASSIGN(counts, read_polarizer_text(text, o.counts));
  UMOV_ASSIGN(table, of_file(jobs::calibrate_channels(counts, diagnostics), o.counts));
  UMOV_ASSIGN(shown, chosen_columns(table, {},
                                    {"channel", "w0", "w1", "w2", "efficiency", "efficiency_err",
                                     "analyser_deg", "analyser_err", "chi2", "dof"},
                                    o.output, common));
  return put_table(o.output, shown, common);
}

Result<void> run_calibrate(const CalibrateOptions &o, const Common &common,
                           Diagnostics &diagnostics) {
  UMOV_TRY(check_apart({o.counts, o.standards}, {o.output}));
  if (o.is_polarizer)
    return run_polarizer(o, common, diagnostics);
  if (common.json)
    return fail(ErrorCode::Usage, "--json is of --polarizer; standards give a TOML file");
  if (o.standards.empty())
    return fail(ErrorCode::Usage, "--standards is required, or --polarizer for counts behind a "
                                  "polarizer that was turned");
  UMOV_ASSIGN(text, read_file(o.counts, largest));
  UMOV_ASSIGN(counts, read_counts_text(text, o.counts, diagnostics));
  UMOV_ASSIGN(stars, standards_text(o.standards));
  UMOV_ASSIGN(standards, read_standards_text(stars, o.standards));
  UMOV_ASSIGN(found, of_file(jobs::calibrate(counts, standards, o.has_second_order, diagnostics),
                             o.counts));
  return put(o.output, calibration_as_toml(found));
}

} // namespace

void add_calibrate(CLI::App &app, const Exit &exit_with) {
  auto *verb = app.add_subcommand(
      "calibrate",
      "Efficiency, angle and own polarization of an instrument, zero point and extinction, from "
      "standard stars; or what its channels take, from a polarizer that is turned before it");
  auto o = std::make_shared<CalibrateOptions>();
  auto common = std::make_shared<Common>();
  verb->add_option("counts", o->counts,
                   "Counts of the standards, their names in the column name; or of the polarizer")
      ->required();
  verb->add_option(
      "--standards", o->standards,
      fmt::format("Table of name, p_percent and pa_deg (p_err_percent and pa_err_deg where "
                  "known), or mag (and colour), or all of them; or one that comes with umov: {}",
                  fmt::join(standards_names(), ", ")));
  verb->add_flag("--polarizer", o->is_polarizer,
                 "The table has angle_deg, counts and channel (and variance): a lamp behind a "
                 "polarizer that is turned")
      ->excludes("--standards");
  verb->add_flag("--second-order", o->has_second_order,
                 "Also k'', the extinction's change with colour: of stars of many colours at many "
                 "air masses")
      ->excludes("--polarizer");
  verb->add_option("-o,--output", o->output,
                   "TOML file for umov reduce --calibration; a table with --polarizer");
  add_common(*verb, *common, true);
  verb->callback(finishing(exit_with, common, [=](Diagnostics &diagnostics) {
    return run_calibrate(*o, *common, diagnostics);
  }));
}

} // namespace umov::cli
