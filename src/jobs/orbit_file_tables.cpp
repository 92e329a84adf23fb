#include "jobs/orbit_file_tables.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <umov/core/quantity.h>
#include <umov/core/text.h>

namespace umov::jobs {
namespace {

/// Semi-major axis [km] of the mean motion as published, WGS 72.
double semi_major_axis_km(const ElementSet &set) {
  constexpr double gm = 398600.8; // km3/s2
  const double n = set.mean_motion / 60;
  return std::cbrt(gm / (n * n));
}
} // namespace

Table elements_table(const std::vector<ElementSet> &sets) {
  using E = const ElementSet &;
  Table t;
  std::vector<std::string> names, ids, epochs;
  std::vector<std::int64_t> numbers;
  for (E e : sets) {
    names.push_back(e.name);
    numbers.push_back(e.norad_cat_id);
    ids.push_back(e.international_designator);
    epochs.push_back(to_iso_exact(e.epoch));
  }
  t.add("name", "", "as in the file", std::move(names));
  t.add("norad_cat_id", "", "catalogue number", std::move(numbers));
  t.add("object_id", "", "international designator", std::move(ids));
  t.add("epoch_utc", "", "of the elements", std::move(epochs));
  const auto add = [&](const char *name, const char *unit, const char *text, auto take) {
    std::vector<double> values;
    values.reserve(sets.size());
    for (E e : sets)
      values.push_back(take(e));
    t.add(name, unit, text, std::move(values));
  };
  constexpr double earth_radius_km = 6378.135; // WGS 72
  const auto degrees = [](double radians) {
    return parse_number(degrees_text(Angle::radians(radians))).value_or(0); // as printed
  };
  add("mean_motion", "1 / d", "revolutions, Kozai",
      [](E e) { return e.mean_motion / (2 * pi / 1440); });
  add("eccentricity", "", "mean", [](E e) { return e.eccentricity; });
  add("inclination", "deg", "mean, TEME", [&](E e) { return degrees(e.inclination); });
  add("raan", "deg", "right ascension of the node, TEME", [&](E e) { return degrees(e.raan); });
  add("arg_of_pericenter", "deg", "mean", [&](E e) { return degrees(e.argument_of_perigee); });
  add("mean_anomaly", "deg", "mean", [&](E e) { return degrees(e.mean_anomaly); });
  add("bstar", "", "drag term, per Earth radius", [](E e) { return e.bstar; });
  add("period", "min", "of the mean motion", [](E e) { return 2 * pi / e.mean_motion; });
  add("perigee_alt", "km", "above a sphere of 6378.135 km, mean",
      [](E e) { return semi_major_axis_km(e) * (1 - e.eccentricity) - earth_radius_km; });
  add("apogee_alt", "km", "above a sphere of 6378.135 km, mean",
      [](E e) { return semi_major_axis_km(e) * (1 + e.eccentricity) - earth_radius_km; });
  return t;
}

Table segments_table(const ccsds::Message &message) {
  Table t;
  const auto add = [&](const char *name, const char *text,
                       std::initializer_list<const char *> keys) {
    std::vector<std::string> values;
    for (const ccsds::Segment &segment : message.segments) {
      std::string value;
      for (const char *key : keys)
        if (const ccsds::Field *field = ccsds::find(segment.metadata, key); value.empty() && field)
          value = field->text;
      values.push_back(value);
    }
    t.add(name, "", text, std::move(values));
  };
  add("name", "object, or participant of a tracking message", {"OBJECT_NAME", "PARTICIPANT_2"});
  add("object_id", "international designator", {"OBJECT_ID"});
  add("center", "centre of the frame", {"CENTER_NAME"});
  add("frame", "reference frame", {"REF_FRAME", "REF_FRAME_A"});
  add("time_system", "of all dates", {"TIME_SYSTEM"});
  add("start", "as written", {"USEABLE_START_TIME", "START_TIME"});
  add("stop", "as written", {"USEABLE_STOP_TIME", "STOP_TIME"});
  add("kind", "of attitude or interpolation", {"ATTITUDE_TYPE", "INTERPOLATION", "MODE"});
  std::vector<std::int64_t> counts;
  for (const ccsds::Segment &segment : message.segments)
    counts.push_back(static_cast<std::int64_t>(
        std::count_if(segment.data.begin(), segment.data.end(), [](const ccsds::Record &record) {
          return record.name != "comment" && record.name != "covarianceMatrix";
        })));
  t.add("records", "", "states, attitudes, observations or blocks of parameters",
        std::move(counts));
  t.note("message", fmt::format("CCSDS {} {}", ccsds::to_text(message.kind), message.version));
  return t;
}

} // namespace umov::jobs
