#include "io/ccsds/keywords.h"

#include <fmt/format.h>

namespace umov::ccsds {
namespace {

void put(std::string &out, const Field &field) {
  if (field.key == "COMMENT")
    out += "COMMENT " + field.text + "\n";
  else
    out += fmt::format("{:<20} = {}{}\n", field.key, field.text,
                       field.unit.empty() ? "" : " [" + field.unit + "]");
}

void put_comments(std::string &out, const Record &record) {
  for (const Field &field : record.fields)
    if (field.key == "COMMENT")
      put(out, field);
}

/// A data line has no room for a unit.
Result<void> check_unit(const Message &message, const Field &field) {
  const std::string_view standard = standard_unit(field.key);
  if (field.unit.empty() || field.unit == standard)
    return {};
  return fail(ErrorCode::BadInput,
              fmt::format("{} is in {}; a data line of KVN holds {}", field.key, field.unit,
                          standard.empty() ? "no unit" : std::string(standard) + " only"),
              {message.file, field.line});
}

Result<void> put_line(std::string &out, const Message &message, const Record &record,
                      const std::vector<std::string> &columns) {
  put_comments(out, record);
  UMOV_ASSIGN(epoch, needed_field(message, record, "EPOCH"));
  out += epoch->text;
  for (const std::string &column : columns) {
    if (column.ends_with("_DDOT") && find(record.fields, column) == nullptr)
      continue; // accelerations are there or not
    UMOV_ASSIGN(field, needed_field(message, record, column));
    UMOV_TRY(check_unit(message, *field));
    out += " " + field->text;
  }
  out += "\n";
  return {};
}

Result<void> put_covariance(std::string &out, const Message &message, const Record &record) {
  for (const Field &field : record.fields)
    if (field.key == "COMMENT" || field.key == "EPOCH" || field.key == "COV_REF_FRAME")
      put(out, field);
  std::size_t k = 0;
  for (int row = 0; row < 6; ++row) {
    for (int column = 0; column <= row; ++column, ++k) {
      UMOV_ASSIGN(field, needed_field(message, record, covariance_keys()[k]));
      UMOV_TRY(check_unit(message, *field));
      out += (column == 0 ? "" : " ") + field->text;
    }
    out += "\n";
  }
  return {};
}

/// One line per value of an observation: KEYWORD = epoch value.
Result<void> put_observation(std::string &out, const Message &message, const Record &record) {
  put_comments(out, record);
  UMOV_ASSIGN(epoch, needed_field(message, record, "EPOCH"));
  for (const Field &field : record.fields) {
    if (field.key == "COMMENT" || field.key == "EPOCH")
      continue;
    UMOV_TRY(check_unit(message, field));
    out += fmt::format("{:<20} = {} {}\n", field.key, epoch->text, field.text);
  }
  return {};
}

Result<void> put_record(std::string &out, const Message &message, const Segment &segment,
                        const Record &record) {
  if (record.name == "comment") {
    put_comments(out, record);
    return {};
  }
  if (message.kind == Kind::Oem)
    return put_line(out, message, record, state_columns());
  if (message.kind == Kind::Aem) {
    UMOV_ASSIGN(form, needed_form(message, segment));
    return put_line(out, message, record, attitude_columns(*form, segment));
  }
  if (message.kind == Kind::Tdm)
    return put_observation(out, message, record);
  // Readers take a comment and the epoch of a manoeuvre as the begin of a block.
  constexpr std::string_view first = "MAN_EPOCH_IGNITION";
  put_comments(out, record);
  if (const Field *field = find(record.fields, first))
    put(out, *field);
  for (const Field &field : record.fields)
    if (field.key != "COMMENT" && field.key != first)
      put(out, field);
  return {};
}

Result<void> put_segment(std::string &out, const Message &message, const Segment &segment) {
  out += "META_START\n";
  for (const Field &field : segment.metadata)
    put(out, field);
  out += "META_STOP\n\n";
  const bool has_marks = message.kind == Kind::Aem || message.kind == Kind::Tdm;
  if (has_marks)
    out += "DATA_START\n";
  bool is_in_covariance = false;
  for (const Record &record : segment.data) {
    const bool is_covariance = message.kind == Kind::Oem && record.name == "covarianceMatrix";
    if (is_covariance != is_in_covariance)
      out += is_covariance ? "\nCOVARIANCE_START\n" : "COVARIANCE_STOP\n\n";
    is_in_covariance = is_covariance;
    UMOV_TRY(is_covariance ? put_covariance(out, message, record)
                           : put_record(out, message, segment, record));
  }
  if (is_in_covariance)
    out += "COVARIANCE_STOP\n";
  if (has_marks)
    out += "DATA_STOP\n";
  return {};
}

} // namespace

Result<std::string> write_kvn(const Message &message) {
  std::string out = fmt::format("CCSDS_{}_VERS = {}\n", to_text(message.kind), message.version);
  for (const Field &field : message.header)
    put(out, field);
  for (const Segment &segment : message.segments) {
    out += "\n";
    UMOV_TRY(put_segment(out, message, segment));
  }
  return out;
}

} // namespace umov::ccsds
