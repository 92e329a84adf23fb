// umov identify: which object of a library made a light curve.

#include "verb_invert.h"

#include <umov/jobs/identify.h>

namespace umov::cli {

void add_identify(CLI::App &app, const Exit &exit_with) {
  auto *verb = app.add_subcommand(
      "identify", "Which object of a library made a light curve, in whatever attitude, or none");
  auto o = std::make_shared<InvertVerb>();
  auto asked = std::make_shared<jobs::IdentifyRequest>();
  add_invert_options(*verb, o);
  verb->get_option("--scenario")->description("Orbit, site and bands; its mesh is not read");
  verb->add_option("--library", asked->library, "Folder of umov library build")->required();
  verb->add_option("--objects", asked->objects,
                   "Scenarios of objects of the library: the best are judged by their own light");
  verb->add_option("--none-prior", asked->none_prior,
                   "Chance, before any data, that it is none of the library")
      ->check(CLI::Range(1e-6, 0.999))
      ->capture_default_str();
  run_invert(*verb, o, exit_with,
             [asked](const Scenario &scenario, const InvertVerb &options,
                     const jobs::Monitor &monitor, Diagnostics &diagnostics) {
               asked->observed = options.request;
               return jobs::identify_object(scenario, *asked, job_options(options.common), monitor,
                                            diagnostics);
             });
}

} // namespace umov::cli
