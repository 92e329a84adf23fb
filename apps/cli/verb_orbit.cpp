// umov orbit ephemeris, umov orbit propagate: where objects stand.

#include "doubtful_elements.h"
#include "finishing.h"
#include "job_console.h"
#include "site_options.h"
#include "tables.h"
#include "verbs.h"

#include <umov/jobs/ephemeris.h>

namespace umov::cli {
namespace {

struct OrbitOptions {
  std::string orbit, output, start, stop, shadow = "ellipsoid";
  SiteOptions site;
  std::vector<std::string> at;
  int norad = 0;
  double step_s = 60;
  bool keep_going = false;
  DoubtfulElements elements;
};

void add_file_options(CLI::App &verb, OrbitOptions &o) {
  verb.add_option("--orbit", o.orbit, "TLE, 3LE or OMM (KVN, XML, JSON, CSV) file")->required();
  add_elements(verb, o.elements);
  verb.add_flag("--keep-going", o.keep_going, "Report bad sets and keep the others");
  add_table_output(verb, o.output);
}

Result<void> put_outcome(const OrbitOptions &o, const jobs::TableOutcome &out,
                         const Common &common) {
  if (out.is_partial)
    return tl::unexpected(stop_table(o.output, out.table, common, *out.error));
  UMOV_TRY(put_table(o.output, out.table, common));
  if (out.error)
    return tl::unexpected(*out.error);
  return {};
}

Result<void> run_ephemeris(const OrbitOptions &o, const Common &common, Diagnostics &diagnostics) {
  UMOV_TRY(check_output(o.output));
  UMOV_ASSIGN(site, site_of(o.site, common));
  UMOV_TRY(take_earth_orientation(o.site));
  UMOV_ASSIGN(start, time_of("--start", o.start));
  UMOV_ASSIGN(stop, time_of("--stop", o.stop));
  const ShadowModel shadow = o.shadow == "sphere" ? ShadowModel::Sphere : ShadowModel::Ellipsoid;
  JobConsole console(common);
  UMOV_ASSIGN(out,
              jobs::ephemeris({o.orbit, o.norad, site, start, stop, o.step_s, shadow, o.keep_going},
                              with_elements(job_options(common), o.elements), console.monitor(true),
                              diagnostics));
  return put_outcome(o, out, common);
}

Result<void> run_propagate(const OrbitOptions &o, const Common &common, Diagnostics &diagnostics) {
  UMOV_TRY(check_output(o.output));
  jobs::StatesRequest request{o.orbit, {}, o.keep_going};
  for (const std::string &text : o.at) {
    UMOV_ASSIGN(time, time_of("--at", text));
    request.times.push_back(time);
  }
  JobConsole console(common);
  UMOV_ASSIGN(out, jobs::catalogue_states(request, with_elements(job_options(common), o.elements),
                                          console.monitor(true), diagnostics));
  return put_outcome(o, out, common);
}

using Run = Result<void> (*)(const OrbitOptions &, const Common &, Diagnostics &);

/// The options of all, and what happens when the verb is called.
void finish(CLI::App &verb, std::shared_ptr<OrbitOptions> o, Run run, const Exit &exit_with) {
  auto common = std::make_shared<Common>();
  add_threads(verb, *common);
  add_common(verb, *common, true);
  verb.callback(stoppable(exit_with, common, [o, common, run](Diagnostics &diagnostics) {
    return run(*o, *common, diagnostics);
  }));
}

void add_ephemeris(CLI::App &orbit, const Exit &exit_with) {
  auto *verb = orbit.add_subcommand("ephemeris", "Where an object stands as seen from a site");
  auto o = std::make_shared<OrbitOptions>();
  add_file_options(*verb, *o);
  verb->add_option("--norad", o->norad, "Catalogue number, where the file holds several objects");
  add_site(*verb, o->site);
  verb->add_option("--start", o->start, "First epoch, such as 2018-01-21T04:00:00Z")->required();
  verb->add_option("--stop", o->stop, "Last epoch, included")->required();
  verb->add_option("--step-s", o->step_s, "Step [s]")->capture_default_str();
  verb->add_option("--shadow", o->shadow, "The Earth that casts the shadow")
      ->check(CLI::IsMember({"ellipsoid", "sphere"}))
      ->capture_default_str();
  finish(*verb, o, run_ephemeris, exit_with);
}

void add_propagate(CLI::App &orbit, const Exit &exit_with) {
  auto *verb = orbit.add_subcommand("propagate", "TEME states of every object of a catalogue");
  auto o = std::make_shared<OrbitOptions>();
  add_file_options(*verb, *o);
  verb->add_option("--at", o->at, "Epochs, separated by commas")->required()->delimiter(',');
  finish(*verb, o, run_propagate, exit_with);
}

} // namespace

void add_orbit(CLI::App &app, const Exit &exit_with) {
  auto *orbit = app.add_subcommand("orbit", "Orbits: ephemerides and catalogues");
  orbit->require_subcommand(1);
  add_ephemeris(*orbit, exit_with);
  add_propagate(*orbit, exit_with);
  add_orbit_show(*orbit, exit_with);
  add_orbit_convert(*orbit, exit_with);
}

} // namespace umov::cli
