#include <umov/jobs/orbit_files.h>

#include "jobs/orbit_file_tables.h"

#include <fmt/format.h>
#include <umov/core/files.h>
#include <umov/io/elements_file.h>
#include <umov/io/trajectory_file.h>
#include <umov/observation/epochs.h>

namespace umov::jobs {
namespace {

Result<std::vector<ElementSet>> read_sets(const OrbitFile &file, const std::string &text,
                                          Diagnostics &diagnostics) {
  UMOV_ASSIGN(sets, read_elements(text, file.path, {file.allow_bad_checksum, file.keep_going},
                                  diagnostics));
  if (file.norad == 0)
    return sets;
  std::erase_if(sets, [&](const ElementSet &set) { return set.norad_cat_id != file.norad; });
  if (sets.empty())
    return fail(ErrorCode::BadInput, fmt::format("holds no object {}", file.norad), {file.path});
  return sets;
}

Result<ElementsForm> wanted_form(const ConversionRequest &request) {
  constexpr std::pair<const char *, ElementsForm> known[] = {
      {"tle", ElementsForm::Tle},      {"3le", ElementsForm::Tle},    {"txt", ElementsForm::Tle},
      {"kvn", ElementsForm::OmmKvn},   {"omm", ElementsForm::OmmKvn}, {"xml", ElementsForm::OmmXml},
      {"json", ElementsForm::OmmJson}, {"csv", ElementsForm::OmmCsv}};
  for (const auto &[text, form] : known)
    if (request.form == text)
      return form;
  return fail(ErrorCode::Usage,
              fmt::format("{}: give --to tle, kvn, xml, json or csv, or a file name that ends so",
                          request.output.empty() ? "no form to write" : "-o " + request.output));
}

/// OPM, OEM, AEM and TDM between KVN and XML.
Result<std::string> converted_message(const ConversionRequest &request, const std::string &text,
                                      Diagnostics &diagnostics) {
  const std::string &name = request.form;
  const bool is_kvn = name == "kvn" || name == "opm" || name == "aem" || name == "tdm";
  if (!is_kvn && name != "xml")
    return fail(
        ErrorCode::Usage,
        "a message is written as KVN or XML: give --to kvn or xml, or a file name that ends "
        "so");
  UMOV_ASSIGN(message, ccsds::read_message(text, request.file.path, diagnostics));
  return ccsds::write_message(message, is_kvn ? ccsds::Form::Kvn : ccsds::Form::Xml);
}

/// Any orbit as an ephemeris: states at even steps in TEME or the frame of its own.
Result<ccsds::Message> sampled_orbit(const ConversionRequest &request, const std::string &text,
                                     Diagnostics &diagnostics) {
  if (!request.start || !request.stop)
    return fail(ErrorCode::Usage, "an ephemeris needs --start and --stop (and --step-s)");
  const Epoch<Utc> start = *request.start, stop = *request.stop;
  const OrbitFile &file = request.file;
  UMOV_ASSIGN(times, time_grid({start, stop, request.step_s}));
  UMOV_ASSIGN(orbit, read_trajectory(
                         text, file.path,
                         {file.norad, start, stop, file.allow_bad_checksum, file.keep_going, true},
                         diagnostics));
  return oem_from(orbit, times, request.written);
}

} // namespace

Result<Table> orbit_file_table(const OrbitFile &file, Diagnostics &diagnostics) {
  UMOV_ASSIGN(text, read_file(file.path));
  if (ccsds::is_message(text)) {
    UMOV_ASSIGN(message, ccsds::read_message(text, file.path, diagnostics));
    return segments_table(message);
  }
  UMOV_ASSIGN(sets, read_sets(file, text, diagnostics));
  return elements_table(sets);
}

Result<std::string> convert_orbit_file(const ConversionRequest &request, Diagnostics &diagnostics) {
  UMOV_ASSIGN(text, read_file(request.file.path));
  if (request.form == "oem") {
    UMOV_ASSIGN(message, sampled_orbit(request, text, diagnostics));
    return ccsds::write_message(message, ccsds::Form::Kvn);
  }
  if (ccsds::is_message(text))
    return converted_message(request, text, diagnostics);
  UMOV_ASSIGN(form, wanted_form(request));
  UMOV_ASSIGN(sets, read_sets(request.file, text, diagnostics));
  return write_elements(sets, form, request.written, diagnostics);
}

} // namespace umov::jobs
