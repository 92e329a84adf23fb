#include "jobs/observations_tdm.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <optional>
#include <umov/core/text.h>
#include <umov/io/ccsds.h>

namespace umov::jobs {
namespace {

std::string value_of(const std::vector<ccsds::Field> &fields, std::string_view key) {
  const ccsds::Field *const found = ccsds::find(fields, key);
  return found == nullptr ? std::string() : found->text;
}

/// The band that a segment tells in a comment, as umov reduce writes it: "MAG: AB magnitude above
/// the air in nm:550"; "" where none does.
std::string band_of(const ccsds::Segment &segment) {
  constexpr std::string_view before = "MAG: AB magnitude above the air in ";
  for (const ccsds::Field &field : segment.metadata)
    if (field.key == "COMMENT" && field.text.starts_with(before))
      return field.text.substr(before.size());
  return {};
}

Result<void> check(const ccsds::Segment &segment, const std::string &object,
                   const std::string &file) {
  const std::string system = value_of(segment.metadata, "TIME_SYSTEM");
  if (system != "UTC") {
    const ccsds::Field *const at = ccsds::find(segment.metadata, "TIME_SYSTEM");
    return fail(ErrorCode::BadInput,
                fmt::format("TIME_SYSTEM = {}: UTC was expected for an inversion; write its times "
                            "as UTC",
                            printable(system)),
                {file, at == nullptr ? 0 : at->line});
  }
  const std::string name = value_of(segment.metadata, "PARTICIPANT_2");
  if (name != object)
    return fail(ErrorCode::BadInput,
                fmt::format("a segment of \"{}\" after one of \"{}\": an inversion is of one "
                            "object; keep the segments of one",
                            printable(name), printable(object)),
                {file, segment.metadata.empty() ? 0 : segment.metadata.front().line});
  return {};
}

Result<std::optional<ObservedRow>> row_of(const ccsds::Record &record, const std::string &band,
                                          const std::string &file) {
  const ccsds::Field *const magnitude = ccsds::find(record.fields, "MAG");
  if (record.name != "observation" || magnitude == nullptr)
    return std::optional<ObservedRow>();
  ObservedRow out;
  out.band = band;
  out.line = magnitude->line != 0 ? magnitude->line : record.line;
  std::string time = value_of(record.fields, "EPOCH");
  if (!time.ends_with('Z'))
    time += 'Z'; // TIME_SYSTEM has said so
  const auto at = utc_from_iso(time);
  if (!at)
    return fail(ErrorCode::BadInput, at.error().message, {file, out.line});
  out.time = *at;
  const auto value = parse_number(magnitude->text);
  constexpr double brightest = -40, faintest = 60; // the Sun has -27
  if (!value || !(*value > brightest && *value < faintest))
    return fail(ErrorCode::BadInput,
                fmt::format("MAG = {}: a magnitude from {} to {} was expected",
                            printable(magnitude->text), brightest, faintest),
                {file, out.line});
  out.mag = *value;
  return std::optional(std::move(out));
}

} // namespace

Result<ObservationsFile> observations_of_tdm(std::string_view text, const std::string &file,
                                             Diagnostics &diagnostics) {
  UMOV_ASSIGN(message, ccsds::read_message(text, file, diagnostics));
  if (message.kind != ccsds::Kind::Tdm)
    return fail(
        ErrorCode::BadInput,
        fmt::format("is a CCSDS {}; a TDM with MAG was expected, or a table of observations",
                    ccsds::to_text(message.kind)),
        {file});
  ObservationsFile out;
  out.path = file;
  out.is_absolute = true; // magnitudes are
  out.frame = PolarizationFrame::Scattering;
  for (const ccsds::Segment &segment : message.segments) {
    UMOV_TRY(check(segment, value_of(message.segments.front().metadata, "PARTICIPANT_2"), file));
    const std::string band = band_of(segment);
    for (const ccsds::Record &record : segment.data) {
      UMOV_ASSIGN(row, row_of(record, band, file));
      if (row)
        out.rows.push_back(std::move(*row));
    }
  }
  if (out.rows.empty())
    return fail(ErrorCode::BadInput, "no observation has a MAG: there is no light in it", {file});
  std::ranges::stable_sort(out.rows, [](const ObservedRow &a, const ObservedRow &b) {
    const double apart = seconds_between(a.time, b.time);
    return std::abs(apart) < 1e-6 ? a.band < b.band : apart < 0;
  });
  UMOV_TRY(check_no_row_twice(out));
  return out;
}

} // namespace umov::jobs
