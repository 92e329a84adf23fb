#include <umov/io/elements_file.h>

#include "io/elements/omm_message.h"

#include <fmt/format.h>
#include <umov/core/text.h>

namespace umov {
namespace {

/// First line that is neither blank nor a comment.
std::string_view first_line(std::string_view text) {
  while (!text.empty()) {
    const std::size_t end = text.find_first_of("\r\n");
    const std::string_view line = trimmed(text.substr(0, end));
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    if (!line.empty() && !line.starts_with('#') && !line.starts_with("COMMENT"))
      return line;
  }
  return {};
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
    return fail(ErrorCode::BadInput, "holds no complete element set", {file});
  return out;
}

} // namespace

ElementsForm form_of_elements(std::string_view text) {
  if (text.starts_with("\xEF\xBB\xBF"))
    text.remove_prefix(3);
  const std::string_view line = first_line(text);
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
  const ElementsForm form = form_of_elements(text);
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
  if (const std::string_view line = first_line(text); !line.starts_with("CCSDS_OMM_VERS"))
    return fail(ErrorCode::BadInput,
                fmt::format("is a CCSDS message that begins with \"{}\"; orbits are read from TLE, "
                            "3LE and OMM",
                            line.substr(0, line.find_first_of(" ="))),
                {file});
  return read_messages(omm::read_kvn, omm::Metadata::Required, text, file, options, diagnostics);
}

} // namespace umov
