#include <umov/io/elements_file.h>

#include "io/elements/omm_message.h"

#include <fmt/format.h>
#include <umov/core/text.h>

namespace umov {
namespace {

/// The first line that is neither blank nor a comment; `text` goes on behind it.
std::string_view take_line(std::string_view &text) {
  while (!text.empty()) {
    const std::size_t end = text.find_first_of("\r\n");
    const std::string_view line = trimmed(text.substr(0, end));
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    if (!line.empty() && !line.starts_with('#') && !line.starts_with("COMMENT"))
      return line;
  }
  return {};
}

/// A line that begins as those of a TLE do: another text is better called what it is not.
bool has_element_line(std::string_view text) {
  constexpr std::string_view breaks = "\r\n";
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t begin = text.find_first_not_of(" \t\xEF\xBB\xBF", at);
    const std::string_view line =
        begin == std::string_view::npos ? std::string_view() : text.substr(begin, 2);
    if (line.size() == 2 && (line[0] == '1' || line[0] == '2') &&
        (line[1] == ' ' || line[1] == '\t' || (line[1] & 0x80) != 0))
      return true;
    const std::size_t end = text.find_first_of(breaks, at);
    at = end == std::string_view::npos ? text.size() : end + 1;
  }
  return false;
}

bool is_first_of_a_set(std::string_view line) {
  constexpr std::size_t shortest = 60; // of 69 columns, of which some cut the last ones off
  const auto is_digit = [&](std::size_t at) { return line[at] >= '0' && line[at] <= '9'; };
  return line.size() >= shortest && line.starts_with("1 ") && line[8] == ' ' && line[17] == ' ' &&
         is_digit(3) && is_digit(6) && is_digit(18);
}

using Reader = Result<void> (*)(std::string_view, const std::string &, const omm::Sink &);

Result<std::vector<ElementSet>> read_messages(Reader reader, omm::Metadata metadata,
                                              std::string_view text, const std::string &file,
                                              const TleOptions &options, Diagnostics &diagnostics) {
  constexpr std::size_t warnings_max = 100;
  std::vector<ElementSet> out;
  std::size_t bad = 0, renamed = 0;
  UMOV_TRY(reader(text, file, [&](Result<omm::Message> message) -> Result<void> {
    auto set = message ? omm::elements_of(*message, file, metadata)
                       : Result<ElementSet>(tl::unexpected(message.error()));
    if (set) {
      const omm::Field &name = message->fields.at("OBJECT_NAME");
      if (name.text != set->name && ++renamed == 1)
        diagnostics.warn("OBJECT_NAME holds bytes that are not printable UTF-8; they are replaced "
                         "by '?', here and in what follows.",
                         {file, name.line});
      out.push_back(std::move(*set));
      return {};
    }
    if (!options.keep_going)
      return tl::unexpected(set.error());
    if (++bad <= warnings_max)
      diagnostics.warn(set.error().message + " This set is skipped.", set.error().where);
    return {};
  }));
  if (bad > warnings_max)
    diagnostics.warn(fmt::format("{} more sets are skipped.", bad - warnings_max), {file});
  if (out.empty())
    return fail(ErrorCode::BadInput,
                "holds no complete element set; one OMM message or more was expected", {file});
  return out;
}

} // namespace

ElementsForm form_of_elements(std::string_view text) {
  if (text.starts_with("\xEF\xBB\xBF"))
    text.remove_prefix(3);
  const std::string_view line = take_line(text);
  if (is_first_of_a_set(take_line(text))) // whatever the name above it looks like
    return ElementsForm::Tle;
  if (line.starts_with('<'))
    return ElementsForm::OmmXml;
  if (line.starts_with('{') || line.starts_with('['))
    return ElementsForm::OmmJson;
  if (line.starts_with("CCSDS_"))
    return ElementsForm::OmmKvn;
  if (line.find("MEAN_MOTION") != std::string_view::npos &&
      line.find(',') != std::string_view::npos)
    return ElementsForm::OmmCsv;
  return ElementsForm::Tle;
}

Result<std::vector<ElementSet>> read_elements(std::string_view text, const std::string &file,
                                              const TleOptions &options, Diagnostics &diagnostics) {
  if (text.size() > options.limit_bytes)
    return fail(ErrorCode::BadInput,
                fmt::format("has {} bytes; at most {} are read", text.size(), options.limit_bytes),
                {file});
  if (const auto why = why_no_text(text); why && !has_element_line(text))
    return fail(ErrorCode::BadInput, *why, {file});
  const ElementsForm form = form_of_elements(text);
  if (form == ElementsForm::Tle && !has_element_line(text))
    return fail(ErrorCode::BadInput,
                "holds no orbit that is known: TLE (lines of 69 columns that begin with \"1 \" and "
                "\"2 \") or OMM (KVN, XML, JSON, CSV) was expected",
                {file});
  if (form == ElementsForm::Tle)
    return read_tle(text, file, options, diagnostics);
  if (text.starts_with("\xEF\xBB\xBF"))
    text.remove_prefix(3);
  switch (form) {
  case ElementsForm::OmmXml:
    return read_messages(omm::read_xml, omm::Metadata::Required, text, file, options, diagnostics);
  case ElementsForm::OmmJson:
    return read_messages(omm::read_json, omm::Metadata::Optional, text, file, options, diagnostics);
  case ElementsForm::OmmCsv:
    return read_messages(omm::read_csv, omm::Metadata::Optional, text, file, options, diagnostics);
  default:
    break;
  }
  std::string_view from = text;
  if (const std::string_view line = take_line(from); !line.starts_with("CCSDS_OMM_VERS"))
    return fail(ErrorCode::BadInput,
                fmt::format("is a CCSDS message that begins with \"{}\"; orbits are read from TLE, "
                            "3LE and OMM",
                            line.substr(0, line.find_first_of(" ="))),
                {file});
  return read_messages(omm::read_kvn, omm::Metadata::Required, text, file, options, diagnostics);
}

} // namespace umov
