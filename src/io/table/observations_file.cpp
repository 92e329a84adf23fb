#include <umov/io/observations_file.h>

#include "io/table/fits_read.h"
#include "io/table/text_table.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <map>
#include <optional>
#include <tuple>
#include <umov/core/text.h>

namespace umov {
namespace {

/// The columns that a file has of those that are understood; -1: none.
struct ObservationColumns {
  int time = -1, mjd = -1, band = -1, site = -1, name = -1, flags = -1, limit = -1, set = -1;
  int flux = -1, flux_err = -1, mag = -1, mag_err = -1;
  int q = -1, u = -1, q_err = -1, u_err = -1, cov_qq = -1, cov_uu = -1, cov_qu = -1;
  double q_unit = 1, u_unit = 1; ///< 0.01 for per cent
  bool is_scattering = false;    ///< q and u are q_scat and u_scat
};

/// A word of a list of flags, however they are parted and written.
bool has_flag(std::string_view flags, std::string_view wanted) {
  const std::string text = lower_case(std::string(flags));
  const auto is_part = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_';
  };
  for (auto begin = text.begin(); begin != text.end();) {
    begin = std::find_if(begin, text.end(), is_part);
    const auto end = std::find_if_not(begin, text.end(), is_part);
    if (std::string_view(begin, end) == wanted)
      return true;
    begin = end;
  }
  return false;
}

class ObservationReader {
public:
  ObservationReader(std::string_view text, const std::string &file, const TextTable &table)
      : text_(text), file_(file), table_(table) {}

  Result<ObservationColumns> columns() const;
  Result<std::optional<ObservedRow>> row(const ObservationColumns &c, std::size_t k);
  [[nodiscard]] std::string_view text(int column, std::size_t k) const {
    return column < 0 ? std::string_view() : table_.cell(k, static_cast<std::size_t>(column));
  }
  [[nodiscard]] Where where(std::size_t k, int column) const {
    return {file_, table_.lines[k],
            column < 0 ? 0
                       : column_of_cell(text_, table_.lines[k], static_cast<std::size_t>(column))};
  }
  [[nodiscard]] std::size_t saturated() const { return saturated_; }

private:
  [[nodiscard]] int find(std::initializer_list<const char *> names) const;
  [[nodiscard]] double scale_of(int column) const;
  Result<double> number(int column, std::size_t k) const;
  Result<double> magnitude(int column, std::size_t k) const;
  Result<bool> limit(const ObservationColumns &c, std::size_t k) const;
  Result<double> error(int column, std::size_t k) const;
  Result<Epoch<Utc>> time(const ObservationColumns &c, std::size_t k) const;
  Result<void> read_polarization(const ObservationColumns &c, std::size_t k,
                                 ObservedRow &out) const;

  std::string_view text_;
  const std::string &file_;
  const TextTable &table_;
  std::size_t saturated_ = 0;
};

int ObservationReader::find(std::initializer_list<const char *> names) const {
  for (const char *name : names) {
    const auto at = std::ranges::find(table_.columns, name);
    if (at != table_.columns.end())
      return static_cast<int>(at - table_.columns.begin());
  }
  return -1;
}

double ObservationReader::scale_of(int column) const {
  if (column < 0)
    return 1;
  const auto unit = table_.units.find(table_.columns[static_cast<std::size_t>(column)]);
  // As FITS writers put it, whose standard knows no sign for it (Pence et al. 2010, 4.3).
  constexpr std::array per_cent = {"%",     "percent", "10**-2", "10**(-2)",
                                   "10^-2", "10^(-2)", "0.01"};
  return unit != table_.units.end() && std::ranges::find(per_cent, unit->second) != per_cent.end()
             ? 0.01
             : 1;
}

Result<ObservationColumns> ObservationReader::columns() const {
  ObservationColumns c;
  c.time = find({"time_utc"});
  c.mjd = find({"mjd_utc", "mjd", "MJD"});
  c.band = find({"band", "filter"});
  c.site = find({"site"});
  c.name = find({"name", "object"});
  c.flags = find({"flags"});
  c.limit = find({"mag_limit"});
  c.set = find({"set_id"});
  c.flux = find({"I", "I_obs", "flux"}); // above the air, where a table has both
  c.flux_err = find({"I_err", "flux_err"});
  c.mag = find({"mag"});
  c.mag_err = find({"mag_err"});
  c.q = find({"q", "q_scat"});
  c.u = find({"u", "u_scat"});
  c.is_scattering = find({"q"}) < 0;
  c.q_err = find({"q_err"});
  c.u_err = find({"u_err"});
  c.cov_qq = find({"cov_qq"});
  c.cov_uu = find({"cov_uu"});
  c.cov_qu = find({"cov_qu"});
  c.q_unit = scale_of(c.q);
  c.u_unit = scale_of(c.u);
  const Where header{file_, table_.header_line};
  const std::string found = fmt::format("{}", fmt::join(table_.columns, ", "));
  if (c.time < 0 && c.mjd < 0)
    return without_column(
        table_, file_,
        fmt::format("no column of time: \"time_utc\" (ISO 8601 with Z) or \"mjd_utc\" (a Julian "
                    "date in UTC less 2400000.5) was expected in the line of names; there "
                    "are {}. Name yours so when it holds that: take 2400000.5 off Julian dates, "
                    "and 69.184 s (since 2017) off TT",
                    printable(found)));
  if (c.flux < 0 && c.mag < 0 && (c.q < 0 || c.u < 0))
    return fail(ErrorCode::BadInput,
                fmt::format("nothing measured: a column \"I\", \"flux\" or \"mag\", or \"q\" and "
                            "\"u\", was expected; there are {}. Name yours so",
                            printable(found)),
                header);
  if ((c.q < 0) != (c.u < 0))
    return fail(ErrorCode::BadInput,
                "q and u go together: one of them is missing; leave both out, or give both",
                header);
  return c;
}

Result<double> ObservationReader::number(int column, std::size_t k) const {
  const std::string_view cell = text(column, k);
  if (cell.empty() || cell == "nan" || cell == "NaN" || cell == "-")
    return std::numeric_limits<double>::quiet_NaN();
  constexpr double most = 1e30; // squares of it are numbers still
  if (const auto value = parse_number(cell); value && std::abs(*value) < most)
    return *value;
  return fail(ErrorCode::BadInput,
              fmt::format("{} = \"{}\": a number was expected, or an empty cell for a gap",
                          table_.columns[static_cast<std::size_t>(column)], printable(cell)),
              where(k, column));
}

Result<double> ObservationReader::magnitude(int column, std::size_t k) const {
  UMOV_ASSIGN(value, number(column, k));
  constexpr double brightest = -40, faintest = 60; // the Sun has -27
  if (value < brightest || value > faintest)
    return fail(ErrorCode::BadInput,
                fmt::format("{} = {}: a magnitude from {} to {} was expected; leave the cell empty "
                            "for a gap",
                            table_.columns[static_cast<std::size_t>(column)], value, brightest,
                            faintest),
                where(k, column));
  return value;
}

/// The magnitude of the row is a limit.
Result<bool> ObservationReader::limit(const ObservationColumns &c, std::size_t k) const {
  if (const auto value = truth_of(std::string(text(c.limit, k))))
    return *value;
  return fail(
      ErrorCode::BadInput,
      fmt::format("mag_limit = \"{}\": True or False was expected", printable(text(c.limit, k))),
      where(k, c.limit));
}

/// A standard deviation or a variance: 0 or more, NaN where there is none.
Result<double> ObservationReader::error(int column, std::size_t k) const {
  UMOV_ASSIGN(value, number(column, k));
  if (value < 0)
    return fail(ErrorCode::BadInput,
                fmt::format("{} = {}: an error is 0 or more; leave the cell empty where it is not "
                            "known",
                            table_.columns[static_cast<std::size_t>(column)], value),
                where(k, column));
  return value;
}

Result<Epoch<Utc>> ObservationReader::time(const ObservationColumns &c, std::size_t k) const {
  if (c.time >= 0) {
    const auto read = utc_from_iso(text(c.time, k));
    return read ? read : fail(ErrorCode::BadInput, read.error().message, where(k, c.time));
  }
  UMOV_ASSIGN(mjd, number(c.mjd, k));
  constexpr double first = 41'317, last = 88'069; // 1972, when UTC began as it is, to 2100
  if (!(mjd >= first && mjd < last))
    return fail(ErrorCode::BadInput,
                fmt::format("{} = \"{}\": a modified Julian date (UTC) between {} and {} was "
                            "expected; is it a Julian date? Take 2400000.5 off",
                            table_.columns[static_cast<std::size_t>(c.mjd)],
                            printable(text(c.mjd, k)), first, last),
                where(k, c.mjd));
  return Epoch<Utc>{2'400'000.5 + std::floor(mjd), mjd - std::floor(mjd)};
}

Result<void> ObservationReader::read_polarization(const ObservationColumns &c, std::size_t k,
                                                  ObservedRow &out) const {
  if (c.q < 0)
    return {};
  UMOV_ASSIGN(q, number(c.q, k));
  UMOV_ASSIGN(u, number(c.u, k));
  if (std::isnan(q) || std::isnan(u))
    return {};
  out.q = q * c.q_unit;
  out.u = u * c.u_unit;
  constexpr double most = 2; // noise alone takes q beyond 1, not so far
  if (std::abs(out.q) > most || std::abs(out.u) > most)
    return fail(ErrorCode::BadInput,
                fmt::format("q = {}, u = {}: parts of I were expected. In per cent? Then give the "
                            "columns the unit %",
                            out.q, out.u),
                where(k, c.q));
  if (c.cov_qq >= 0 && c.cov_uu >= 0) {
    UMOV_ASSIGN(qq, error(c.cov_qq, k));
    UMOV_ASSIGN(uu, error(c.cov_uu, k));
    UMOV_ASSIGN(qu, number(c.cov_qu, k));
    out.cov_qq = qq * c.q_unit * c.q_unit;
    out.cov_uu = uu * c.u_unit * c.u_unit;
    out.cov_qu = std::isnan(qu) ? 0 : qu * c.q_unit * c.u_unit;
    if (out.cov_qu * out.cov_qu > out.cov_qq * out.cov_uu * (1 + 1e-9))
      return fail(ErrorCode::BadInput,
                  fmt::format("cov_qu = {} is larger than sqrt(cov_qq cov_uu) = {}: that is no "
                              "covariance",
                              qu, std::sqrt(qq * uu)),
                  where(k, c.cov_qu));
    return {};
  }
  UMOV_ASSIGN(q_err, error(c.q_err, k));
  UMOV_ASSIGN(u_err, error(c.u_err, k));
  out.cov_qq = q_err * q_err * c.q_unit * c.q_unit;
  out.cov_uu = u_err * u_err * c.u_unit * c.u_unit;
  return {};
}

Result<std::optional<ObservedRow>> ObservationReader::row(const ObservationColumns &c,
                                                          std::size_t k) {
  ObservedRow out;
  out.line = table_.lines[k];
  UMOV_ASSIGN(at, time(c, k));
  out.time = at;
  out.band = text(c.band, k);
  out.site = text(c.site, k);
  if (const auto set = parse_number(text(c.set, k)); set && *set >= 0 && *set < 1e15)
    out.set = static_cast<std::int64_t>(*set);
  if (has_flag(text(c.flags, k), "saturated")) {
    ++saturated_;
    return std::optional<ObservedRow>();
  }
  UMOV_ASSIGN(flux, number(c.flux, k));
  UMOV_ASSIGN(flux_err, error(c.flux_err, k));
  out.flux = flux;
  out.flux_err = flux_err;
  UMOV_ASSIGN(is_limit, limit(c, k));
  if (std::isnan(flux) && !is_limit) {
    UMOV_ASSIGN(mag, magnitude(c.mag, k));
    UMOV_ASSIGN(mag_err, error(c.mag_err, k));
    out.mag = mag;
    out.mag_err = mag_err;
  } else if (!is_limit) { // not what is fitted: what is no number is passed over
    out.mag_beside = parse_number(text(c.mag, k)).value_or(out.mag_beside);
  }
  out.is_limit = is_limit;
  UMOV_TRY(read_polarization(c, k, out));
  if (std::isnan(out.flux) && std::isnan(out.mag) && std::isnan(out.q))
    return std::optional<ObservedRow>();
  return std::optional(std::move(out));
}

/// The frame of q and u: they are not understood without it.
Result<PolarizationFrame> frame_of(const TextTable &table, const ObservationColumns &c,
                                   const std::string &file) {
  if (c.q < 0 || c.is_scattering)
    return PolarizationFrame::Scattering;
  const auto note = table.notes.find("pol_frame");
  const std::string told = note == table.notes.end() ? "" : note->second;
  for (const auto frame :
       {PolarizationFrame::Equatorial, PolarizationFrame::AltAz, PolarizationFrame::Scattering})
    if (told == name_of(frame))
      return frame;
  return fail(ErrorCode::BadInput,
              fmt::format("pol_frame of the header is \"{}\": equatorial, altaz or scattering was "
                          "expected. In a CSV write the line \"# pol_frame: equatorial\" above the "
                          "names of the columns, in a FITS file a card COMMENT pol_frame: "
                          "equatorial",
                          printable(told)),
              {file});
}

/// Rows that go back in time within a band and site: sorting mends it, and whoever mistyped a date
/// wants to know.
void warn_of_order(const ObservationsFile &file, Diagnostics &diagnostics) {
  std::map<std::pair<std::string, std::string>, const ObservedRow *> before;
  std::size_t back = 0, first = 0;
  for (const ObservedRow &row : file.rows) {
    const ObservedRow *&last = before[{row.band, row.site}];
    if (last != nullptr && seconds_between(row.time, last->time) < -1e-6 && ++back == 1)
      first = row.line;
    last = &row;
  }
  if (back > 0)
    diagnostics.warn(fmt::format("{} before the row above in time; all were put in order",
                                 back == 1 ? "1 row lies" : fmt::format("{} rows lie", back)),
                     {file.path, first});
}

/// |q| or |u| above 1 by more than noise takes it there.
bool is_too_polarized(const ObservedRow &row) {
  constexpr double chance = 5; // standard deviations
  const auto is_above = [](double part, double variance) {
    return variance > 0 && std::abs(part) > 1 + chance * std::sqrt(variance);
  };
  return is_above(row.q, row.cov_qq) || is_above(row.u, row.cov_uu);
}

/// The same where no error tells how far that is: what good polarimeters are off at most.
bool is_too_polarized_without_error(const ObservedRow &row) {
  constexpr double accuracy = 0.01;
  const auto is_above = [](double part, double variance) {
    return std::isnan(variance) && std::abs(part) > 1 + accuracy;
  };
  return is_above(row.q, row.cov_qq) || is_above(row.u, row.cov_uu);
}

/// Nothing is measured exactly.
bool has_error_of_0(const ObservedRow &row) {
  return (!std::isnan(row.flux) && row.flux_err == 0) ||
         (!std::isnan(row.mag) && row.mag_err == 0) ||
         (!std::isnan(row.q) && (row.cov_qq == 0 || row.cov_uu == 0));
}

/// Rows that can be read and hardly are what was measured.
void warn_of_values(const ObservationsFile &file, Diagnostics &diagnostics) {
  const auto warn = [&](bool (*is_odd)(const ObservedRow &), const char *what) {
    const auto first = std::ranges::find_if(file.rows, is_odd);
    if (first != file.rows.end())
      diagnostics.warn(
          counted(static_cast<std::size_t>(std::ranges::count_if(file.rows, is_odd)), "row") + what,
          {file.path, first->line});
  };
  warn(is_too_polarized, " with |q| or |u| above 1 by more than five standard deviations: light "
                         "is polarized by no more than all of it. Are they parts of I, and are "
                         "their errors right?");
  warn(is_too_polarized_without_error,
       " with |q| or |u| above 1.01 and no error: light is polarized by no more than all of it. "
       "Are they parts of I? Give their errors in columns q_err and u_err");
  warn(has_error_of_0, " with an error of 0: nothing is measured exactly. Leave the cell empty "
                       "where the error is not known");
}

/// Rows of one object: which one is not ours to choose.
Result<void> check_name(const ObservationReader &reader, const ObservationColumns &c,
                        std::size_t rows) {
  for (std::size_t k = 1; k < rows; ++k)
    if (reader.text(c.name, k) != reader.text(c.name, 0))
      return fail(
          ErrorCode::BadInput,
          fmt::format("a row of \"{}\" after rows of \"{}\": an inversion is of one object; "
                      "keep the rows of one",
                      printable(reader.text(c.name, k)), printable(reader.text(c.name, 0))),
          reader.where(k, c.name));
  return {};
}

bool is_irradiance(const TextTable &table, const ObservationColumns &c) {
  if (c.flux < 0)
    return false;
  const auto unit = table.units.find(table.columns[static_cast<std::size_t>(c.flux)]);
  // FITS has no blanks around the solidus.
  return unit != table.units.end() &&
         (unit->second == "W / (m2 nm)" || unit->second == "W/(m2 nm)");
}

} // namespace

Result<void> check_no_row_twice(const ObservationsFile &out) {
  for (std::size_t k = 1; k < out.rows.size(); ++k) {
    const ObservedRow &a = out.rows[k - 1], &b = out.rows[k];
    if (a.band == b.band && a.site == b.site && std::abs(seconds_between(a.time, b.time)) < 1e-6)
      return fail(ErrorCode::BadInput,
                  fmt::format("a second row for {} in band \"{}\"; the first is line {}. One "
                              "measurement per time, band and site was expected",
                              to_iso(b.time), printable(b.band), a.line),
                  {out.path, b.line});
  }
  return {};
}

Result<ObservationsFile> read_observations_text(std::string_view text, const std::string &file,
                                                Diagnostics &diagnostics) {
  UMOV_ASSIGN(table, is_fits(text) ? read_fits_table(text, file) : read_text_table(text, file));
  if (is_fits(text)) // no lines to look for cells in
    text = {};
  ObservationReader reader(text, file, table);
  if (table.columns.empty() || table.rows() == 0)
    return fail(
        ErrorCode::BadInput,
        "no row of observations: a line of names, as time_utc,band,flux,flux_err, and a row "
        "for each measurement below it were expected",
        {file});
  UMOV_ASSIGN(columns, reader.columns());
  UMOV_TRY(check_name(reader, columns, table.rows()));
  UMOV_TRY(check_polcconv(table, file));
  ObservationsFile out;
  out.path = file;
  out.notes = table.notes;
  out.is_absolute = is_irradiance(table, columns);
  UMOV_ASSIGN(frame, frame_of(table, columns, file));
  out.frame = frame;
  out.rows.reserve(table.rows());
  for (std::size_t k = 0; k < table.rows(); ++k) {
    UMOV_ASSIGN(row, reader.row(columns, k));
    if (row)
      out.rows.push_back(std::move(*row));
  }
  const std::size_t empty = table.rows() - out.rows.size() - reader.saturated();
  if (reader.saturated() > 0)
    diagnostics.warn(
        fmt::format("{} flagged as saturated left out", counted(reader.saturated(), "row")),
        {file});
  if (empty > 0)
    diagnostics.warn(fmt::format("{} without a measurement left out", counted(empty, "row")),
                     {file});
  if (out.rows.empty())
    return fail(ErrorCode::BadInput,
                "no row holds a measurement: all are empty, nan or flagged as saturated", {file});
  warn_of_order(out, diagnostics);
  warn_of_values(out, diagnostics);
  const auto is_before = [](const ObservedRow &a, const ObservedRow &b) {
    const double apart = seconds_between(a.time, b.time);
    return std::abs(apart) < 1e-6 ? std::tie(a.band, a.site) < std::tie(b.band, b.site) : apart < 0;
  };
  if (!std::ranges::is_sorted(out.rows, is_before)) // sorting takes room for half of them
    std::ranges::stable_sort(out.rows, is_before);
  UMOV_TRY(check_no_row_twice(out));
  return out;
}

} // namespace umov
