// The rows of a search for passes.

#include "jobs/columns.h"
#include "jobs/pass_models.h"
#include <umov/jobs/passes.h>

#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <type_traits>
#include <umov/core/text.h>
#include <umov/observation/epochs.h>
#include <umov/photometry/radiometry.h>

namespace umov::jobs {
namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();

/// What the age of elements costs along the track, roughly: 1 km at the epoch and 2 km per day in
/// low orbits (docs/theory/sgp4.md, Limits), a tenth of that above 2,000 km, where drag is not what
/// errs.
double along_track_error_km(const Trajectory &orbit, Epoch<Utc> time) {
  const ElementSet *set = orbit.elements();
  if (set == nullptr)
    return none;
  const bool is_low = set->mean_motion > 2 * pi / 127; // a period of 127 min: 2,000 km
  return 1 + (is_low ? 2 : 0.2) * std::abs(orbit.element_age_days(time));
}

/// The first crossing of a pass into or out of the shadow; "" if there is none.
std::string shadow_time(const SitePass &pass, bool is_entry) {
  for (const ShadowCrossing &crossing : pass.shadow)
    if (crossing.is_entry == is_entry)
      return to_iso(crossing.time);
  return "";
}

using E = const Trajectory &;
using P = const SitePass &;
using L = const PassBrightness &;

/// Columns of a value for each pass.
class PassColumns {
public:
  explicit PassColumns(const PassesResult &result) : result_(result) {}

  template <class Take> void text(const char *name, const char *description, Take take) {
    table.add(name, "", description, values<std::string>(take));
  }
  template <class Take>
  void number(const char *name, const char *unit, const char *description, Take take) {
    table.add(name, unit, description, values<double>(take));
  }
  void add_names();
  void add_way();
  void add_light();
  void add_circumstances();

  Table table;

private:
  template <class Value, class Take> std::vector<Value> values(Take take) const {
    std::vector<Value> out;
    for (const ObjectPass &one : result_.found)
      if constexpr (std::is_invocable_v<Take, L>)
        out.push_back(take(one.light));
      else
        out.push_back(take(result_.orbits[one.object], one.pass));
    return out;
  }
  const PassesResult &result_;
};

void PassColumns::add_names() {
  text("name", "as in the file", [](E e, P) { return e.name(); });
  table.add("norad_cat_id", "", "catalogue number",
            values<std::int64_t>([](E e, P) { return e.norad_cat_id(); }));
  text("pass_id", "number and time of culmination, of the whole pass",
       [](E e, P p) { return pass_id(e, p.whole_culmination); });
}

void PassColumns::add_way() {
  text("rise_utc", "crosses the altitude going up; empty: it is up when the span begins",
       [](E, P p) { return p.is_rise_cut ? std::string() : to_iso(p.rise.time); });
  text("culmination_utc",
       "highest point of the whole pass, beyond the span's ends too; within them of what hardly "
       "moves",
       [](E, P p) { return to_iso(p.culmination.time); });
  text("set_utc", "crosses the altitude going down; empty: it is up when the span ends",
       [](E, P p) { return p.is_set_cut ? std::string() : to_iso(p.set.time); });
  number("rise_az", "deg", "azimuth from north through east",
         [](E, P p) { return p.rise.azimuth.degrees(); });
  number("culmination_alt", "deg", "altitude, geometric",
         [](E, P p) { return p.culmination.altitude.degrees(); });
  number("culmination_az", "deg", "azimuth",
         [](E, P p) { return p.culmination.azimuth.degrees(); });
  number("set_az", "deg", "azimuth", [](E, P p) { return p.set.azimuth.degrees(); });
}

void PassColumns::add_light() {
  text("shadow_entry_utc", "half of the Sun's disk is gone; empty: not during the pass",
       [](E, P p) { return shadow_time(p, true); });
  text("shadow_exit_utc", "half of the Sun's disk is back; empty: not during the pass",
       [](E, P p) { return shadow_time(p, false); });
  number("sunlit_share", "", "of the time between rise and set",
         [](E, P p) { return std::round(p.sunlit_share * 1e9) / 1e9; }); // no .9999999999999999
  number("visible", "s", "sunlit, with the site's Sun below --sun-alt-max-deg",
         [](E, P p) { return p.visible_s; });
  number("visible_alt", "deg", "highest while visible; empty: never",
         [](E, P p) { return p.visible_s > 0 ? p.visible_altitude_max.degrees() : none; });
  number("range_min", "km", "smallest distance from the site, within the span",
         [](E, P p) { return p.range_min_km; });
  number("phase_min", "deg", "smallest phase angle while sunlit",
         [](E, P p) { return p.sunlit_share > 0 ? p.phase_min.degrees() : none; });
  number("phase_max", "deg", "largest phase angle while sunlit",
         [](E, P p) { return p.sunlit_share > 0 ? p.phase_max.degrees() : none; });
  const std::string system = name_of(result_.magnitudes);
  const std::string unit = magnitude_unit(system);
  number("mag_min", unit.c_str(), "brightest while sunlit; empty where no model is given",
         [](L l) { return l.magnitude_min; });
  text("brightest_utc", "when it is brightest, above the air; empty where no model is given",
       [](L l) { return l.brightest ? to_iso(*l.brightest) : std::string(); });
  number("mag_max", unit.c_str(),
         fmt::format("faintest while sunlit; {:g} stands for fainter", faintest_magnitude).c_str(),
         [](L l) { return l.magnitude_max; });
  table.add("mag_max_limit", "", "mag_max is a limit: at times it is fainter",
            values<bool>([](L l) { return l.has_limit; }));
  if (result_.has_air) {
    number("mag_obs_min", unit.c_str(), "brightest while sunlit, behind the air",
           [](L l) { return l.magnitude_obs_min; });
    number("mag_obs_max", unit.c_str(), "faintest while sunlit, behind the air; a limit as mag_max",
           [](L l) { return l.magnitude_obs_max; });
  }
  number("p_max", "", "largest degree of linear polarization while sunlit",
         [](L l) { return l.p_max; });
  text("glints", "times of glints, joined by semicolons", [](L l) {
    std::string out;
    for (const PassGlint &glint : l.glints)
      out += (out.empty() ? "" : ";") + to_iso(glint.time);
    return out;
  });
  text("glint_widths", "how long each lasts [s]", [](L l) {
    std::string out;
    for (const PassGlint &glint : l.glints)
      out += fmt::format("{}{:.3f}", out.empty() ? "" : ";", glint.width_s);
    return out;
  });
}

void PassColumns::add_circumstances() {
  number("sun_alt", "deg", "altitude of the Sun at culmination, airless",
         [](E, P p) { return p.culmination.sun_altitude.degrees(); });
  text("twilight", "at culmination: day, civil, nautical, astronomical or night",
       [](E, P p) { return std::string(twilight(p.culmination.sun_altitude)); });
  number("elset_age", "d", "culmination less epoch of the elements",
         [](E e, P p) { return e.element_age_days(p.culmination.time); });
  number("track_error", "km", "expected along the track from that age: see the note",
         [](E e, P p) { return along_track_error_km(e, p.culmination.time); });
}

} // namespace

Table passes_table(const PassesRequest &request, const PassesResult &result) {
  PassColumns columns(result);
  columns.add_names();
  columns.add_way();
  columns.add_light();
  columns.add_circumstances();
  Table out = std::move(columns.table);
  const Site &site = request.site;
  out.note("model", result.model);
  if (result.model != PassModels::unknown)
    out.note("magnitudes", how_magnitudes_are_sampled);
  out.note("track_error",
           "roughly 1 km and 2 km per day of age below 2,000 km, 0.2 km per day above");
  out.note("site",
           fmt::format("{}latitude {} deg, longitude {} deg, altitude {:g} m",
                       site.name.empty() ? "" : site.name + ", ", degrees_text(site.latitude),
                       degrees_text(site.longitude), site.altitude_m));
  out.note("altitude_min", fmt::format("{:g} deg, geometric", request.altitude_min.degrees()));
  return out;
}

} // namespace umov::jobs
