// umov material check --explicit: the statistical model against a ray-traced surface.

#include "job_console.h"
#include "tables.h"
#include "verb_material.h"

namespace umov::cli {

std::shared_ptr<ExplicitOptions> add_explicit_options(CLI::App &verb) {
  auto o = std::make_shared<ExplicitOptions>();
  verb.add_flag("--explicit", o->is_wanted,
                "Instead: a ray-traced rough surface (F = 1) against the model of its slopes");
  verb.add_option("--slope", o->request.slope, "--explicit: rms slope along an axis")
      ->check(CLI::Range(0.01, 2.0))
      ->capture_default_str();
  verb.add_option("--hurst", o->request.hurst,
                  "--explicit: Hurst exponent of a fractal surface; 0: one scale")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
  verb.add_option("--theta", o->request.theta_deg,
                  "--explicit: incidences [deg], separated by commas")
      ->delimiter(',')
      ->check(CLI::Range(0.0, 89.0));
  verb.add_option("--cells", o->request.cells, "--explicit: cells per side, two triangles each")
      ->check(CLI::Range(64, 2048))
      ->capture_default_str();
  verb.add_option("--realisations", o->request.realisations, "--explicit: random surfaces")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  verb.add_option("--rays", o->request.rays, "--explicit: rays per surface and incidence")
      ->check(CLI::Range(1000, 1'000'000'000))
      ->capture_default_str();
  return o;
}

Result<void> check_explicit(const ExplicitOptions &o, const std::string &output,
                            const Common &common) {
  UMOV_TRY(check_output(output));
  watch_interrupts();
  JobConsole console(common);
  UMOV_ASSIGN(table, jobs::rough_surface_table(o.request, static_cast<unsigned>(common.threads),
                                               console.monitor(false)));
  return put_table(output, table, common);
}

} // namespace umov::cli
