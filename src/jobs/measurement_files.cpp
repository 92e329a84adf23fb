#include <umov/jobs/measurement_files.h>

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <umov/core/text.h>
#include <umov/io/ccsds.h>

namespace umov::jobs {
namespace {

std::string note_of(const MeasurementNotes &from, const char *key, const char *fallback) {
  const auto found = from.notes.find(key);
  return found == from.notes.end() || found->second.empty() ? fallback : found->second;
}

/// Neither what has none nor what was hardly seen: a TDM has no place for an error, and of light in
/// the noise only what chance brightens would have a magnitude.
bool has_magnitude(const Table &stokes, std::size_t row) {
  return std::isfinite(stokes.number("mag", row)) &&
         stokes.text("flags", row).find("faint") == std::string::npos;
}

/// A TDM is of ASCII (CCSDS 503.0-B-2, 4.3): other letters become a question mark each.
std::string ascii(const std::string &text) {
  std::string out;
  for (const char c : text)
    if (const auto byte = static_cast<unsigned char>(c); byte < 0x80)
      out += c;
    else if (byte >= 0xc0) // the first of a letter's bytes
      out += '?';
  return out;
}

/// As many digits behind the point as an error to two of its own has.
int digits_of(double error) {
  if (!(error > 0 && std::isfinite(error)))
    return 4;
  return std::clamp(static_cast<int>(1 - std::floor(std::log10(error))), 0, 9);
}

/// Times without the Z, which some readers of KVN do not take.
std::string epoch_of(const Table &stokes, std::size_t row) {
  std::string text = stokes.text("time_utc", row);
  if (text.ends_with('Z'))
    text.pop_back();
  return text;
}

ccsds::Segment segment_of(const std::string &name, const std::string &band,
                          const MeasurementNotes &notes) {
  ccsds::Segment out;
  const auto put = [&](const char *key, const std::string &text) {
    out.metadata.push_back({key, ascii(text), "", 0});
  };
  put("COMMENT",
      "MAG: " + note_of(notes, "mag_system", "AB") + " magnitude above the air in " + band);
  if (!notes.ecsv.empty())
    put("COMMENT", "Stokes parameters with covariance: " + notes.ecsv);
  put("TIME_SYSTEM", "UTC");
  put("PARTICIPANT_1", note_of(notes, "site", "site"));
  put("PARTICIPANT_2", name.empty() ? std::string("object") : name);
  put("MODE", "SEQUENTIAL");
  put("PATH", "2,1");
  put("ANGLE_TYPE", "RADEC");
  put("REFERENCE_FRAME", "EME2000");
  put("INTEGRATION_REF", "MIDDLE");
  return out;
}

ccsds::Record record_of(const Table &stokes, std::size_t row) {
  ccsds::Record out{"observation", {{"EPOCH", epoch_of(stokes, row), "", 0}}, 0};
  const double ra = stokes.number("ra", row), dec = stokes.number("dec", row);
  if (std::isfinite(ra) && std::isfinite(dec)) {
    out.fields.push_back({"ANGLE_1", fmt::format("{:.7f}", ra), "", 0});
    out.fields.push_back({"ANGLE_2", fmt::format("{:.7f}", dec), "", 0});
  }
  out.fields.push_back({"MAG", fmt::format("{:.5f}", stokes.number("mag", row)), "", 0});
  return out;
}

/// In the order of the repository's template; empty ones are for the observer to fill in.
std::vector<std::string> score_columns() {
  return {"satellite_name",
          "norad_cat_id",
          "observation_time_utc",
          "observation_time_uncertainty_sec",
          "apparent_magnitude",
          "apparent_magnitude_uncertainty",
          "observer_latitude_deg",
          "observer_longitude_deg",
          "observer_altitude_m",
          "limiting_magnitude",
          "instrument",
          "observing_mode",
          "observing_filter",
          "observer_email",
          "observer_orcid",
          "satellite_right_ascension_deg",
          "satellite_declination_deg",
          "sigma_2_ra",
          "sigma_ra_sigma_dec",
          "sigma_2_dec",
          "range_to_satellite_km",
          "range_to_satellite_uncertainty_km",
          "range_rate_of_satellite_km_per_sec",
          "range_rate_of_satellite_uncertainty_km_per_sec",
          "comments",
          "data_archive_link",
          "mpc_code"};
}

} // namespace

Result<std::string> as_tdm(const Table &stokes, const MeasurementNotes &notes) {
  ccsds::Message out;
  out.kind = ccsds::Kind::Tdm;
  out.version = "2.0";
  out.header = {{"CREATION_DATE", notes.created_utc, "", 0}, {"ORIGINATOR", "UMOV", "", 0}};
  std::map<std::pair<std::string, std::string>, std::size_t> known;
  for (std::size_t row = 0; row < stokes.rows(); ++row) {
    if (!has_magnitude(stokes, row))
      continue;
    const std::pair key{stokes.text("name", row), stokes.text("band", row)};
    const auto [at, is_new] = known.try_emplace(key, out.segments.size());
    if (is_new)
      out.segments.push_back(segment_of(key.first, key.second, notes));
    out.segments[at->second].data.push_back(record_of(stokes, row));
  }
  if (out.segments.empty())
    return fail(ErrorCode::BadInput,
                "no row has a magnitude that is more than noise, which is all that "
                "a TDM can hold of light: rows that are \"faint\" have none, nor "
                "those of bands without a zero_flux in the header of the counts");
  return ccsds::write_message(out, ccsds::Form::Kvn);
}

Result<Table> as_score(const Table &stokes, const MeasurementNotes &from) {
  for (const char *key : {"site_lat_deg", "site_lon_deg", "site_alt_m"})
    if (!from.notes.contains(key))
      return fail(ErrorCode::BadInput,
                  fmt::format("the counts do not say where they were taken: add the line \"# {}: "
                              "...\" to their header, as umov observe does",
                              key));
  std::map<std::string, std::vector<std::string>> cells;
  const auto number = [&](const char *column, std::size_t row, const char *form) {
    const double value = stokes.number(column, row);
    return std::isfinite(value) ? fmt::format(fmt::runtime(form), value) : std::string();
  };
  std::size_t rows = 0;
  for (std::size_t row = 0; row < stokes.rows(); ++row) {
    if (!has_magnitude(stokes, row))
      continue;
    ++rows;
    const double relative = stokes.number("I_err", row) / stokes.number("I", row);
    cells["satellite_name"].push_back(stokes.text("name", row));
    cells["norad_cat_id"].push_back(note_of(from, "norad", ""));
    cells["observation_time_utc"].push_back(stokes.text("time_utc", row));
    const double error = 2.5 / std::log(10.) * relative;
    const int digits = digits_of(error);
    cells["apparent_magnitude"].push_back(
        fmt::format("{:.{}f}", stokes.number("mag", row), digits));
    cells["apparent_magnitude_uncertainty"].push_back(fmt::format("{:.{}f}", error, digits));
    cells["observer_latitude_deg"].push_back(note_of(from, "site_lat_deg", ""));
    cells["observer_longitude_deg"].push_back(note_of(from, "site_lon_deg", ""));
    cells["observer_altitude_m"].push_back(note_of(from, "site_alt_m", ""));
    cells["instrument"].push_back(note_of(from, "instrument", ""));
    cells["observing_mode"].push_back("CCD");
    cells["observing_filter"].push_back(stokes.text("band", row));
    cells["satellite_right_ascension_deg"].push_back(number("ra", row, "{:.6f}"));
    cells["satellite_declination_deg"].push_back(number("dec", row, "{:.6f}"));
    cells["range_to_satellite_km"].push_back(number("range", row, "{:.3f}"));
    cells["comments"].push_back(note_of(from, "mag_system", "AB") + " magnitude above the air");
  }
  Table out;
  for (const std::string &name : score_columns()) {
    auto &found = cells[name];
    found.resize(rows);
    out.add(name, "", "", std::move(found));
  }
  return out;
}

Result<std::string> score_text(const Table &stokes, const MeasurementNotes &notes) {
  UMOV_ASSIGN(table, as_score(stokes, notes));
  std::string text = to_csv(table);
  while (text.starts_with('#'))
    text.erase(0, text.find('\n') + 1);
  return text;
}

} // namespace umov::jobs
