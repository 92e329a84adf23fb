#include "console.h"
#include "verbs.h"

#include "tables.h"
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <optional>
#include <umov/core/files.h>
#include <umov/core/parallel.h>
#include <umov/core/text.h>
#include <umov/io/elements_file.h>
#include <umov/io/trajectory_file.h>
#include <umov/lightcurve/compute.h>
#include <umov/orbit/elements.h>
#include <umov/orbit/ephemeris.h>

namespace umov::cli {
namespace {

struct OrbitOptions {
  std::string orbit, output, start, stop, shadow = "ellipsoid";
  std::vector<std::string> at;
  int norad = 0;
  double latitude_deg = 0, longitude_deg = 0, altitude_m = 0, step_s = 60;
  bool allow_bad_checksum = false, keep_going = false, allow_old_elements = false;
};

void add_file_options(CLI::App &verb, OrbitOptions &o) {
  verb.add_option("--orbit", o.orbit, "TLE, 3LE or OMM (KVN, XML, JSON, CSV) file")->required();
  verb.add_flag("--allow-bad-checksum", o.allow_bad_checksum, "Read lines with a wrong checksum");
  verb.add_flag("--keep-going", o.keep_going, "Report bad sets and keep the others");
  add_table_output(verb, o.output);
}

Result<std::vector<ElementSet>> read_sets(const OrbitOptions &o, Diagnostics &diagnostics) {
  UMOV_ASSIGN(text, read_file(o.orbit));
  return read_elements(text, o.orbit, {o.allow_bad_checksum, o.keep_going}, diagnostics);
}

Error stopped_by_user(std::size_t done, std::size_t all, const char *what) {
  return {ErrorCode::Interrupted,
          fmt::format("stopped by the user after {} of {}", done, counted(all, what)),
          {}};
}

struct EphemerisRows {
  std::vector<ObservingGeometry> rows;
  std::optional<Error> stopped;
};

Result<EphemerisRows> compute_ephemeris(const OrbitOptions &o, const Trajectory &orbit,
                                        const Common &common) {
  UMOV_ASSIGN(site, make_site("", o.latitude_deg, o.longitude_deg, o.altitude_m));
  UMOV_ASSIGN(start, utc_from_iso(o.start));
  UMOV_ASSIGN(stop, utc_from_iso(o.stop));
  UMOV_ASSIGN(times, time_grid({start, stop, o.step_s}));
  const ShadowModel shadow = o.shadow == "sphere" ? ShadowModel::Sphere : ShadowModel::Ellipsoid;
  std::vector<TemeState> states(times.size());
  const std::size_t count = orbit.at(times, states); // the rows before the first gap are good
  std::vector<char> is_done(count);
  EphemerisRows out;
  out.rows.resize(count);
  parallel_for(count, static_cast<unsigned>(common.threads), [&](std::size_t i) {
    if (interrupted())
      return;
    out.rows[i] = observe(states[i], times[i], site, shadow);
    is_done[i] = 1;
  });
  const auto kept =
      static_cast<std::size_t>(std::find(is_done.begin(), is_done.end(), 0) - is_done.begin());
  out.rows.resize(kept);
  if (kept < count)
    out.stopped = stopped_by_user(kept, times.size(), "epoch");
  else if (count < times.size())
    out.stopped = orbit.at(times[count]).error();
  return out;
}

/// One column of numbers taken from each row.
template <class Rows, class Take>
void add_numbers(Table &table, const Rows &rows, const char *name, const char *unit,
                 const char *description, Take take) {
  std::vector<double> values;
  values.reserve(rows.size());
  for (const auto &row : rows)
    values.push_back(take(row));
  table.add(name, unit, description, std::move(values));
}

Table ephemeris_table(const std::vector<ObservingGeometry> &rows, ShadowModel shadow) {
  using G = const ObservingGeometry &;
  Table t;
  std::vector<std::string> times;
  for (G row : rows)
    times.push_back(to_iso(row.time));
  t.add("time_utc", "", "UTC", std::move(times));
  const auto add = [&](const char *name, const char *unit, const char *text, auto take) {
    add_numbers(t, rows, name, unit, text, take);
  };
  add("az", "deg", "azimuth from north through east, geometric",
      [](G g) { return g.azimuth.degrees(); });
  add("alt", "deg", "altitude, geometric", [](G g) { return g.altitude.degrees(); });
  add("range", "km", "distance from the site", [](G g) { return g.range_km; });
  add("itrs_x", "km", "position, ITRS", [](G g) { return g.itrs_km.x; });
  add("itrs_y", "km", "position, ITRS", [](G g) { return g.itrs_km.y; });
  add("itrs_z", "km", "position, ITRS", [](G g) { return g.itrs_km.z; });
  add("itrs_vx", "km / s", "velocity, ITRS", [](G g) { return g.itrs_velocity_km_s.x; });
  add("itrs_vy", "km / s", "velocity, ITRS", [](G g) { return g.itrs_velocity_km_s.y; });
  add("itrs_vz", "km / s", "velocity, ITRS", [](G g) { return g.itrs_velocity_km_s.z; });
  add("teme_x", "km", "position, TEME", [](G g) { return g.teme.position_km.x; });
  add("teme_y", "km", "position, TEME", [](G g) { return g.teme.position_km.y; });
  add("teme_z", "km", "position, TEME", [](G g) { return g.teme.position_km.z; });
  add("sun_az", "deg", "azimuth of the Sun", [](G g) { return g.sun_azimuth.degrees(); });
  add("sun_alt", "deg", "altitude of the Sun, airless",
      [](G g) { return g.sun_altitude.degrees(); });
  add("phase_angle", "deg", "Sun-object-observer, 0 = full",
      [](G g) { return g.phase_angle.degrees(); });
  add("sunlit", "",
      shadow == ShadowModel::Sphere ? "visible part of the Sun's disk, spherical Earth"
                                    : "visible part of the Sun's disk, WGS 84 ellipsoid",
      [](G g) { return g.sunlit; });
  return t;
}

int run_ephemeris(const OrbitOptions &o, const Common &common) {
  Diagnostics diagnostics;
  const auto done = [&]() -> Result<std::optional<Error>> {
    UMOV_TRY(check_output(o.output));
    UMOV_ASSIGN(text, read_file(o.orbit));
    UMOV_ASSIGN(start, utc_from_iso(o.start));
    UMOV_ASSIGN(stop, utc_from_iso(o.stop));
    UMOV_ASSIGN(orbit, read_trajectory(text, o.orbit,
                                       {o.norad, start, stop, o.allow_bad_checksum, o.keep_going,
                                        o.allow_old_elements},
                                       diagnostics));
    UMOV_ASSIGN(rows, compute_ephemeris(o, orbit, common));
    const ShadowModel shadow = o.shadow == "sphere" ? ShadowModel::Sphere : ShadowModel::Ellipsoid;
    Table table = ephemeris_table(rows.rows, shadow);
    if (rows.stopped)
      rows.stopped = put_partial_table(o.output, std::move(table), common, *rows.stopped);
    else
      UMOV_TRY(put_table(o.output, table, common));
    if (!rows.rows.empty()) {
      warn_if_beyond_leap_seconds(rows.rows.back().time, diagnostics);
      warn_if_outside_eop(rows.rows.front().time, rows.rows.back().time, diagnostics);
    }
    return rows.stopped;
  }();
  report(diagnostics, common);
  if (!done)
    return report(done.error());
  return *done ? report(**done) : 0;
}

struct CatalogueRow {
  bool is_done = false; ///< not where a stop came first
  int norad_cat_id = 0;
  Epoch<Utc> time{};
  Sgp4Code code = Sgp4Code::Ok;
  TemeState state;
};

Table catalogue_table(const std::vector<CatalogueRow> &rows) {
  using R = const CatalogueRow &;
  Table t;
  std::vector<std::int64_t> ids, codes;
  std::vector<std::string> times;
  for (R row : rows) {
    ids.push_back(row.norad_cat_id);
    codes.push_back(static_cast<int>(row.code));
    times.push_back(to_iso(row.time));
  }
  t.add("norad_cat_id", "", "catalogue number", std::move(ids));
  t.add("time_utc", "", "UTC", std::move(times));
  t.add("error", "", "0, or the SGP4 code with which the object failed", std::move(codes));
  const auto add = [&](const char *name, const char *unit, const char *text, auto take) {
    add_numbers(t, rows, name, unit, text, [&](R row) {
      return row.code == Sgp4Code::Ok ? take(row.state) : std::numeric_limits<double>::quiet_NaN();
    });
  };
  using S = const TemeState &;
  add("teme_x", "km", "position, TEME", [](S s) { return s.position_km.x; });
  add("teme_y", "km", "position, TEME", [](S s) { return s.position_km.y; });
  add("teme_z", "km", "position, TEME", [](S s) { return s.position_km.z; });
  add("teme_vx", "km / s", "velocity, TEME", [](S s) { return s.velocity_km_s.x; });
  add("teme_vy", "km / s", "velocity, TEME", [](S s) { return s.velocity_km_s.y; });
  add("teme_vz", "km / s", "velocity, TEME", [](S s) { return s.velocity_km_s.z; });
  return t;
}

/// Objects by times, object by object; whole blocks of objects are missing after a stop.
std::vector<CatalogueRow> propagate_all(const std::vector<ElementSet> &sets,
                                        const std::vector<Epoch<Utc>> &times, unsigned threads) {
  std::vector<CatalogueRow> rows(sets.size() * times.size());
  constexpr std::size_t block = 256; // objects side by side in lanes
  parallel_for((sets.size() + block - 1) / block, threads, [&](std::size_t b) {
    const std::size_t first = b * block, count = std::min(block, sets.size() - first);
    std::vector<Sgp4> models;
    for (std::size_t i = 0; i < count; ++i)
      models.emplace_back(sets[first + i]);
    std::vector<double> minutes(count);
    std::vector<TemeState> states(count);
    std::vector<Sgp4Code> codes(count);
    for (std::size_t k = 0; k < times.size() && !interrupted(); ++k) {
      for (std::size_t i = 0; i < count; ++i)
        minutes[i] = clock_days_between(times[k], sets[first + i].epoch) * 1440;
      propagate_objects(models, minutes, states, codes);
      for (std::size_t i = 0; i < count; ++i) {
        const bool can_start = models[i].init_code() == Sgp4Code::Ok;
        rows[(first + i) * times.size() + k] = {true, sets[first + i].norad_cat_id, times[k],
                                                can_start ? codes[i] : models[i].init_code(),
                                                can_start ? states[i] : TemeState{}};
      }
    }
  });
  return rows;
}

/// A catalogue has many ages: one line for all that are too old to trust, and a refusal only where
/// none is better.
Result<void> check_ages(const OrbitOptions &o, const std::vector<ElementSet> &sets,
                        const std::vector<Epoch<Utc>> &times, Diagnostics &diagnostics) {
  std::size_t doubtful = 0, old = 0;
  const ElementSet *oldest = nullptr;
  double age_max = 0;
  for (const ElementSet &set : sets) {
    double age = 0;
    for (const Epoch<Utc> time : times)
      age = std::max(age, std::abs(clock_days_between(time, set.epoch)));
    doubtful += age > 7 ? 1u : 0u;
    old += age > 30 ? 1u : 0u;
    if (age > age_max) {
      age_max = age;
      oldest = &set;
    }
  }
  if (doubtful == 0)
    return {};
  const std::string worst =
      fmt::format("the farthest are those of {}, {:.1f} d", oldest->norad_cat_id, age_max);
  if (old == sets.size() && !o.allow_old_elements)
    return fail(ErrorCode::BadInput,
                fmt::format("all elements are more than 30 d from the epochs asked for ({}). Give "
                            "newer ones or pass --allow-old-elements.",
                            worst),
                {o.orbit, oldest->line});
  diagnostics.warn(
      fmt::format("{} of {} element sets lie more than 7 d from the epochs asked for ({}); expect "
                  "kilometres of error along the track",
                  doubtful, sets.size(), worst),
      {o.orbit, oldest->line});
  return {};
}

int run_propagate(const OrbitOptions &o, const Common &common) {
  Diagnostics diagnostics;
  const auto done = [&]() -> Result<void> {
    UMOV_TRY(check_output(o.output));
    UMOV_ASSIGN(sets, read_sets(o, diagnostics));
    std::vector<Epoch<Utc>> times;
    for (const std::string &text : o.at) {
      UMOV_ASSIGN(time, utc_from_iso(text));
      times.push_back(time);
    }
    UMOV_TRY(check_ages(o, sets, times, diagnostics));
    for (const Epoch<Utc> time : times)
      warn_if_beyond_leap_seconds(time, diagnostics);
    auto rows = propagate_all(sets, times, static_cast<unsigned>(common.threads));
    const std::size_t all = rows.size();
    std::erase_if(rows, [](const CatalogueRow &row) { return !row.is_done; });
    std::size_t failed = 0;
    for (const CatalogueRow &row : rows)
      if (row.code != Sgp4Code::Ok && failed++ < 10)
        diagnostics.warn(fmt::format("{}: SGP4 fails at {} (code {}, {})", row.norad_cat_id,
                                     to_iso(row.time), static_cast<int>(row.code),
                                     to_text(row.code)));
    if (failed > 10)
      diagnostics.warn(fmt::format("{} more states failed; see the column error", failed - 10));
    if (rows.size() < all)
      return tl::unexpected(put_partial_table(o.output, catalogue_table(rows), common,
                                              stopped_by_user(rows.size(), all, "state")));
    UMOV_TRY(put_table(o.output, catalogue_table(rows), common));
    if (failed == rows.size())
      return fail(ErrorCode::Physics, "SGP4 failed for every object; give newer elements",
                  {o.orbit});
    return {};
  }();
  report(diagnostics, common);
  return done ? 0 : report(done.error());
}

void add_ephemeris(CLI::App &orbit, const Exit &exit_with) {
  auto *verb = orbit.add_subcommand("ephemeris", "Where an object stands as seen from a site");
  auto o = std::make_shared<OrbitOptions>();
  auto common = std::make_shared<Common>();
  add_file_options(*verb, *o);
  verb->add_option("--norad", o->norad, "Catalogue number, where the file holds several objects");
  verb->add_option("--lat-deg", o->latitude_deg, "Geodetic latitude, north positive")->required();
  verb->add_option("--lon-deg", o->longitude_deg, "Longitude, east positive")->required();
  verb->add_option("--alt-m", o->altitude_m, "Height above the WGS 84 ellipsoid")->required();
  verb->add_option("--start", o->start, "First epoch, such as 2018-01-21T04:00:00Z")->required();
  verb->add_option("--stop", o->stop, "Last epoch, included")->required();
  verb->add_option("--step-s", o->step_s, "Step [s]")->capture_default_str();
  verb->add_option("--shadow", o->shadow, "The Earth that casts the shadow")
      ->check(CLI::IsMember({"ellipsoid", "sphere"}))
      ->capture_default_str();
  verb->add_flag("--allow-old-elements", o->allow_old_elements, "Take elements over 30 days old");
  add_threads(*verb, *common);
  add_common(*verb, *common, true);
  verb->callback([o, common, exit_with] {
    watch_interrupts();
    exit_with(run_ephemeris(*o, *common));
  });
}

void add_propagate(CLI::App &orbit, const Exit &exit_with) {
  auto *verb = orbit.add_subcommand("propagate", "TEME states of every object of a catalogue");
  auto o = std::make_shared<OrbitOptions>();
  auto common = std::make_shared<Common>();
  add_file_options(*verb, *o);
  verb->add_option("--at", o->at, "Epochs, separated by commas")->required()->delimiter(',');
  verb->add_flag("--allow-old-elements", o->allow_old_elements, "Take elements over 30 days old");
  add_threads(*verb, *common);
  add_common(*verb, *common, true);
  verb->callback([o, common, exit_with] {
    watch_interrupts();
    exit_with(run_propagate(*o, *common));
  });
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
