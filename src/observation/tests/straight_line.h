#pragma once
// A track whose geometry can be had with a ruler: to and fro over a site, in straight lines.

#include <cmath>
#include <umov/observation/epochs.h>

namespace umov::cases {

/// Latitude and longitude 0: east is +y, north +z, up +x of ITRS.
inline const Site origin_site = make_site("origin", 0, 0, 0).value();

/// 1000 km above the site's plane and 500 km north of it, eastwards at 10 km/s from 3000 km in the
/// west and back again; culminations at 300 s and 900 s, the end at 1200 s.
struct StraightLine {
  static constexpr double height_km = 1000, north_km = 500, reach_km = 3000, speed_km_s = 10;

  explicit StraightLine(const std::string &utc) : start(utc_from_iso(utc).value()) {}

  [[nodiscard]] static double east_km(double seconds) {
    return seconds <= 600 ? -reach_km + speed_km_s * seconds
                          : reach_km - speed_km_s * (seconds - 600);
  }
  [[nodiscard]] static double altitude_rad(double seconds) {
    return std::atan2(height_km, std::hypot(east_km(seconds), north_km));
  }
  [[nodiscard]] Trajectory trajectory() const {
    EphemerisSegment segment;
    segment.frame = OrbitFrame::Itrs;
    segment.interpolation = Interpolation::Linear;
    segment.degree = 1;
    segment.first = start;
    segment.last = plus_seconds(start, 1200);
    for (const double s : {0.0, 600.0, 1200.0})
      segment.states.push_back({plus_seconds(start, s),
                                {6378.137 + height_km, east_km(s), north_km},
                                {0, s < 600 ? speed_km_s : -speed_km_s, 0}});
    OrbitEphemeris out{"line", "2018-001A", 7, {segment}};
    return Trajectory(out);
  }
  /// What of the first leg lies between two times, at most 600 s after the start.
  [[nodiscard]] EphemerisSegment segment(double from_s, double to_s) const {
    EphemerisSegment out;
    out.frame = OrbitFrame::Itrs;
    out.interpolation = Interpolation::Linear;
    out.degree = 1;
    out.first = plus_seconds(start, from_s);
    out.last = plus_seconds(start, to_s);
    for (const double s : {from_s, to_s})
      out.states.push_back({plus_seconds(start, s),
                            {6378.137 + height_km, east_km(s), north_km},
                            {0, speed_km_s, 0}});
    return out;
  }
  [[nodiscard]] TrackRequest request() const {
    return {.orbit = trajectory(), .site = origin_site, .attitude = {TwoAxisLaw{}}, .joints = {}};
  }
  [[nodiscard]] EpochSpan span(double seconds, double step_s) const {
    return {start, plus_seconds(start, seconds), step_s};
  }

  Epoch<Utc> start;
};

} // namespace umov::cases
