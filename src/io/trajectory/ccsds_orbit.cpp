// OEM and OPM: texts to states.

#include <umov/io/trajectory_file.h>

#include "io/trajectory/message_fields.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <umov/core/text.h>
#include <umov/time/time_system.h>

namespace umov {
namespace {

using ccsds::Field;
using ccsds::find;
using ccsds::Message;
using ccsds::Record;
using ccsds::refuse;
using ccsds::Segment;
using ccsds::upper;

/// What decides about all states of a segment.
struct Context {
  OrbitFrame frame = OrbitFrame::Gcrs;
  TimeSystem system = TimeSystem::Utc;
};

Result<Context> context_of(const Message &message, const Segment &segment) {
  Context out;
  const Field &center = *find(segment.metadata, "CENTER_NAME"),
              &frame = *find(segment.metadata, "REF_FRAME"),
              &system = *find(segment.metadata, "TIME_SYSTEM");
  if (upper(center.text) != "EARTH")
    return refuse(message, center, "EARTH: orbits about other bodies are not built");
  const std::string name = upper(frame.text);
  if (name == "GCRF" || name == "ICRF" || name == "GCRS")
    out.frame = OrbitFrame::Gcrs;
  else if (name == "EME2000" || name == "J2000")
    out.frame = OrbitFrame::Eme2000;
  else if (name == "TEME")
    out.frame = OrbitFrame::Teme;
  else if (name.starts_with("ITRF"))
    out.frame = OrbitFrame::Itrs;
  else
    return refuse(message, frame, "GCRF, ICRF, EME2000, TEME or ITRF");
  const auto known = time_system_from(upper(system.text));
  if (!known)
    return refuse(message, system, "UTC, TAI, TT, GPS, TDB or UT1");
  out.system = *known;
  return out;
}

Result<Epoch<Utc>> time_of(const Message &message, const Field &field, TimeSystem system) {
  auto time = utc_from_calendar(field.text, system);
  if (!time)
    return fail(ErrorCode::BadInput, field.key + ": " + time.error().message,
                {message.file, field.line});
  return time;
}

/// In km and seconds; metres where the unit says so.
Result<double> number_of(const Message &message, const Field &field) {
  const auto value = parse_number(field.text);
  if (!value)
    return refuse(message, field, "a finite number");
  const bool is_speed = field.key.find("_DOT") != std::string::npos;
  if (field.unit.empty() || field.unit == (is_speed ? "km/s" : "km"))
    return *value;
  if (field.unit == (is_speed ? "m/s" : "m"))
    return *value / 1000;
  return fail(ErrorCode::BadInput,
              fmt::format("{} is in \"{}\", expected {}", field.key, field.unit,
                          is_speed ? "km/s or m/s" : "km or m"),
              {message.file, field.line});
}

Result<EphemerisState> state_of(const Message &message, const Record &record, TimeSystem system) {
  EphemerisState out;
  UMOV_ASSIGN(time, time_of(message, *find(record.fields, "EPOCH"), system));
  out.time = time;
  constexpr std::array position{"X", "Y", "Z"}, velocity{"X_DOT", "Y_DOT", "Z_DOT"};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    UMOV_ASSIGN(r, number_of(message, *find(record.fields, position[axis])));
    UMOV_ASSIGN(v, number_of(message, *find(record.fields, velocity[axis])));
    out.position_km[axis] = r;
    out.velocity_km_s[axis] = v;
  }
  return out;
}

Result<void> read_interpolation(const Message &message, const Segment &segment,
                                EphemerisSegment &out) {
  if (const Field *method = find(segment.metadata, "INTERPOLATION")) {
    const std::string name = upper(method->text);
    if (name == "LINEAR")
      out.interpolation = Interpolation::Linear;
    else if (name == "LAGRANGE")
      out.interpolation = Interpolation::Lagrange;
    else if (name == "HERMITE")
      out.interpolation = Interpolation::Hermite;
    else
      return refuse(message, *method, "LINEAR, LAGRANGE or HERMITE");
  }
  if (const Field *degree = find(segment.metadata, "INTERPOLATION_DEGREE")) {
    const auto value = parse_number(degree->text);
    if (!value || !(*value >= 1 && *value <= 31) || *value != std::floor(*value))
      return refuse(message, *degree, "a whole number, 1 to 31");
    out.degree = static_cast<int>(*value);
  }
  return {};
}

Result<EphemerisSegment> segment_of(const Message &message, const Segment &segment) {
  EphemerisSegment out;
  UMOV_ASSIGN(context, context_of(message, segment));
  out.frame = context.frame;
  UMOV_TRY(read_interpolation(message, segment, out));
  for (const Record &record : segment.data) {
    if (record.name != "stateVector")
      continue;
    UMOV_ASSIGN(state, state_of(message, record, context.system));
    out.states.push_back(state);
  }
  const auto bound = [&](const char *usable, const char *plain) {
    const Field *field = find(segment.metadata, usable);
    return time_of(message, field != nullptr ? *field : *find(segment.metadata, plain),
                   context.system);
  };
  UMOV_ASSIGN(first, bound("USEABLE_START_TIME", "START_TIME"));
  UMOV_ASSIGN(last, bound("USEABLE_STOP_TIME", "STOP_TIME"));
  out.first = first;
  out.last = last;
  return out;
}

std::string text_of(const Segment &segment, const char *key) {
  const Field *field = find(segment.metadata, key);
  return field == nullptr ? std::string() : field->text;
}

} // namespace

Result<OrbitEphemeris> ephemeris_from_oem(const Message &message) {
  OrbitEphemeris out;
  out.name = text_of(message.segments.front(), "OBJECT_NAME");
  out.object_id = text_of(message.segments.front(), "OBJECT_ID");
  for (const Segment &segment : message.segments) {
    if (text_of(segment, "OBJECT_ID") != out.object_id)
      return fail(ErrorCode::BadInput,
                  fmt::format("holds {} and {}, expected one object. Split the file.",
                              out.object_id, text_of(segment, "OBJECT_ID")),
                  {message.file, find(segment.metadata, "OBJECT_ID")->line});
    UMOV_ASSIGN(one, segment_of(message, segment));
    out.segments.push_back(std::move(one));
  }
  if (const auto checked = check_ephemeris(out); !checked)
    return fail(ErrorCode::BadInput, checked.error().message, {message.file});
  return out;
}

Result<StateVector> state_from_opm(const Message &message) {
  const Segment &segment = message.segments.front();
  StateVector out;
  out.name = text_of(segment, "OBJECT_NAME");
  out.object_id = text_of(segment, "OBJECT_ID");
  UMOV_ASSIGN(context, context_of(message, segment));
  out.frame = context.frame;
  for (const Record &record : segment.data) {
    if (record.name == "maneuverParameters")
      return fail(ErrorCode::BadInput,
                  "has a manoeuvre; an orbit across one is not built. Give an ephemeris (OEM).",
                  {message.file, record.line});
    if (record.name != "stateVector")
      continue;
    UMOV_ASSIGN(state, state_of(message, record, context.system));
    out.state = state;
  }
  return out;
}

} // namespace umov
