#include "console.h"
#include "finishing.h"
#include "tables.h"
#include "verbs.h"

#include <umov/io/scenario.h>
#include <umov/jobs/brdf.h>

namespace umov::cli {
namespace {

struct BrdfOptions {
  std::string material, batch, output;
  jobs::BrdfGeometry one;
  bool terms = false;
};

Result<void> run_brdf(const BrdfOptions &o, const Common &common) {
  UMOV_TRY(check_output(o.output));
  UMOV_ASSIGN(material, read_material(o.material));
  jobs::BrdfRequest request{material, {o.one}, o.terms, o.batch};
  if (!o.batch.empty()) {
    UMOV_ASSIGN(rows, jobs::read_brdf_geometries(o.batch, o.one.azimuth_deg));
    request.rows = std::move(rows);
  }
  UMOV_ASSIGN(table, jobs::brdf_table(request));
  return put_table(o.output, table, common);
}

} // namespace

void add_brdf(CLI::App &app, const Exit &exit_with) {
  auto *verb = app.add_subcommand("brdf", "Mueller BRDF [1/sr] of a material");
  auto o = std::make_shared<BrdfOptions>();
  auto common = std::make_shared<Common>();
  verb->add_option("material", o->material,
                   "Name of a material, or a TOML file with one [material.NAME] table")
      ->required();
  const std::vector<CLI::Option *> single{
      verb->add_option("--wavelength", o->one.wavelength_nm, "[nm]")->capture_default_str(),
      verb->add_option("--theta-i", o->one.theta_i_deg, "Source from the normal [deg]"),
      verb->add_option("--theta-o", o->one.theta_o_deg, "Observer from the normal [deg]"),
      verb->add_option("--phi", o->one.phi_deg,
                       "Azimuth of the observer minus that of the source [deg]: 0 = same side")};
  verb->add_option(
      "--azimuth", o->one.azimuth_deg,
      "Azimuth of the source from the direction field of an anisotropic surface [deg]");
  auto *batch = verb->add_option(
      "--batch", o->batch, "CSV with columns wavelength_nm, theta_i_deg, theta_o_deg, phi_deg");
  for (CLI::Option *option : single)
    batch->excludes(option);
  verb->add_flag("--terms", o->terms, "Add the parts of m00");
  add_table_output(*verb, o->output);
  add_common(*verb, *common, true);
  verb->callback(finishing(exit_with, [o, common] { return run_brdf(*o, *common); }));
}

} // namespace umov::cli
