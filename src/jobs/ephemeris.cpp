#include <umov/jobs/ephemeris.h>

#include "jobs/columns.h"

#include <algorithm>
#include <fmt/format.h>
#include <umov/core/files.h>
#include <umov/core/parallel.h>
#include <umov/core/text.h>
#include <umov/io/trajectory_file.h>
#include <umov/observation/epochs.h>
#include <umov/time/earth_orientation.h>

namespace umov::jobs {
namespace {

/// Rows up to the first that is missing.
struct Observed {
  std::vector<ObservingGeometry> rows;
  std::optional<Error> stopped;
};

Observed observe_all(const EphemerisRequest &request, const Trajectory &orbit,
                     const std::vector<Epoch<Utc>> &times, unsigned threads,
                     const Monitor &monitor) {
  std::vector<OrbitState> states(times.size());
  const std::size_t count = orbit.at(times, states); // the rows before the first gap are good
  std::vector<char> is_done(count);
  Observed out;
  out.rows.resize(count);
  parallel_for(count, threads, [&](std::size_t i) {
    if (monitor.is_cancelled())
      return;
    out.rows[i] = observe(states[i], times[i], request.site, request.shadow);
    is_done[i] = 1;
  });
  const auto kept =
      static_cast<std::size_t>(std::find(is_done.begin(), is_done.end(), 0) - is_done.begin());
  out.rows.resize(kept);
  if (kept < count)
    out.stopped = Error{
        ErrorCode::Interrupted,
        fmt::format("stopped by the user after {} of {}", kept, counted(times.size(), "epoch")),
        {}};
  else if (count < times.size())
    out.stopped = orbit.at(times[count]).error();
  return out;
}

Table ephemeris_table(const std::vector<ObservingGeometry> &rows, ShadowModel shadow) {
  using G = const ObservingGeometry &;
  Table t;
  std::vector<std::string> times;
  times.reserve(rows.size());
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
  std::vector<Vec3<Teme>> teme;
  teme.reserve(rows.size());
  for (G row : rows)
    teme.push_back(teme_state(row.state, row.time).position_km);
  const auto add_teme = [&](const char *name, double Vec3<Teme>::*axis) {
    add_numbers(t, teme, name, "km", "position, TEME",
                [axis](const Vec3<Teme> &position) { return position.*axis; });
  };
  add_teme("teme_x", &Vec3<Teme>::x);
  add_teme("teme_y", &Vec3<Teme>::y);
  add_teme("teme_z", &Vec3<Teme>::z);
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

} // namespace

Result<TableOutcome> ephemeris(const EphemerisRequest &request, const JobOptions &options,
                               const Monitor &monitor, Diagnostics &diagnostics) {
  UMOV_ASSIGN(text, read_file(request.orbit));
  UMOV_ASSIGN(orbit, read_trajectory(text, request.orbit,
                                     {request.norad, request.start, request.stop,
                                      options.allow_bad_checksum, request.keep_going,
                                      options.allow_old_elements},
                                     diagnostics));
  UMOV_ASSIGN(times, time_grid({request.start, request.stop, request.step_s}));
  Observed seen = observe_all(request, orbit, times, options.threads, monitor);
  if (!seen.rows.empty()) {
    warn_if_beyond_leap_seconds(seen.rows.back().time, diagnostics);
    warn_if_outside_eop(seen.rows.front().time, seen.rows.back().time, diagnostics);
  }
  return TableOutcome{ephemeris_table(seen.rows, request.shadow), seen.stopped.has_value(),
                      std::move(seen.stopped)};
}

} // namespace umov::jobs
