#include "io/ccsds/keywords.h"

#include <algorithm>
#include <cctype>
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
  if (record.name == "stateVector") {
    std::vector<std::string> out{"EPOCH"};
    const auto &columns = state_columns();
    const bool has_acceleration =
        std::any_of(columns.begin() + 6, columns.end(),
                    [&](const std::string &key) { return find(record.fields, key) != nullptr; });
    out.insert(out.end(), columns.begin(), columns.begin() + (has_acceleration ? 9 : 6));
    return out;
  }
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
  if (record.name == "observation")
    return {"EPOCH"};
  if (record.name == "maneuverParameters")
    return {"MAN_EPOCH_IGNITION", "MAN_DURATION"};
  return {};
}

/// Keywords of observations are many (503.0-B, section 3.5) and free here; those of other records
/// are the mandatory ones and few more.
bool is_known_key(Kind kind, const Record &record, const std::vector<std::string> &needed,
                  std::string_view key) {
  if (key == "COMMENT" || record.name == "observation")
    return true;
  if (kind == Kind::Opm)
    return opm_record(key) == record.name;
  return std::find(needed.begin(), needed.end(), key) != needed.end() ||
         (record.name == "covarianceMatrix" && key == "COV_REF_FRAME");
}

Result<void> check_observation(const Message &message, const Record &record) {
  bool has_value = false;
  for (const Field &field : record.fields) {
    if (field.key == "COMMENT" || field.key == "EPOCH")
      continue;
    has_value = true;
    if (field.text.empty())
      return fail(ErrorCode::BadInput, field.key + " of an observation is empty, expected a value",
                  {message.file, field.line});
  }
  if (!has_value)
    return fail(ErrorCode::BadInput, "an observation has an EPOCH and no value",
                {message.file, record.line});
  return {};
}

/// One word of the signs of dates: KVN begins lines with it, and would take others for keywords or
/// columns.
bool is_like_a_date(std::string_view text) {
  return !text.empty() && text.front() >= '0' && text.front() <= '9' &&
         text.find_first_not_of("0123456789-:.TZ+") == std::string_view::npos;
}

/// A record by itself: known, whole, and such that both forms can say it.
Result<void> check_record(const Message &message, const Segment &segment, const Record &record) {
  const Where where{message.file, record.line};
  if (!is_record(message.kind, record.name))
    return fail(ErrorCode::BadInput,
                fmt::format("<{}> was found among the data, where {} has none. Remove it, or "
                            "correct its name.",
                            record.name.substr(0, 60), with_article(to_text(message.kind))),
                where);
  UMOV_TRY(check_fields(record.fields, message.file, message.kind != Kind::Tdm));
  const std::vector<std::string> needed = mandatory(message, segment, record);
  for (const Field &field : record.fields)
    if (!is_known_key(message.kind, record, needed, field.key))
      return fail(ErrorCode::BadInput,
                  fmt::format("\"{}\" is no keyword of {}. Remove it, or correct its name.",
                              field.key.substr(0, 60), with_article(record.name)),
                  {message.file, field.line});
  for (const std::string &key : needed)
    if (find(record.fields, key) == nullptr)
      return fail(ErrorCode::BadInput, fmt::format("{} has no {}", with_article(record.name), key),
                  where);
  const Field *epoch = find(record.fields, "EPOCH");
  if (epoch != nullptr && !is_like_a_date(epoch->text))
    return fail(
        ErrorCode::BadInput,
        fmt::format("EPOCH is \"{}\", expected a date without blanks, such as 2018-01-20T00:00:00",
                    epoch->text.substr(0, 60)),
        {message.file, epoch->line});
  return record.name == "observation" ? check_observation(message, record) : Result<void>{};
}

Result<void> check_segment(const Message &message, const Segment &segment) {
  UMOV_TRY(check_fields(segment.metadata, message.file, false));
  for (const std::string &key : mandatory_metadata(message.kind))
    if (const Field *field = find(segment.metadata, key); field == nullptr)
      return fail(ErrorCode::BadInput,
                  fmt::format("the metadata have no {}, which {} must have", key,
                              with_article(to_text(message.kind))),
                  {message.file, segment.metadata.empty() ? 0 : segment.metadata.front().line});
  if (const Field *type = find(segment.metadata, "ATTITUDE_TYPE");
      message.kind == Kind::Aem && attitude_form(type->text) == nullptr)
    return fail(ErrorCode::BadInput,
                fmt::format("ATTITUDE_TYPE is \"{}\", expected QUATERNION, QUATERNION/DERIVATIVE, "
                            "QUATERNION/RATE, QUATERNION/ANGVEL, EULER_ANGLE, EULER_ANGLE/RATE, "
                            "SPIN or SPIN/NUTATION",
                            type->text),
                {message.file, type->line});
  for (const Record &record : segment.data)
    UMOV_TRY(check_record(message, segment, record));
  const auto has = [&](std::string_view name) {
    return std::any_of(segment.data.begin(), segment.data.end(),
                       [&](const Record &record) { return record.name == name; });
  };
  if ((message.kind == Kind::Opm || message.kind == Kind::Oem) && !has("stateVector"))
    return fail(ErrorCode::BadInput,
                "a segment has no state vector; one or more were expected in it", {message.file});
  if (message.kind == Kind::Aem && !has("attitudeState"))
    return fail(ErrorCode::BadInput, "a segment has no attitude; lines of data were expected in it",
                {message.file});
  return {};
}

} // namespace

namespace {

/// Words of letters, digits and signs that neither form takes for something else.
bool is_keyword(std::string_view key) {
  return !key.empty() && std::isalpha(static_cast<unsigned char>(key.front())) != 0 &&
         std::all_of(key.begin(), key.end(), [](char c) {
           return (c & 0x80) == 0 && (std::isalnum(static_cast<unsigned char>(c)) != 0 ||
                                      c == '_' || c == '-' || c == '.');
         });
}

/// What terminals obey, what ends a line of KVN and what is no UTF-8, in texts of any form.
Result<void> clean(std::vector<Field> &fields, const std::string &file, Where &changed) {
  for (Field &field : fields) {
    if (!is_keyword(field.key))
      return fail(ErrorCode::BadInput,
                  fmt::format("\"{}\" is no keyword; letters, digits and _ were expected",
                              printable(field.key.substr(0, 60))),
                  {file, field.line});
    if (field.unit.find('[') != std::string::npos) // KVN would not find where it begins
      return fail(
          ErrorCode::BadInput,
          fmt::format("the unit of {} is \"{}\"; one without brackets was expected, such as "
                      "km/s",
                      field.key, printable(field.unit.substr(0, 40))),
          {file, field.line});
    for (std::string *text : {&field.text, &field.unit}) {
      std::replace_if(
          text->begin(), text->end(), [](char c) { return c == '\n' || c == '\r' || c == '\t'; },
          ' '); // XML may break a text into lines
      bool is_changed = false;
      *text = printable(*text, &is_changed);
      if (is_changed && changed.file.empty())
        changed = {file, field.line};
    }
  }
  return {};
}

Result<void> clean(Message &message, Diagnostics &diagnostics) {
  Where changed; // the first place
  message.version = printable(message.version);
  UMOV_TRY(clean(message.header, message.file, changed));
  for (Segment &segment : message.segments) {
    UMOV_TRY(clean(segment.metadata, message.file, changed));
    for (Record &record : segment.data)
      UMOV_TRY(clean(record.fields, message.file, changed));
  }
  if (!changed.file.empty())
    diagnostics.warn("a text holds bytes that are not printable UTF-8; they are replaced by '?', "
                     "here and in what follows.",
                     changed);
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
  UMOV_TRY(clean(message, diagnostics));
  UMOV_TRY(check_message(message, diagnostics));
  return message;
}

Result<std::string> write_message(const Message &message, Form form) {
  return form == Form::Kvn ? write_kvn(message) : write_xml(message);
}

} // namespace umov::ccsds
