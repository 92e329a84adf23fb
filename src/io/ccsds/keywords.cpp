#include "io/ccsds/keywords.h"

#include <algorithm>
#include <array>

namespace umov::ccsds {
namespace {

constexpr std::array<KindInfo, 4> kinds{{{Kind::Opm, "OPM", "opm"},
                                         {Kind::Oem, "OEM", "oem"},
                                         {Kind::Aem, "AEM", "aem"},
                                         {Kind::Tdm, "TDM", "tdm"}}};

template <class List> bool contains(const List &list, std::string_view key) {
  return std::find(list.begin(), list.end(), key) != list.end();
}

constexpr std::array opm_metadata{"OBJECT_NAME", "OBJECT_ID",       "CENTER_NAME", "REF_FRAME",
                                  "TIME_SYSTEM", "REF_FRAME_EPOCH", "COMMENT"};

struct RecordKeys {
  const char *record;
  std::vector<std::string> keys;
};
const std::vector<RecordKeys> &opm_records() {
  static const std::vector<RecordKeys> all{
      {"stateVector", {"EPOCH", "X", "Y", "Z", "X_DOT", "Y_DOT", "Z_DOT"}},
      {"keplerianElements",
       {"SEMI_MAJOR_AXIS", "ECCENTRICITY", "INCLINATION", "RA_OF_ASC_NODE", "ARG_OF_PERICENTER",
        "TRUE_ANOMALY", "MEAN_ANOMALY", "GM"}},
      {"spacecraftParameters",
       {"MASS", "SOLAR_RAD_AREA", "SOLAR_RAD_COEFF", "DRAG_AREA", "DRAG_COEFF"}},
      {"maneuverParameters",
       {"MAN_EPOCH_IGNITION", "MAN_DURATION", "MAN_DELTA_MASS", "MAN_REF_FRAME", "MAN_DV_1",
        "MAN_DV_2", "MAN_DV_3"}}};
  return all;
}

} // namespace

const KindInfo &info_of(Kind kind) { return kinds[static_cast<std::size_t>(kind)]; }
const KindInfo *find_kind(std::string_view name) {
  const auto found = std::find_if(kinds.begin(), kinds.end(), [&](const KindInfo &info) {
    return name == info.name || name == info.element;
  });
  return found == kinds.end() ? nullptr : &*found;
}
const char *to_text(Kind kind) { return info_of(kind).name; }

bool is_header_key(std::string_view key) {
  constexpr std::array keys{"COMMENT", "CREATION_DATE", "ORIGINATOR", "MESSAGE_ID",
                            "CLASSIFICATION"};
  return contains(keys, key);
}

const std::vector<std::string> &mandatory_metadata(Kind kind) {
  static const std::array<std::vector<std::string>, 4> all{
      {{"OBJECT_NAME", "OBJECT_ID", "CENTER_NAME", "REF_FRAME", "TIME_SYSTEM"},
       {"OBJECT_NAME", "OBJECT_ID", "CENTER_NAME", "REF_FRAME", "TIME_SYSTEM", "START_TIME",
        "STOP_TIME"},
       {"OBJECT_NAME", "OBJECT_ID", "REF_FRAME_A", "REF_FRAME_B", "TIME_SYSTEM", "START_TIME",
        "STOP_TIME", "ATTITUDE_TYPE"},
       {"TIME_SYSTEM", "PARTICIPANT_1"}}};
  return all[static_cast<std::size_t>(kind)];
}

bool is_metadata_key(Kind kind, std::string_view key) {
  return kind == Kind::Opm ? contains(opm_metadata, key) : true;
}

std::string_view opm_record(std::string_view key) {
  for (const RecordKeys &one : opm_records())
    if (contains(one.keys, key))
      return one.record;
  if (key == "COV_REF_FRAME" || contains(covariance_keys(), key))
    return "covarianceMatrix";
  if (key.starts_with("USER_DEFINED_"))
    return "userDefinedParameters";
  return {};
}

bool is_record(Kind kind, std::string_view name) {
  if (name == "comment")
    return true;
  switch (kind) {
  case Kind::Opm:
    return name == "covarianceMatrix" || name == "userDefinedParameters" ||
           std::any_of(opm_records().begin(), opm_records().end(),
                       [&](const RecordKeys &one) { return name == one.record; });
  case Kind::Oem:
    return name == "stateVector" || name == "covarianceMatrix";
  case Kind::Aem:
    return name == "attitudeState";
  case Kind::Tdm:
    return name == "observation";
  }
  return false;
}

std::string with_article(std::string_view name) {
  constexpr std::string_view vowels = "AEOaeo";
  const bool is_vowel = !name.empty() && vowels.find(name.front()) != std::string_view::npos;
  return (is_vowel ? "an " : "a ") + std::string(name);
}

const std::vector<std::string> &state_columns() {
  static const std::vector<std::string> all{"X",     "Y",      "Z",      "X_DOT", "Y_DOT",
                                            "Z_DOT", "X_DDOT", "Y_DDOT", "Z_DDOT"};
  return all;
}

const std::vector<std::string> &covariance_keys() {
  static const std::vector<std::string> all = [] {
    const std::array axes{"X", "Y", "Z", "X_DOT", "Y_DOT", "Z_DOT"};
    std::vector<std::string> out;
    for (std::size_t row = 0; row < axes.size(); ++row)
      for (std::size_t column = 0; column <= row; ++column)
        out.push_back(std::string("C") + axes[row] + "_" + axes[column]);
    return out;
  }();
  return all;
}

const AttitudeForm *attitude_form(std::string_view type) {
  using G = AttitudeForm::Group;
  const std::vector<std::string> q{"Q1", "Q2", "Q3", "QC"};
  const std::vector<std::string> rates{"X_RATE", "Y_RATE", "Z_RATE"};
  const std::vector<std::string> angles{"X_ANGLE", "Y_ANGLE", "Z_ANGLE"};
  const std::vector<std::string> spin{"SPIN_ALPHA", "SPIN_DELTA", "SPIN_ANGLE", "SPIN_ANGLE_VEL"};
  static const std::vector<AttitudeForm> all{
      {"QUATERNION", "quaternionState", {G{"quaternion", q}}},
      {"QUATERNION/DERIVATIVE",
       "quaternionDerivative",
       {G{"quaternion", q}, G{"quaternionRate", {"Q1_DOT", "Q2_DOT", "Q3_DOT", "QC_DOT"}}}},
      {"QUATERNION/RATE", "quaternionEulerRate", {G{"quaternion", q}, G{"rotationRates", rates}}},
      {"QUATERNION/ANGVEL",
       "quaternionAngVel",
       {G{"quaternion", q}, G{"angVel", {"ANGVEL_X", "ANGVEL_Y", "ANGVEL_Z"}}}},
      {"EULER_ANGLE", "eulerAngle", {G{"rotationAngles", angles}}},
      {"EULER_ANGLE/RATE",
       "eulerAngleRate",
       {G{"rotationAngles", angles}, G{"rotationRates", rates}}},
      {"SPIN", "spin", {G{"", spin}}},
      {"SPIN/NUTATION",
       "spinNutation",
       {G{"", spin}, G{"", {"NUTATION", "NUTATION_PER", "NUTATION_PHASE"}}}}};
  const auto found = std::find_if(all.begin(), all.end(),
                                  [&](const AttitudeForm &form) { return type == form.type; });
  return found == all.end() ? nullptr : &*found;
}

std::vector<std::string> attitude_columns(const AttitudeForm &form, const Segment &segment) {
  const Field *order = find(segment.metadata, "QUATERNION_TYPE");
  const bool is_first = order != nullptr && order->text == "FIRST";
  std::vector<std::string> out;
  for (const AttitudeForm::Group &group : form.groups) {
    const auto begin = static_cast<std::ptrdiff_t>(out.size());
    out.insert(out.end(), group.keys.begin(), group.keys.end());
    if (is_first && std::string_view(group.keys.back()).starts_with("QC"))
      std::rotate(out.begin() + begin, out.end() - 1, out.end());
  }
  return out;
}

std::string_view standard_unit(std::string_view key) {
  constexpr std::array km{"X", "Y", "Z"};
  constexpr std::array km_s{"X_DOT", "Y_DOT", "Z_DOT"};
  constexpr std::array km_s2{"X_DDOT", "Y_DDOT", "Z_DDOT"};
  constexpr std::array degrees{"X_ANGLE",    "Y_ANGLE",    "Z_ANGLE",  "SPIN_ALPHA",
                               "SPIN_DELTA", "SPIN_ANGLE", "NUTATION", "NUTATION_PHASE"};
  constexpr std::array rates{"X_RATE",   "Y_RATE",   "Z_RATE",        "ANGVEL_X",
                             "ANGVEL_Y", "ANGVEL_Z", "SPIN_ANGLE_VEL"};
  if (contains(km, key))
    return "km";
  if (contains(km_s, key))
    return "km/s";
  if (contains(km_s2, key))
    return "km/s**2";
  if (contains(degrees, key))
    return "deg";
  if (contains(rates, key))
    return "deg/s";
  if (key == "NUTATION_PER")
    return "s";
  if (key.starts_with("Q1_DOT") || key.starts_with("Q2_DOT") || key.starts_with("Q3_DOT") ||
      key == "QC_DOT")
    return "1/s";
  if (contains(covariance_keys(), key)) {
    const bool row = key.find("_DOT_") != std::string_view::npos, column = key.ends_with("_DOT");
    return row && column ? "km**2/s**2" : row || column ? "km**2/s" : "km**2";
  }
  return {};
}

bool is_in_data_line(Kind kind, std::string_view record) {
  return (kind == Kind::Oem && (record == "stateVector" || record == "covarianceMatrix")) ||
         (kind == Kind::Aem && record == "attitudeState") || kind == Kind::Tdm;
}

const Field *find(const std::vector<Field> &fields, std::string_view key) {
  for (auto it = fields.rbegin(); it != fields.rend(); ++it)
    if (it->key == key)
      return &*it;
  return nullptr;
}

Result<const Field *> needed_field(const Message &message, const Record &record,
                                   std::string_view key) {
  if (const Field *field = find(record.fields, key))
    return field;
  return fail(ErrorCode::BadInput,
              record.name + " has no " + std::string(key) + ", which was expected",
              {message.file, record.line});
}

Result<const AttitudeForm *> needed_form(const Message &message, const Segment &segment) {
  const Field *type = find(segment.metadata, "ATTITUDE_TYPE");
  if (const AttitudeForm *form = type == nullptr ? nullptr : attitude_form(type->text))
    return form;
  return fail(ErrorCode::BadInput,
              "the metadata of attitudes have no ATTITUDE_TYPE that is known, which was expected",
              {message.file, type == nullptr ? 0 : type->line});
}

} // namespace umov::ccsds
