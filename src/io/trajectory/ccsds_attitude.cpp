// AEM: texts to attitudes (504.0-B-2, section 4).

#include <umov/io/attitude_file.h>

#include "io/trajectory/message_fields.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <umov/core/quantity.h>
#include <umov/core/text.h>
#include <umov/io/ccsds.h>
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

bool is_inertial(const std::string &name) {
  constexpr std::array known{"EME2000", "J2000", "ICRF", "GCRF", "GCRS"};
  return std::find(known.begin(), known.end(), upper(name)) != known.end();
}

/// How a segment's numbers are meant.
struct Context {
  TimeSystem system = TimeSystem::Utc;
  bool is_body_from_gcrs = true; ///< false: the transformation goes the other way
  std::string type, sequence;
};

Result<Context> context_of(const Message &message, const Segment &segment) {
  Context out;
  const Field &a = *find(segment.metadata, "REF_FRAME_A"),
              &b = *find(segment.metadata, "REF_FRAME_B"),
              &system = *find(segment.metadata, "TIME_SYSTEM");
  const Field *direction = find(segment.metadata, "ATTITUDE_DIR");
  if (is_inertial(a.text) == is_inertial(b.text))
    return refuse(message, a, "one inertial frame (EME2000, ICRF or GCRF) and the body's");
  const bool is_b_to_a = direction != nullptr && upper(direction->text) == "B2A";
  if (direction != nullptr && !is_b_to_a && upper(direction->text) != "A2B")
    return refuse(message, *direction, "A2B or B2A");
  out.is_body_from_gcrs = is_inertial(a.text) != is_b_to_a;
  const auto known = time_system_from(upper(system.text));
  if (!known)
    return refuse(message, system, "UTC, TAI, TT, GPS, TDB or UT1");
  out.system = *known;
  out.type = find(segment.metadata, "ATTITUDE_TYPE")->text;
  if (const Field *sequence = find(segment.metadata, "EULER_ROT_SEQ")) {
    out.sequence = sequence->text;
    for (char &c : out.sequence) // 1.0 numbers the axes, 2.0 names them
      c = c >= '1' && c <= '3' ? c : c >= 'X' && c <= 'Z' ? static_cast<char>(c - 'X' + '1') : '?';
    if (out.sequence.size() != 3 || out.sequence.find('?') != std::string::npos)
      return refuse(message, *sequence, "a sequence such as 321 or ZYX");
  } else if (out.type.starts_with("EULER")) {
    return fail(ErrorCode::BadInput, "EULER_ROT_SEQ is missing", {message.file, a.line});
  }
  return out;
}

double number(const Record &record, const char *key) {
  return *parse_number(find(record.fields, key)->text); // checked when the message was read
}

Quaternion conjugate(const Quaternion &q) { return {q.w, -q.x, -q.y, -q.z}; }

Result<Quaternion> quaternion_of(const Message &message, const Record &record, double &worst) {
  const Quaternion q{number(record, "QC"), number(record, "Q1"), number(record, "Q2"),
                     number(record, "Q3")};
  const double length = std::sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
  worst = std::max(worst, std::abs(length - 1));
  if (!(std::abs(length - 1) <= 1e-3))
    return fail(
        ErrorCode::BadInput,
        fmt::format("the quaternion has length {:.6f}, expected 1 within 0.001. Divide it by "
                    "its length.",
                    length),
        {message.file, record.line});
  return Quaternion{q.w / length, q.x / length, q.y / length, q.z / length};
}

/// Components in axes turned by `angle` about axis 1, 2 or 3.
Rotation<Body, Body> turned_about(char axis, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  if (axis == '1')
    return {Vec3<Body>{1, 0, 0}, {0, c, s}, {0, -s, c}};
  if (axis == '2')
    return {Vec3<Body>{c, 0, -s}, {0, 1, 0}, {s, 0, c}};
  return {Vec3<Body>{c, s, 0}, {-s, c, 0}, {0, 0, 1}};
}

/// Euler angles are named by their axis; they apply in the order of the sequence.
Quaternion euler_of(const Record &record, const std::string &sequence) {
  constexpr std::array keys{"X_ANGLE", "Y_ANGLE", "Z_ANGLE"};
  Rotation<Body, Body> out;
  for (const char axis : sequence)
    out =
        turned_about(axis, number(record, keys[static_cast<std::size_t>(axis - '1')]) * pi / 180) *
        out;
  return quaternion_from(out);
}

Result<AttitudeState> state_of(const Message &message, const Context &context, const Record &record,
                               double &worst) {
  AttitudeState out;
  const Field &epoch = *find(record.fields, "EPOCH");
  auto time = utc_from_calendar(epoch.text, context.system);
  if (!time)
    return fail(ErrorCode::BadInput, "EPOCH: " + time.error().message, {message.file, epoch.line});
  out.time = *time;
  if (context.type.starts_with("SPIN")) {
    out.spin = SpinState{
        number(record, "SPIN_ALPHA") * pi / 180, number(record, "SPIN_DELTA") * pi / 180,
        number(record, "SPIN_ANGLE") * pi / 180, number(record, "SPIN_ANGLE_VEL") * pi / 180};
    return out;
  }
  Quaternion q;
  if (context.type.starts_with("EULER")) {
    q = euler_of(record, context.sequence);
  } else {
    UMOV_ASSIGN(unit, quaternion_of(message, record, worst));
    q = unit;
  }
  out.body_from_gcrs = context.is_body_from_gcrs ? q : conjugate(q);
  return out;
}

Result<AttitudeSegment> segment_of(const Message &message, const Segment &segment, double &worst) {
  AttitudeSegment out;
  UMOV_ASSIGN(context, context_of(message, segment));
  if (const Field *degree = find(segment.metadata, "INTERPOLATION_DEGREE")) {
    const auto value = parse_number(degree->text);
    if (!value || *value != std::floor(*value) || *value < 1 || *value > 15)
      return refuse(message, *degree, "a whole number, 1 to 15");
    out.degree = static_cast<int>(*value);
  }
  for (const Record &record : segment.data) {
    if (record.name != "attitudeState")
      continue;
    UMOV_ASSIGN(state, state_of(message, context, record, worst));
    if (!out.states.empty() && !(seconds_between(state.time, out.states.back().time) > 0))
      return fail(ErrorCode::BadInput,
                  fmt::format("EPOCH: {} follows {}; a later time was expected. Put the states in "
                              "order of time, each time once",
                              to_iso(state.time, 6), to_iso(out.states.back().time, 6)),
                  {message.file, record.line});
    out.states.push_back(state);
  }
  const auto bound = [&](const char *usable, const char *plain) {
    const Field *field = find(segment.metadata, usable);
    return utc_from_calendar((field != nullptr ? field : find(segment.metadata, plain))->text,
                             context.system);
  };
  UMOV_ASSIGN(first, bound("USEABLE_START_TIME", "START_TIME"));
  UMOV_ASSIGN(last, bound("USEABLE_STOP_TIME", "STOP_TIME"));
  out.first = first;
  out.last = last;
  return out;
}

} // namespace

Result<AttitudeTable> read_attitude_table(std::string_view text, const std::string &file,
                                          Diagnostics &diagnostics) {
  UMOV_ASSIGN(message, ccsds::read_message(text, file, diagnostics));
  if (message.kind != ccsds::Kind::Aem)
    return fail(
        ErrorCode::BadInput,
        fmt::format("is a CCSDS {}; an attitude (AEM) was expected", ccsds::to_text(message.kind)),
        {file});
  AttitudeTable out;
  out.name = find(message.segments.front().metadata, "OBJECT_NAME")->text;
  double worst = 0;
  for (const Segment &segment : message.segments) {
    UMOV_ASSIGN(one, segment_of(message, segment, worst));
    out.segments.push_back(std::move(one));
  }
  if (worst > 1e-6)
    diagnostics.warn(fmt::format("quaternions are off unit length by up to {:.1g}; they were "
                                 "divided by it",
                                 worst),
                     {file});
  if (const auto checked = check_attitude_table(out); !checked)
    return fail(ErrorCode::BadInput, checked.error().message, {file});
  return out;
}

} // namespace umov
