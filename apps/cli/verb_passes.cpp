// umov passes: when the objects of a file pass over a site.

#include "console.h"
#include "verbs.h"

#include "pass_models.h"
#include "tables.h"
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <mutex>
#include <optional>
#include <umov/core/files.h>
#include <umov/core/parallel.h>
#include <umov/core/text.h>
#include <umov/io/elements_file.h>
#include <umov/io/plot_page.h>
#include <umov/io/sites.h>
#include <umov/io/trajectory_file.h>
#include <umov/orbit/passes.h>
#include <umov/orbit/select.h>

namespace umov::cli {
namespace {

struct PassesOptions {
  std::string orbit, output, site, start, stop, shadow = "ellipsoid";
  PassModelOptions model;
  std::string chart;
  std::vector<int> norad;
  double latitude_deg = 0, longitude_deg = 0, altitude_m = 0, altitude_min_deg = 10,
         sun_altitude_max_deg = -6;
  bool is_visible_only = false, allow_bad_checksum = false, keep_going = false,
       allow_old_elements = false;
};

Result<Site> site_of(const PassesOptions &o) {
  return o.site.empty() ? make_site("", o.latitude_deg, o.longitude_deg, o.altitude_m)
                        : site_from(o.site);
}

/// The set of each object to use for a span.
Result<std::vector<Trajectory>> choose(const PassesOptions &o, const std::vector<ElementSet> &sets,
                                       Epoch<Utc> start, Epoch<Utc> stop,
                                       Diagnostics &diagnostics) {
  std::vector<int> wanted = o.norad;
  if (wanted.empty())
    for (const ElementSet &set : sets)
      wanted.push_back(set.norad_cat_id);
  std::sort(wanted.begin(), wanted.end());
  wanted.erase(std::unique(wanted.begin(), wanted.end()), wanted.end());
  std::vector<ElementSet> sorted = sets; // by number, so that each object is chosen from its own
  std::vector<Trajectory> out;
  std::stable_sort(sorted.begin(), sorted.end(), [](const ElementSet &a, const ElementSet &b) {
    return a.norad_cat_id < b.norad_cat_id;
  });
  std::size_t doubtful = 0, old = 0;
  for (const int norad : wanted) {
    const auto [first, last] =
        std::equal_range(sorted.begin(), sorted.end(), norad, [](const auto &a, const auto &b) {
          const auto number = [](const auto &x) {
            if constexpr (std::is_same_v<std::decay_t<decltype(x)>, int>)
              return x;
            else
              return x.norad_cat_id;
          };
          return number(a) < number(b);
        });
    UMOV_ASSIGN(set, choose_elements({first, last}, norad, start, o.orbit));
    const double age = std::max(std::abs(clock_days_between(start, set.epoch)),
                                std::abs(clock_days_between(stop, set.epoch)));
    doubtful += age > 7 ? 1u : 0u;
    if (age > 30 && !o.allow_old_elements)
      ++old;
    else
      out.emplace_back(set);
  }
  if (out.empty())
    return fail(ErrorCode::BadInput,
                "all elements are more than 30 d from the span. Give newer ones or pass "
                "--allow-old-elements.",
                {o.orbit});
  if (old > 0)
    diagnostics.warn(fmt::format("{} with elements more than 30 d from the span are left out; "
                                 "--allow-old-elements takes them",
                                 counted(old, "object")),
                     {o.orbit});
  if (doubtful > old)
    diagnostics.warn(fmt::format("elements of {} are more than 7 d from the span; passes may be "
                                 "seconds off",
                                 counted(doubtful - old, "object")),
                     {o.orbit});
  return out;
}

Result<std::vector<Trajectory>> read_orbits(const PassesOptions &o, const std::string &text,
                                            Epoch<Utc> start, Epoch<Utc> stop,
                                            Diagnostics &diagnostics) {
  if (!ccsds::is_message(text)) {
    UMOV_ASSIGN(sets,
                read_elements(text, o.orbit, {o.allow_bad_checksum, o.keep_going}, diagnostics));
    return choose(o, sets, start, stop, diagnostics);
  }
  TrajectoryRequest request;
  request.norad = o.norad.size() == 1 ? o.norad[0] : 0;
  request.first = start;
  request.last = stop;
  UMOV_ASSIGN(orbit, read_trajectory(text, o.orbit, request, diagnostics));
  return std::vector<Trajectory>{orbit};
}

struct FoundPass {
  std::size_t object = 0;
  SitePass pass;
};

std::string pass_id(const Trajectory &orbit, const SitePass &pass) {
  std::string time = to_iso(pass.culmination.time, 3).substr(0, 19) + "Z";
  std::erase_if(time, [](char c) { return c == '-' || c == ':'; });
  return orbit.id() + "-" + time;
}

/// What the age of elements costs along the track, roughly: 1 km at the epoch and 2 km per day in
/// low orbits (docs/theory/sgp4.md, Limits), a tenth of that above 2,000 km, where drag is not what
/// errs.
double along_track_error_km(const Trajectory &orbit, Epoch<Utc> time) {
  const ElementSet *set = orbit.elements();
  if (set == nullptr)
    return std::numeric_limits<double>::quiet_NaN();
  const bool is_low = set->mean_motion > 2 * pi / 127; // a period of 127 min: 2,000 km
  return 1 + (is_low ? 2 : 0.2) * std::abs(orbit.element_age_days(time));
}

Table passes_table(const std::vector<FoundPass> &found, const std::vector<Trajectory> &orbits) {
  Table t;
  const auto text = [&](const char *name, const char *description, auto take) {
    std::vector<std::string> values;
    for (const FoundPass &one : found)
      values.push_back(take(orbits[one.object], one.pass));
    t.add(name, "", description, std::move(values));
  };
  const auto number = [&](const char *name, const char *unit, const char *description, auto take) {
    std::vector<double> values;
    for (const FoundPass &one : found)
      values.push_back(take(orbits[one.object], one.pass));
    t.add(name, unit, description, std::move(values));
  };
  using E = const Trajectory &;
  using P = const SitePass &;
  const auto shadow = [](P pass, bool is_entry) -> std::string {
    for (const ShadowCrossing &crossing : pass.shadow)
      if (crossing.is_entry == is_entry)
        return to_iso(crossing.time);
    return "";
  };
  const double none = std::numeric_limits<double>::quiet_NaN();
  text("name", "as in the file", [](E e, P) { return e.name(); });
  std::vector<std::int64_t> numbers;
  for (const FoundPass &one : found)
    numbers.push_back(orbits[one.object].norad_cat_id());
  t.add("norad_cat_id", "", "catalogue number", std::move(numbers));
  text("pass_id", "number and time of culmination", pass_id);
  text("rise_utc", "crosses the altitude going up; empty: it is up when the span begins",
       [](E, P p) { return p.is_rise_cut ? std::string() : to_iso(p.rise.time); });
  text("culmination_utc", "highest point within the span",
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
  text("shadow_entry_utc", "half of the Sun's disk is gone; empty: not during the pass",
       [&](E, P p) { return shadow(p, true); });
  text("shadow_exit_utc", "half of the Sun's disk is back; empty: not during the pass",
       [&](E, P p) { return shadow(p, false); });
  number("sunlit_share", "", "of the time between rise and set",
         [](E, P p) { return p.sunlit_share; });
  number("visible", "s", "sunlit, with the site's Sun below --sun-alt-max-deg",
         [](E, P p) { return p.visible_s; });
  number("range_min", "km", "smallest distance from the site",
         [](E, P p) { return p.range_min_km; });
  number("phase_min", "deg", "smallest phase angle while sunlit",
         [&](E, P p) { return p.sunlit_share > 0 ? p.phase_min.degrees() : none; });
  number("phase_max", "deg", "largest phase angle while sunlit",
         [&](E, P p) { return p.sunlit_share > 0 ? p.phase_max.degrees() : none; });
  number("mag_min", "mag(AB)", "brightest while sunlit; empty where no model is given",
         [](E, P p) { return p.magnitude_min; });
  number("mag_max", "mag(AB)", "faintest while sunlit", [](E, P p) { return p.magnitude_max; });
  number("p_max", "", "largest degree of linear polarization while sunlit",
         [](E, P p) { return p.p_max; });
  text("glints", "times of glints, joined by semicolons", [](E, P p) {
    std::string out;
    for (const PassGlint &glint : p.glints)
      out += (out.empty() ? "" : ";") + to_iso(glint.time);
    return out;
  });
  text("glint_widths", "how long each lasts [s]", [](E, P p) {
    std::string out;
    for (const PassGlint &glint : p.glints)
      out += fmt::format("{}{:.3f}", out.empty() ? "" : ";", glint.width_s);
    return out;
  });
  number("sun_alt", "deg", "altitude of the Sun at culmination, airless",
         [](E, P p) { return p.culmination.sun_altitude.degrees(); });
  text("twilight", "at culmination: day, civil, nautical, astronomical or night",
       [](E, P p) { return std::string(twilight(p.culmination.sun_altitude)); });
  number("elset_age", "d", "culmination less epoch of the elements",
         [](E e, P p) { return e.element_age_days(p.culmination.time); });
  number("track_error", "km", "expected along the track from that age: see the note",
         [](E e, P p) { return along_track_error_km(e, p.culmination.time); });
  return t;
}

/// Tracks over the site's sky, sunlit parts full and shadowed ones dotted, times at both ends.
Result<std::string> sky_chart(const std::vector<FoundPass> &found,
                              const std::vector<Trajectory> &orbits, const Site &site) {
  constexpr std::size_t passes_max = 40; // more is a tangle
  PlotFigure figure{"Passes over the site", "", "", {}, false, true};
  for (std::size_t k = 0; k < std::min(found.size(), passes_max); ++k) {
    const SitePass &pass = found[k].pass;
    const Trajectory &orbit = orbits[found[k].object];
    PlotLine lit{pass_id(orbit, pass), {}, {}, k % 7, "solid", {}},
        dark{"in the shadow", {}, {}, k % 7, "dot", {}};
    constexpr int points = 120;
    const double length = seconds_between(pass.set.time, pass.rise.time);
    for (int i = 0; i <= points; ++i) {
      const Epoch<Utc> time = plus_seconds(pass.rise.time, length * i / points);
      const auto state = orbit.at(time);
      if (!state)
        continue;
      const ObservingGeometry g = observe(*state, time, site, ShadowModel::Ellipsoid);
      const bool is_end = i == 0 || i == points;
      for (PlotLine *line : {&lit, &dark}) {
        const bool is_on = (g.sunlit > 0.5) == (line == &lit);
        line->x.push_back(is_on ? g.azimuth.degrees() : std::nan(""));
        line->y.push_back(is_on ? g.altitude.degrees() : std::nan(""));
        line->labels.push_back(is_on && is_end ? to_iso(time).substr(11, 8) : "");
      }
    }
    const auto has_any = [](const PlotLine &line) {
      return std::any_of(line.x.begin(), line.x.end(), [](double x) { return !std::isnan(x); });
    };
    if (has_any(lit))
      figure.lines.push_back(lit);
    if (has_any(dark)) {
      dark.name = pass_id(orbit, pass) + (has_any(lit) ? ", in the shadow" : "");
      figure.lines.push_back(dark);
    }
  }
  std::vector<std::string> notes{
      "The sky overhead: zenith in the middle, north up, east left. Times are UTC.",
      "Dotted: more than half of the Sun's disk is behind the Earth."};
  if (found.size() > passes_max)
    notes.push_back(fmt::format("The first {} of {} passes are drawn.", passes_max, found.size()));
  return make_plot_page("Passes over " + (site.name.empty() ? "the site" : site.name), {figure},
                        notes);
}

struct Search {
  std::vector<FoundPass> found;
  std::size_t objects = 0, failed = 0; ///< searched, of which SGP4 failed
  bool is_stopped = false;
};

Search search_all(const PassesOptions &o, const std::vector<Trajectory> &orbits,
                  const PassModels &models, const Site &site, Epoch<Utc> start, Epoch<Utc> stop,
                  const Common &common, Diagnostics &diagnostics) {
  PassSearch wanted;
  wanted.altitude_min = Angle::degrees(o.altitude_min_deg);
  wanted.sun_altitude_max = Angle::degrees(o.sun_altitude_max_deg);
  wanted.shadow = o.shadow == "sphere" ? ShadowModel::Sphere : ShadowModel::Ellipsoid;
  std::vector<std::optional<Result<std::vector<SitePass>>>> results(orbits.size());
  ProgressBar bar("objects", common);
  std::mutex lock;
  std::size_t done = 0;
  parallel_for(orbits.size(), static_cast<unsigned>(common.threads), [&](std::size_t i) {
    if (interrupted())
      return;
    PassSearch search = wanted;
    if (const PassLight *light = models.of(orbits[i].norad_cat_id()))
      search.on_pass = [&, light](SitePass &pass, std::span<const ObservingGeometry> samples) {
        return light->describe(orbits[i], site, wanted.shadow, models.band(), samples, pass);
      };
    results[i] = find_passes(orbits[i], site, start, stop, search);
    const std::scoped_lock guard(lock);
    bar.update(++done, orbits.size());
  });
  Search out;
  for (std::size_t i = 0; i < orbits.size(); ++i) {
    if (!results[i]) {
      out.is_stopped = true;
      continue;
    }
    ++out.objects;
    if (!*results[i]) {
      if (out.failed++ < 10)
        diagnostics.warn(results[i]->error().message);
      continue;
    }
    for (SitePass &pass : **results[i])
      if (!o.is_visible_only || pass.visible_s > 0)
        out.found.push_back({i, std::move(pass)});
  }
  if (out.failed > 10)
    diagnostics.warn(fmt::format("{} more objects failed", out.failed - 10));
  std::stable_sort(out.found.begin(), out.found.end(), [](const FoundPass &a, const FoundPass &b) {
    return seconds_between(a.pass.rise.time, b.pass.rise.time) < 0;
  });
  return out;
}

Result<void> run_passes(const PassesOptions &o, const Common &common, Diagnostics &diagnostics) {
  UMOV_TRY(check_output(o.output));
  UMOV_ASSIGN(site, site_of(o));
  UMOV_ASSIGN(start, utc_from_iso(o.start));
  UMOV_ASSIGN(stop, utc_from_iso(o.stop));
  if (seconds_between(stop, start) < 0)
    return fail(ErrorCode::Usage, "--stop lies before --start");
  UMOV_ASSIGN(text, read_file(o.orbit));
  UMOV_ASSIGN(chosen, read_orbits(o, text, start, stop, diagnostics));
  warn_if_beyond_leap_seconds(stop, diagnostics);
  warn_if_outside_eop(start, stop, diagnostics);
  UMOV_ASSIGN(models, PassModels::make(o.model, diagnostics));
  const Search search = search_all(o, chosen, models, site, start, stop, common, diagnostics);
  Table table = passes_table(search.found, chosen);
  table.note("model", models.description());
  table.note("track_error",
             "roughly 1 km and 2 km per day of age below 2,000 km, 0.2 km per day above");
  table.note("site",
             fmt::format("{}latitude {} deg, longitude {} deg, altitude {:g} m",
                         site.name.empty() ? "" : site.name + ", ", degrees_text(site.latitude),
                         degrees_text(site.longitude), site.altitude_m));
  table.note("altitude_min", fmt::format("{:g} deg, geometric", o.altitude_min_deg));
  if (search.is_stopped)
    return tl::unexpected(put_partial_table(
        o.output, std::move(table), common,
        {ErrorCode::Interrupted,
         fmt::format("stopped by the user after {} of {} objects", search.objects, chosen.size()),
         {}}));
  if (search.failed == chosen.size())
    return fail(ErrorCode::Physics, "the orbit of every object ends within the span", {o.orbit});
  if (search.found.empty())
    return fail(ErrorCode::Nothing,
                fmt::format("no {}pass above {:g} deg in this span",
                            o.is_visible_only ? "visible " : "", o.altitude_min_deg));
  if (!o.chart.empty()) {
    UMOV_ASSIGN(page, sky_chart(search.found, chosen, site));
    UMOV_TRY(put(o.chart, page));
  }
  return put_table(o.output, table, common);
}

} // namespace

void add_passes(CLI::App &app, const Exit &exit_with) {
  auto *verb = app.add_subcommand("passes", "When objects pass over a site, and in which light");
  auto o = std::make_shared<PassesOptions>();
  auto common = std::make_shared<Common>();
  verb->add_option("--orbit", o->orbit, "TLE, 3LE, OMM, OEM or OPM file")->required();
  verb->add_option("--norad", o->norad, "Catalogue numbers, separated by commas; else all")
      ->delimiter(',');
  auto *site =
      verb->add_option("-s,--site", o->site,
                       "A known site such as maui or paranal, or latitude,longitude,altitude: deg "
                       "north, deg east, m");
  auto *latitude =
      verb->add_option("--lat-deg", o->latitude_deg, "Geodetic latitude, north positive");
  auto *longitude = verb->add_option("--lon-deg", o->longitude_deg, "Longitude, east positive");
  auto *altitude = verb->add_option("--alt-m", o->altitude_m, "Height above the WGS 84 ellipsoid");
  for (auto *one : {latitude, longitude, altitude})
    one->excludes(site);
  verb->add_option("--start", o->start, "Begin, such as 2018-01-21T04:00:00Z")->required();
  verb->add_option("--stop", o->stop, "End")->required();
  verb->add_option("--alt-min-deg", o->altitude_min_deg, "Rise and set are at this altitude")
      ->check(CLI::Range(-90.0, 90.0))
      ->capture_default_str();
  verb->add_option("--sun-alt-max-deg", o->sun_altitude_max_deg,
                   "The sky is dark with the Sun below this altitude")
      ->check(CLI::Range(-90.0, 90.0))
      ->capture_default_str();
  verb->add_flag("--visible", o->is_visible_only, "Only passes sunlit in a dark sky for some time");
  verb->add_option("--shadow", o->shadow, "The Earth that casts the shadow")
      ->check(CLI::IsMember({"ellipsoid", "sphere"}))
      ->capture_default_str();
  verb->add_flag("--allow-bad-checksum", o->allow_bad_checksum, "Read lines with a wrong checksum");
  verb->add_flag("--keep-going", o->keep_going, "Report bad sets and keep the others");
  verb->add_flag("--allow-old-elements", o->allow_old_elements, "Take elements over 30 days old");
  add_pass_model(*verb, o->model);
  verb->add_option("--chart", o->chart, "Sky chart of the passes (HTML)");
  verb->add_option("-o,--output", o->output, "Table: .csv, .ecsv, .fits or .json by its suffix");
  add_threads(*verb, *common);
  add_common(*verb, *common, true);
  verb->callback([=] {
    if (site->count() == 0 &&
        (latitude->count() == 0 || longitude->count() == 0 || altitude->count() == 0)) {
      exit_with(report(
          Error{ErrorCode::Usage,
                "where? Give --site NAME or LAT,LON,ALT, or --lat-deg, --lon-deg and --alt-m",
                {}}));
      return;
    }
    watch_interrupts();
    Diagnostics diagnostics;
    const auto done = run_passes(*o, *common, diagnostics);
    report(diagnostics, *common);
    exit_with(done ? 0 : report(done.error()));
  });
}

} // namespace umov::cli
