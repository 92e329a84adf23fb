// umov identify: which object of a library made a light curve.

#include "invert_each.h"

namespace umov::cli {

EachJob identify_options(CLI::App &verb, const std::shared_ptr<InvertVerb> &o,
                         const std::shared_ptr<jobs::IdentifyRequest> &asked, EachOptions &each) {
  add_invert_options(verb, o);
  add_each(verb, each);
  verb.get_option("--scenario")->description("Orbit, site and bands; its mesh is not read");
  verb.add_option("--library", asked->library, "Folder of umov library build")->required();
  verb.add_option("--objects", asked->objects,
                  "Scenarios of objects of the library: the best are judged by their own light");
  verb.add_option("--none-prior", asked->none_prior,
                  "Chance, before any data, that it is none of the library")
      ->check(CLI::Range(1e-6, 0.999))
      ->capture_default_str();
  return [asked](const Scenario &scenario, const InvertVerb &given, const jobs::JobOptions &options,
                 const jobs::Monitor &monitor, Diagnostics &diagnostics) {
    asked->observed = given.request;
    return jobs::ranged_identities(scenario, *asked, options, monitor, diagnostics);
  };
}

void add_identify(CLI::App &app, const Exit &exit_with) {
  auto *verb = app.add_subcommand(
      "identify", "Which object of a library made a light curve, in whatever attitude, or none");
  auto o = std::make_shared<InvertVerb>();
  auto asked = std::make_shared<jobs::IdentifyRequest>();
  auto each = std::make_shared<EachOptions>();
  const EachJob many = identify_options(*verb, o, asked, *each);
  run_invert_or_each(
      *verb, o, each, exit_with,
      [asked](const Scenario &scenario, const InvertVerb &options, const jobs::Monitor &monitor,
              Diagnostics &diagnostics) {
        asked->observed = options.request;
        return jobs::identify_object(scenario, *asked, job_options(options.common), monitor,
                                     diagnostics);
      },
      many);
}

} // namespace umov::cli
