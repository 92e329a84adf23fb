// umov passes: when the objects of a file pass over a site.

#include "job_console.h"
#include "part_options.h"
#include "scale_job.h"
#include "site_options.h"
#include "tables.h"
#include "verbs.h"

#include <umov/jobs/ranged_job.h>

namespace umov::cli {
namespace {

struct PassesOptions {
  SiteOptions site;
  std::string orbit, output, start, stop, shadow = "ellipsoid", chart;
  std::string scene, body, material, band;
  std::vector<std::string> overrides, columns;
  std::vector<int> norad;
  double size_m = 1, altitude_min_deg = 10, sun_altitude_max_deg = -6;
  bool is_visible_only = false, allow_bad_checksum = false, keep_going = false,
       allow_old_elements = false;
  PartOptions part;
};

Result<jobs::PassModel> model_of(const PassesOptions &o) {
  using Body = jobs::PassModel::Body;
  jobs::PassModel out;
  out.body = o.body == "sphere" ? Body::Sphere : o.body == "cube" ? Body::Cube : Body::None;
  out.size_m = o.size_m;
  out.material = o.material;
  out.band = o.band;
  if (!o.scene.empty()) {
    UMOV_ASSIGN(scene, read_scenario(o.scene, o.overrides));
    out.scene = std::move(scene);
  }
  return out;
}

Result<jobs::PassesRequest> request_of(const PassesOptions &o, const Common &common) {
  jobs::PassesRequest out;
  UMOV_ASSIGN(site, site_of(o.site, common));
  UMOV_TRY(take_earth_orientation(o.site));
  UMOV_ASSIGN(start, time_of(o.start));
  UMOV_ASSIGN(stop, time_of(o.stop));
  UMOV_ASSIGN(model, model_of(o));
  out.orbit = o.orbit;
  out.norad = o.norad;
  out.site = site;
  out.start = start;
  out.stop = stop;
  out.altitude_min = Angle::degrees(o.altitude_min_deg);
  out.sun_altitude_max = Angle::degrees(o.sun_altitude_max_deg);
  out.shadow = o.shadow == "sphere" ? ShadowModel::Sphere : ShadowModel::Ellipsoid;
  out.is_visible_only = o.is_visible_only;
  out.keep_going = o.keep_going;
  out.model = std::move(model);
  return out;
}

Result<void> run_passes(const PassesOptions &o, const Common &common, Diagnostics &diagnostics) {
  UMOV_TRY(check_output(o.output));
  UMOV_ASSIGN(request, request_of(o, common));
  jobs::JobOptions options = job_options(common);
  UMOV_ASSIGN(part, part_of(o.part));
  options.part = part;
  options.allow_bad_checksum = o.allow_bad_checksum;
  options.allow_old_elements = o.allow_old_elements;
  JobConsole console(common, tracing_masks);
  UMOV_ASSIGN(result, jobs::passes(request, options, console.monitor(true), diagnostics));
  Table table = jobs::passes_table(request, result);
  if (result.stopped)
    return tl::unexpected(stop_table(o.output, std::move(table), common, *result.stopped));
  if (!o.chart.empty())
    UMOV_TRY(put(o.chart, jobs::sky_chart(request, result)));
  UMOV_ASSIGN(shown, chosen_columns(table, o.columns,
                                    {"name", "rise_utc", "culmination_utc", "set_utc",
                                     "culmination_alt", "culmination_az", "phase_min", "mag_min",
                                     "p_max", "sunlit_share", "visible"},
                                    o.output, common));
  return put_table(o.output, shown, common);
}

void add_pass_model(CLI::App &verb, PassesOptions &o) {
  auto *scene =
      verb.add_option("--scene", o.scene,
                      "Scenario whose objects give mesh, materials, attitude and bands: by "
                      "their norad, and one without orbit for all others");
  verb.add_option("--set", o.overrides, "KEY=VALUE over a key of the scenario")->needs(scene);
  auto *body =
      verb.add_option("--model", o.body, "Every object as a sphere, or a cube in nadir attitude")
          ->check(CLI::IsMember({"sphere", "cube"}));
  body->excludes(scene);
  verb.add_option("--size-m", o.size_m, "Of --model: radius, or edge [m]")
      ->check(CLI::Range(1e-3, 1e3))
      ->capture_default_str()
      ->needs(body);
  verb.add_option("--material", o.material, "Of --model: a name or a file; see umov material list")
      ->needs(body);
  verb.add_option("--band", o.band, "Band of the magnitudes; default: the middle one");
}

void declare(CLI::App &verb, PassesOptions &o, Common &common) {
  verb.add_option("--orbit", o.orbit, "TLE, 3LE, OMM, OEM or OPM file")->required();
  verb.add_option("--norad", o.norad, "Catalogue numbers, separated by commas; else all")
      ->delimiter(',');
  add_site(verb, o.site);
  verb.add_option("--start", o.start, "Begin, such as 2018-01-21T04:00:00Z")->required();
  verb.add_option("--stop", o.stop, "End")->required();
  verb.add_option("--alt-min-deg", o.altitude_min_deg, "Rise and set are at this altitude")
      ->check(CLI::Range(-90.0, 90.0))
      ->capture_default_str();
  verb.add_option("--sun-alt-max-deg", o.sun_altitude_max_deg,
                  "The sky is dark with the Sun below this altitude")
      ->check(CLI::Range(-90.0, 90.0))
      ->capture_default_str();
  verb.add_flag("--visible", o.is_visible_only, "Only passes sunlit in a dark sky for some time");
  verb.add_option("--shadow", o.shadow, "The Earth that casts the shadow")
      ->check(CLI::IsMember({"ellipsoid", "sphere"}))
      ->capture_default_str();
  verb.add_flag("--allow-bad-checksum", o.allow_bad_checksum, "Read lines with a wrong checksum");
  verb.add_flag("--keep-going", o.keep_going, "Report bad sets and keep the others");
  verb.add_flag("--allow-old-elements", o.allow_old_elements, "Take elements over 30 days old");
  add_pass_model(verb, o);
  verb.add_option("--chart", o.chart, "Sky chart of the passes, with a table (HTML)");
  add_part(verb, o.part, "objects");
  add_table_output(verb, o.output);
  add_columns(verb, o.columns);
  add_threads(verb, common);
  add_common(verb, common, true);
}

jobs::JobOptions options_of(const PassesOptions &o, jobs::JobOptions options) {
  options.allow_bad_checksum = o.allow_bad_checksum;
  options.allow_old_elements = o.allow_old_elements;
  return options;
}

} // namespace

Result<RangedVerb> passes_in_parts(const std::vector<std::string> &arguments,
                                   const PartsSetting &setting, Diagnostics &diagnostics) {
  CLI::App verb("When objects pass over a site", "passes");
  PassesOptions o;
  Common common;
  declare(verb, o, common);
  UMOV_TRY(parse_verb(verb, arguments));
  UMOV_TRY(refuse_output(o.output, o.part));
  UMOV_ASSIGN(request, request_of(o, common));
  UMOV_ASSIGN(job, jobs::ranged_passes(request, options_of(o, setting.options), diagnostics));
  return RangedVerb{std::move(job), o.site.earth_orientation};
}

void add_passes(CLI::App &app, const Exit &exit_with) {
  auto *verb = app.add_subcommand("passes", "When objects pass over a site, and in which light");
  auto o = std::make_shared<PassesOptions>();
  auto common = std::make_shared<Common>();
  declare(*verb, *o, *common);
  verb->callback([=] {
    watch_interrupts();
    Diagnostics diagnostics;
    const auto done = run_passes(*o, *common, diagnostics);
    report(diagnostics, *common);
    exit_with(done ? 0 : report(done.error()));
  });
}

} // namespace umov::cli
