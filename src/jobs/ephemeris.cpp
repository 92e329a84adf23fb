#include <umov/jobs/ephemeris.h>

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <optional>
#include <umov/core/files.h>
#include <umov/core/parallel.h>
#include <umov/core/text.h>
#include <umov/io/trajectory_file.h>
#include <umov/jobs/index_range.h>
#include <umov/observation/epochs.h>
#include <umov/time/earth_orientation.h>

namespace umov::jobs {
namespace {

/// Rows of a stretch of the grid up to the first that is missing, and why it is.
struct Observed {
  std::vector<ObservingGeometry> rows;
  std::optional<Error> stopped;
};

/// Epochs that are observed between two looks at whoever may want to stop.
constexpr std::size_t block = 8192;

/// `wanted` of the epochs of the grid.
Observed observe_block(const EphemerisRequest &request, const Trajectory &orbit,
                       const EpochSpan &span, IndexRange wanted, unsigned threads) {
  std::vector<Epoch<Utc>> times(wanted.count);
  for (std::size_t i = 0; i < times.size(); ++i)
    times[i] = epoch_of(span, wanted.first + i);
  std::vector<OrbitState> states(times.size());
  const std::size_t count = orbit.at(times, states); // the rows before the first gap are good
  Observed out;
  out.rows.resize(count);
  constexpr std::size_t at_once = 256;
  parallel_for((count + at_once - 1) / at_once, threads, [&](std::size_t part) {
    for (std::size_t i = part * at_once; i < std::min(count, (part + 1) * at_once); ++i)
      out.rows[i] = observe(states[i], times[i], request.site, request.shadow);
  });
  if (count < times.size())
    out.stopped = orbit.at(times[count]).error();
  return out;
}

/// A column of numbers: what it is called, and what it takes of a row.
struct NumberColumn {
  const char *name, *unit, *text;
  double (*take)(const ObservingGeometry &row, const Vec3<Teme> &teme_km);
};

using Row = const ObservingGeometry &;
using Teme3 = const Vec3<Teme> &;
constexpr NumberColumn number_columns[] = {
    {"az", "deg", "azimuth from north through east, geometric",
     [](Row g, Teme3) { return g.azimuth.degrees(); }},
    {"alt", "deg", "altitude, geometric", [](Row g, Teme3) { return g.altitude.degrees(); }},
    {"range", "km", "distance from the site", [](Row g, Teme3) { return g.range_km; }},
    {"itrs_x", "km", "position, ITRS", [](Row g, Teme3) { return g.itrs_km.x; }},
    {"itrs_y", "km", "position, ITRS", [](Row g, Teme3) { return g.itrs_km.y; }},
    {"itrs_z", "km", "position, ITRS", [](Row g, Teme3) { return g.itrs_km.z; }},
    {"itrs_vx", "km / s", "velocity, ITRS", [](Row g, Teme3) { return g.itrs_velocity_km_s.x; }},
    {"itrs_vy", "km / s", "velocity, ITRS", [](Row g, Teme3) { return g.itrs_velocity_km_s.y; }},
    {"itrs_vz", "km / s", "velocity, ITRS", [](Row g, Teme3) { return g.itrs_velocity_km_s.z; }},
    {"teme_x", "km", "position, TEME", [](Row, Teme3 teme) { return teme.x; }},
    {"teme_y", "km", "position, TEME", [](Row, Teme3 teme) { return teme.y; }},
    {"teme_z", "km", "position, TEME", [](Row, Teme3 teme) { return teme.z; }},
    {"sun_az", "deg", "azimuth of the Sun", [](Row g, Teme3) { return g.sun_azimuth.degrees(); }},
    {"sun_alt", "deg", "altitude of the Sun, airless",
     [](Row g, Teme3) { return g.sun_altitude.degrees(); }},
    {"phase_angle", "deg", "Sun-object-observer, 0 = full",
     [](Row g, Teme3) { return g.phase_angle.degrees(); }},
    {"sunlit", "", "", [](Row g, Teme3) { return g.sunlit; }},
};

/// The table as it grows, with room for all rows: to move millions of them takes longer than
/// whoever wants to stop may have to wait.
class EphemerisColumns {
public:
  explicit EphemerisColumns(std::size_t rows) {
    times_.reserve(rows);
    for (auto &column : numbers_)
      column.reserve(rows);
  }
  [[nodiscard]] std::size_t rows() const { return times_.size(); }
  void add(const std::vector<ObservingGeometry> &rows) {
    for (Row row : rows) {
      times_.push_back(to_iso(row.time));
      const Vec3<Teme> teme = teme_state(row.state, row.time).position_km;
      for (std::size_t c = 0; c < numbers_.size(); ++c)
        numbers_[c].push_back(number_columns[c].take(row, teme));
    }
  }
  [[nodiscard]] Table table(ShadowModel shadow) && {
    Table out;
    out.add("time_utc", "", "UTC", std::move(times_));
    for (std::size_t c = 0; c < numbers_.size(); ++c) {
      const NumberColumn &of = number_columns[c];
      const char *sunlit = shadow == ShadowModel::Sphere
                               ? "visible part of the Sun's disk, spherical Earth"
                               : "visible part of the Sun's disk, WGS 84 ellipsoid";
      out.add(of.name, of.unit, *of.text != 0 ? of.text : sunlit, std::move(numbers_[c]));
    }
    return out;
  }

private:
  std::vector<std::string> times_;
  std::array<std::vector<double>, std::size(number_columns)> numbers_;
};

} // namespace

Result<TableOutcome> ephemeris(const EphemerisRequest &request, const JobOptions &options,
                               const Monitor &monitor, Diagnostics &diagnostics) {
  UMOV_ASSIGN(text, read_file(request.orbit));
  UMOV_ASSIGN(orbit, read_trajectory(text, request.orbit,
                                     {request.norad, request.start, request.stop,
                                      options.allow_bad_checksum, request.keep_going,
                                      options.allow_old_elements},
                                     diagnostics));
  const EpochSpan span{request.start, request.stop, request.step_s};
  UMOV_ASSIGN(count, epoch_count(span));
  EphemerisColumns columns(count);
  TableOutcome out;
  std::optional<Epoch<Utc>> first, last;
  for (std::size_t done = 0; done < count && !out.error; done = columns.rows()) {
    if (monitor.is_cancelled()) {
      out.error =
          Error{ErrorCode::Interrupted,
                fmt::format("stopped by the user after {} of {}", done, counted(count, "epoch")),
                {}};
      break;
    }
    Observed seen =
        observe_block(request, orbit, span, {done, std::min(block, count - done)}, options.threads);
    if (!seen.rows.empty()) {
      first = first.value_or(seen.rows.front().time);
      last = seen.rows.back().time;
    }
    columns.add(seen.rows);
    out.error = std::move(seen.stopped);
    monitor.advance("epochs", columns.rows(), count);
  }
  if (first) {
    warn_if_beyond_leap_seconds(*last, diagnostics);
    warn_if_outside_eop(*first, *last, diagnostics);
  }
  out.table = std::move(columns).table(request.shadow);
  out.is_partial = out.error.has_value();
  return out;
}

} // namespace umov::jobs
