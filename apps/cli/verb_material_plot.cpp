// umov material plot: what a material is and does, as a page of figures.

#include "verb_material.h"

#include <fmt/format.h>
#include <umov/core/text.h>
#include <umov/jobs/material_page.h>

namespace umov::cli {
namespace {

struct PlotOptions {
  jobs::MaterialPageRequest page;
  std::string output;
  bool is_all = false;
};

Result<void> plot(const PlotOptions &o, const Common &common) {
  if (!o.output.ends_with(".html"))
    return fail(ErrorCode::Usage, "-o " + o.output + ": a name that ends in .html was expected");
  if (o.is_all == !o.page.names.empty())
    return fail(ErrorCode::Usage, "names of materials or --all, one of them, was expected");
  UMOV_ASSIGN(page, o.is_all ? jobs::material_gallery(o.page.wavelengths_nm)
                             : jobs::material_page(o.page));
  UMOV_TRY(put(o.output, page));
  if (!common.quiet)
    fmt::print("written to {}\n", printable(o.output));
  return {};
}

} // namespace

void add_plot(CLI::App &material, const Exit &exit_with) {
  auto *verb = material.add_subcommand(
      "plot", "Fresnel curves, Q against phase, n and k, lobes and colour ratio, as one HTML page");
  auto o = std::make_shared<PlotOptions>();
  auto common = std::make_shared<Common>();
  verb->add_option("material", o->page.names, "Names or TOML files");
  verb->add_flag("--all", o->is_all, "A gallery: one figure for each material of the library");
  verb->add_option("--wavelength", o->page.wavelengths_nm, "[nm], separated by commas")
      ->delimiter(',')
      ->check(CLI::Range(10.0, 1e6))
      ->capture_default_str();
  verb->add_option("--theta-i", o->page.theta_i_deg,
                   "Source from the normal, for lobes and colour [deg]")
      ->check(CLI::Range(0.0, 89.0))
      ->capture_default_str();
  verb->add_option("-o,--output", o->output, "HTML file")->required();
  add_common(*verb, *common, false);
  verb->callback(finishing(exit_with, [o, common] { return plot(*o, *common); }));
}

} // namespace umov::cli
