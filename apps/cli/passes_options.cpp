#include "passes_options.h"

#include "tables.h"

namespace umov::cli {
namespace {

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

} // namespace

void add_passes_options(CLI::App &verb, PassesOptions &o, Common &common) {
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
  verb.add_option("--mag-max", o.magnitude_max,
                  "Only passes that get as bright as this magnitude while sunlit; needs --scene or "
                  "--model. Looked at 5 s apart and in glints: a briefer flash is missed")
      ->check(CLI::Range(-50.0, 100.0));
  verb.add_option("--sort", o.order,
                  "First is the earliest (rise), the brightest (mag), or what stands highest while "
                  "visible (alt)")
      ->check(CLI::IsMember({"rise", "mag", "alt"}))
      ->capture_default_str();
  verb.add_option("--shadow", o.shadow, "The Earth that casts the shadow")
      ->check(CLI::IsMember({"ellipsoid", "sphere"}))
      ->capture_default_str();
  verb.add_flag("--keep-going", o.keep_going, "Report bad sets and keep the others");
  add_elements(verb, o.elements);
  add_pass_model(verb, o);
  verb.add_option("--chart", o.chart, "Sky chart of the passes, with a table (HTML)");
  add_part(verb, o.part, "objects");
  add_table_output(verb, o.output);
  add_columns(verb, o.columns);
  add_threads(verb, common);
  add_common(verb, common, true);
}

Result<jobs::PassesRequest> request_of(const PassesOptions &o, const Common &common) {
  jobs::PassesRequest out;
  UMOV_TRY(check_page("--chart", o.chart));
  UMOV_ASSIGN(site, site_of(o.site, common));
  UMOV_TRY(take_earth_orientation(o.site));
  UMOV_ASSIGN(start, time_of("--start", o.start));
  UMOV_ASSIGN(stop, time_of("--stop", o.stop));
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
  out.magnitude_max = o.magnitude_max;
  out.order = o.order == "mag"   ? jobs::PassOrder::Magnitude
              : o.order == "alt" ? jobs::PassOrder::Altitude
                                 : jobs::PassOrder::Rise;
  out.keep_going = o.keep_going;
  out.model = std::move(model);
  return out;
}

} // namespace umov::cli
