#include "console.h"
#include "finishing.h"
#include "tables.h"
#include "verbs.h"

#include <fmt/format.h>
#include <memory>
#include <umov/jobs/band_tables.h>

namespace umov::cli {
namespace {

struct BandOptions {
  std::string name, unit, detector, output;
};

Result<void> list_bands(const std::string &output, const Common &common) {
  UMOV_ASSIGN(table, jobs::band_list());
  return put_table(output, table, common);
}

Result<void> show_band(const BandOptions &o, const Common &common) {
  UMOV_TRY(check_output(o.output));
  PassbandForm form{o.unit, {}};
  if (!o.detector.empty())
    form.detector = o.detector == "energy" ? DetectorKind::Energy : DetectorKind::Photon;
  UMOV_ASSIGN(band, jobs::band_named(o.name, form));
  if (!common.json && o.output.empty()) {
    UMOV_ASSIGN(text, jobs::band_text(band));
    fmt::print("{}\n", text);
  }
  UMOV_ASSIGN(table, jobs::band_table(band));
  return put_table(o.output, table, common);
}

void add_band_list(CLI::App &bands, const Exit &exit_with) {
  auto *verb = bands.add_subcommand("list", "Curves that umov knows, with their zero points");
  auto common = std::make_shared<Common>();
  auto output = std::make_shared<std::string>();
  add_table_output(*verb, *output);
  add_common(*verb, *common, true);
  verb->callback(finishing(exit_with, [common, output] { return list_bands(*output, *common); }));
}

void add_band_show(CLI::App &bands, const Exit &exit_with) {
  auto *verb =
      bands.add_subcommand("show", "One band: its numbers, and the curve as photons count");
  auto o = std::make_shared<BandOptions>();
  auto common = std::make_shared<Common>();
  verb->add_option("band", o->name, "As a scenario spells it: Bessell.V, nm:550, file:x.vot")
      ->required();
  verb->add_option("--unit", o->unit, "Of the wavelengths of a file that does not say")
      ->check(CLI::IsMember({"nm", "um", "Angstrom"}));
  verb->add_option("--detector", o->detector, "What the curve of a file multiplies")
      ->check(CLI::IsMember({"photon", "energy"}));
  add_table_output(*verb, o->output);
  add_common(*verb, *common, true);
  verb->callback(finishing(exit_with, [o, common] { return show_band(*o, *common); }));
}

} // namespace

void add_bands(CLI::App &app, const Exit &exit_with) {
  auto *bands = app.add_subcommand("bands", "Bands: curves of filters and their zero points");
  bands->require_subcommand(1);
  add_band_list(*bands, exit_with);
  add_band_show(*bands, exit_with);
}

} // namespace umov::cli
