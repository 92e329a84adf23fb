#include "io/ccsds/keywords.h"

#include <algorithm>
#include <fmt/format.h>
#include <set>
#include <umov/core/text.h>

namespace umov::ccsds {
namespace {

bool is_text_key(std::string_view key) {
  return key == "COMMENT" || key == "EPOCH" || key == "COV_REF_FRAME" || key == "MAN_REF_FRAME" ||
         key == "MAN_EPOCH_IGNITION" || key.starts_with("USER_DEFINED_");
}

Result<void> check_fields(const std::vector<Field> &fields, const std::string &file,
                          bool are_numbers) {
  std::set<std::string_view> seen;
  for (const Field &field : fields) {
    if (field.key == "COMMENT")
      continue;
    if (!seen.insert(field.key).second)
      return fail(ErrorCode::BadInput, field.key + " stands twice. Keep one of them.",
                  {file, field.line});
    if (are_numbers && !is_text_key(field.key) && !parse_number(field.text))
      return fail(ErrorCode::BadInput,
                  fmt::format("{} is \"{}\", expected a finite number", field.key,
                              field.text.substr(0, 60)),
                  {file, field.line});
    // Units of data lines are fixed; elsewhere they are a matter for those who use the number.
  }
  return {};
}

/// Keywords that a record must have.
std::vector<std::string> mandatory(const Message &message, const Segment &segment,
                                   const Record &record) {
  if (record.name == "stateVector")
    return {"EPOCH", "X", "Y", "Z", "X_DOT", "Y_DOT", "Z_DOT"};
  if (record.name == "attitudeState") {
    std::vector<std::string> out{"EPOCH"};
    if (const Field *type = find(segment.metadata, "ATTITUDE_TYPE"))
      if (const AttitudeForm *form = attitude_form(type->text))
        for (const std::string &key : attitude_columns(*form, segment))
          out.push_back(key);
    return out;
  }
  if (record.name == "covarianceMatrix") {
    std::vector<std::string> out = covariance_keys();
    if (message.kind == Kind::Oem)
      out.insert(out.begin(), "EPOCH");
    return out;
  }
  if (record.name == "observation" || record.name == "comment")
    return {};
  if (record.name == "maneuverParameters")
    return {"MAN_EPOCH_IGNITION", "MAN_DURATION"};
  return {};
}

Result<void> check_segment(const Message &message, const Segment &segment) {
  UMOV_TRY(check_fields(segment.metadata, message.file, false));
  for (const std::string &key : mandatory_metadata(message.kind))
    if (const Field *field = find(segment.metadata, key); field == nullptr)
      return fail(
          ErrorCode::BadInput,
          fmt::format("the metadata have no {}, which a {} must have", key, to_text(message.kind)),
          {message.file, segment.metadata.empty() ? 0 : segment.metadata.front().line});
  if (const Field *type = find(segment.metadata, "ATTITUDE_TYPE");
      message.kind == Kind::Aem && attitude_form(type->text) == nullptr)
    return fail(ErrorCode::BadInput,
                fmt::format("ATTITUDE_TYPE is \"{}\", expected QUATERNION, QUATERNION/DERIVATIVE, "
                            "QUATERNION/RATE, QUATERNION/ANGVEL, EULER_ANGLE, EULER_ANGLE/RATE, "
                            "SPIN or SPIN/NUTATION",
                            type->text),
                {message.file, type->line});
  for (const Record &record : segment.data) {
    UMOV_TRY(check_fields(record.fields, message.file, message.kind != Kind::Tdm));
    for (const std::string &key : mandatory(message, segment, record))
      if (find(record.fields, key) == nullptr)
        return fail(ErrorCode::BadInput, fmt::format("a {} has no {}", record.name, key),
                    {message.file, record.line});
  }
  const auto has = [&](std::string_view name) {
    return std::any_of(segment.data.begin(), segment.data.end(),
                       [&](const Record &record) { return record.name == name; });
  };
  if ((message.kind == Kind::Opm || message.kind == Kind::Oem) && !has("stateVector"))
    return fail(ErrorCode::BadInput, "a segment has no state vector", {message.file});
  if (message.kind == Kind::Aem && !has("attitudeState"))
    return fail(ErrorCode::BadInput, "a segment has no attitude", {message.file});
  return {};
}

} // namespace

Result<void> check_message(const Message &message, Diagnostics &diagnostics) {
  UMOV_TRY(check_fields(message.header, message.file, false));
  for (const char *key : {"CREATION_DATE", "ORIGINATOR"}) // many operators leave them out
    if (find(message.header, key) == nullptr)
      diagnostics.warn(fmt::format("the header has no {}", key), {message.file});
  if (message.segments.empty())
    return fail(ErrorCode::BadInput, "holds no segment", {message.file});
  for (const Segment &segment : message.segments)
    UMOV_TRY(check_segment(message, segment));
  return {};
}

bool is_message(std::string_view text) {
  if (text.starts_with("\xEF\xBB\xBF"))
    text.remove_prefix(3);
  text = trimmed(text.substr(0, 4096));
  const std::size_t begin = text.find_first_not_of("\r\n \t");
  if (begin != std::string_view::npos && text[begin] == '<') {
    for (const char *element : {"<opm", "<oem", "<aem", "<tdm"})
      if (text.find(element) != std::string_view::npos)
        return true;
    return false;
  }
  for (const char *name : {"CCSDS_OPM_VERS", "CCSDS_OEM_VERS", "CCSDS_AEM_VERS", "CCSDS_TDM_VERS"})
    if (text.find(name) != std::string_view::npos)
      return true;
  return false;
}

Result<Message> read_message(std::string_view text, const std::string &file,
                             Diagnostics &diagnostics) {
  if (text.starts_with("\xEF\xBB\xBF"))
    text.remove_prefix(3);
  const std::size_t begin = text.find_first_not_of(" \t\r\n");
  const bool is_xml = begin != std::string_view::npos && text[begin] == '<';
  UMOV_ASSIGN(message, is_xml ? read_xml(text, file) : read_kvn(text, file));
  UMOV_TRY(check_message(message, diagnostics));
  return message;
}

Result<std::string> write_message(const Message &message, Form form) {
  return form == Form::Kvn ? write_kvn(message) : write_xml(message);
}

} // namespace umov::ccsds
