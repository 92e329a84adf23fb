#include <umov/io/counts_file.h>

#include "io/table/analyser_axes.h"
#include "io/table/fits_read.h"
#include "io/table/text_table.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <fmt/format.h>
#include <map>
#include <optional>
#include <set>
#include <string_view>
#include <tuple>
#include <umov/core/text.h>
#include <utility>
#include <vector>

namespace umov {
namespace {

/// Reads cells by the name of their column.
class CountCells {
public:
  CountCells(const TextTable &table, const std::string &file) : table_(table), file_(file) {
    for (std::size_t c = 0; c < table.columns.size(); ++c)
      places_.emplace(table.columns[c], c);
  }

  [[nodiscard]] Where where(std::size_t row) const { return {file_, table_.lines[row]}; }
  [[nodiscard]] bool has(std::string_view name) const { return places_.contains(name); }
  [[nodiscard]] std::string_view text(std::string_view name, std::size_t row) const {
    const auto at = places_.find(name);
    return at == places_.end() ? std::string_view() : table_.cell(row, at->second);
  }
  /// `fallback` where there is no such column or the cell is empty.
  [[nodiscard]] Result<double> number(std::string_view name, std::size_t row,
                                      double fallback) const {
    const std::string_view cell = text(name, row);
    if (cell.empty())
      return fallback;
    if (cell == "nan" || cell == "NaN")
      return std::nan("");
    if (const auto value = parse_number(cell))
      return *value;
    return fail(ErrorCode::BadInput, fmt::format("{}: \"{}\" is no number", name, printable(cell)),
                where(row));
  }

private:
  const TextTable &table_;
  const std::string &file_;
  std::map<std::string_view, std::size_t> places_;
};

Result<void> check_columns(const CountCells &cells, const TextTable &table,
                           const std::string &file) {
  for (const char *name : {"time_utc", "set_id", "band", "counts", "sky", "sky_err", "var_read",
                           "w0", "w1", "w2", "w3"})
    if (!cells.has(name))
      return without_column(
          table, file,
          fmt::format("counts without the column \"{}\"; umov observe writes all, and "
                      "docs/theory/observing.md says what they are",
                      name));
  return {};
}

/// What a line of the header should hold and does not; null where it does, or says nothing to a
/// reduction.
const char *expected_of(const std::string &key, const std::string &value) {
  const auto number = parse_number(value);
  if (key.starts_with("retardance_deg"))
    return number ? nullptr : "a number";
  if (key == "pupils")
    return value == "separate" || value == "common" ? nullptr : "\"separate\" or \"common\"";
  if (key == "parameters")
    return number && (*number == 1 || *number == 3 || *number == 4)
               ? nullptr
               : "1 (I), 3 (I, Q, U) or 4 (V too)";
  if (key.starts_with("zero_flux"))
    return number && *number > 0 ? nullptr : "a flux above 0 [W m-2 nm-1]";
  if (key == "cloud_time_s")
    return number && *number >= 0 ? nullptr : "a number of seconds";
  const auto lies = [&](double low, double high) {
    return number && *number >= low && *number <= high;
  };
  if (key == "site_lat_deg")
    return lies(-90, 90) ? nullptr : "a latitude from -90 to 90";
  if (key == "site_lon_deg")
    return lies(-360, 360) ? nullptr : "a longitude from -360 to 360, to the east";
  if (key == "site_alt_m") // from the Dead Sea to a balloon
    return lies(-500, 1e5) ? nullptr : "a height of -500 to 100000 m";
  return nullptr;
}

/// The key that a reduction knows and that differs from this one by small and capital letters
/// alone; null for others.
const char *known_as(std::string_view key) {
  constexpr std::array known{"pol_frame",    "POLCCONV",     "mag_system",
                             "pupils",       "parameters",   "cloud_time_s",
                             "site_lat_deg", "site_lon_deg", "site_alt_m"};
  const auto is_like = [key](std::string_view one) {
    return key != one && std::ranges::equal(key, one, [](unsigned char a, unsigned char b) {
             return std::tolower(a) == std::tolower(b);
           });
  };
  const auto found = std::ranges::find_if(known, is_like);
  return found == known.end() ? nullptr : *found;
}

/// What the header says of the frame, which the fit takes for granted.
Result<void> check_notes(const TextTable &table, const std::string &file) {
  constexpr std::array frames{"equatorial", "altaz", "scattering"};
  const auto told = table.notes.find("pol_frame");
  if (told != table.notes.end() && std::ranges::find(frames, told->second) == frames.end())
    return fail(ErrorCode::BadInput,
                fmt::format("pol_frame of the header is \"{}\": {} was expected",
                            printable(told->second), fmt::join(frames, ", ")),
                {file});
  constexpr std::array systems{"AB", "ST", "Vega"};
  const auto system = table.notes.find("mag_system");
  if (system != table.notes.end() && std::ranges::find(systems, system->second) == systems.end())
    return fail(ErrorCode::BadInput,
                fmt::format("mag_system of the header is \"{}\": {} was expected",
                            printable(system->second), fmt::join(systems, ", ")),
                {file});
  for (const auto &[key, value] : table.notes)
    if (const char *expected = expected_of(key, value))
      return fail(ErrorCode::BadInput,
                  fmt::format("{} of the header is \"{}\": {} was expected", printable(key),
                              printable(value), expected),
                  {file});
  return check_polcconv(table, file);
}

/// Lines of the header that say nothing: keys in other letters, and zeros of no band of the rows
/// where a band of them has none (others are of a table from which bands were taken out).
void warn_of_notes(const CountsFile &counts, const std::string &file, Diagnostics &diagnostics) {
  for (const auto &note : counts.notes)
    if (const char *known = known_as(note.first))
      diagnostics.warn(fmt::format("\"{}\" of the header says nothing; \"{}\" would",
                                   printable(note.first), known),
                       {file});
  const std::string start = "zero_flux";
  const auto bare = std::ranges::find_if(counts.rows, [&](const CountRow &row) {
    return !counts.notes.contains(start + " " + row.band);
  });
  if (bare == counts.rows.end())
    return;
  for (const auto &note : counts.notes)
    if (const std::string &key = note.first;
        key.starts_with(start) && std::ranges::none_of(counts.rows, [&](const CountRow &row) {
          return key == start + " " + row.band;
        }))
      diagnostics.warn(fmt::format("{} of the header is of no band of the counts; \"zero_flux {}\" "
                                   "was expected",
                                   printable(key), printable(bare->band)),
                       {file});
}

Result<bool> truth_in(const CountCells &cells, const std::string &name, std::size_t row) {
  if (const auto value = truth_of(std::string(cells.text(name, row))))
    return *value;
  return fail(ErrorCode::BadInput,
              fmt::format("{} = \"{}\"; True or False was expected", name,
                          printable(cells.text(name, row))),
              cells.where(row));
}

Result<void> read_numbers(const CountCells &cells, std::size_t row, CountRow &out) {
  struct Field {
    const char *name;
    double *value;
  };
  double exposure = 0, set = 0;
  const Field fields[] = {{"counts", &out.counts},
                          {"sky", &out.sky},
                          {"sky_err", &out.sky_err},
                          {"var_read", &out.var_read},
                          {"excess2", &out.excess2},
                          {"scint_sd", &out.scintillation},
                          {"x_axis_pa", &out.x_axis_pa_deg},
                          {"phase_angle", &out.phase_angle_deg},
                          {"pa_scat", &out.pa_scat_deg},
                          {"airmass", &out.airmass},
                          {"k_mag", &out.k_mag},
                          {"plate_deg", &out.plate_deg},
                          {"ra", &out.ra_deg},
                          {"dec", &out.dec_deg},
                          {"range", &out.range_km},
                          {"w0", &out.row[0]},
                          {"w1", &out.row[1]},
                          {"w2", &out.row[2]},
                          {"w3", &out.row[3]},
                          {"exposure", &exposure},
                          {"set_id", &set}};
  // A count that is not there is none of 0.
  out.sky_err = out.var_read = std::nan(""); // nor is a variance
  out.counts = out.sky = out.row[0] = out.row[1] = out.row[2] = out.row[3] = std::nan("");
  for (const Field &field : fields) {
    UMOV_ASSIGN(value, cells.number(field.name, row, *field.value));
    *field.value = value;
  }
  // It checks the answers alone: who calls beams H and V here has told no angle.
  out.analyser_deg = parse_number(cells.text("analyser_deg", row)).value_or(std::nan(""));
  constexpr double whole_max = 1e15;
  for (const auto &[name, value] : {std::pair{"exposure", exposure}, {"set_id", set}})
    if (!(std::abs(value) < whole_max && value == std::floor(value)))
      return fail(ErrorCode::BadInput,
                  fmt::format("{} = {}; a whole number was expected", name, value),
                  cells.where(row));
  out.exposure = static_cast<std::int64_t>(exposure);
  out.set = static_cast<std::int64_t>(set);
  return {};
}

/// Of the plate in a band, by a line "retardance_deg BAND" or "retardance_deg" of the header.
double retardance_in(const std::map<std::string, std::string> &notes, const std::string &band) {
  for (const std::string &key : {"retardance_deg " + band, std::string("retardance_deg")})
    if (const auto told = notes.find(key); told != notes.end())
      if (const auto value = parse_number(told->second))
        return *value;
  constexpr double half_wave = 180;
  return half_wave;
}

constexpr double too_large = 1e100; // squares of less are numbers still

/// w0 to w3 of a row.
Result<void> check_response(const StokesRow &w, const Where &where) {
  for (const double one : w)
    if (!(std::abs(one) < too_large))
      return fail(ErrorCode::BadInput, "w0 to w3 are numbers; some are missing or too large",
                  where);
  if (!(w[0] > 0))
    return fail(ErrorCode::BadInput,
                fmt::format("w0 = {}; light must make counts: a number above 0 was expected", w[0]),
                where);
  // Measured rows are good to some per cent, and rows are typed to two digits.
  constexpr double rounding = 1.05;
  if (const double polarized = std::hypot(w[1], w[2], w[3]); polarized > rounding * w[0])
    return fail(ErrorCode::BadInput,
                fmt::format("w1 = {:g}, w2 = {:g}, w3 = {:g} are together {:.3g} of w0 = {:g}: "
                            "light polarized across would make less than no counts; at most 1 was "
                            "expected. An analyser takes half of unpolarized light: w0 = 0.5",
                            w[1], w[2], w[3], polarized / w[0], w[0]),
                where);
  return {};
}

Result<void> check_row(const CountRow &row, const Where &where) {
  if (!(row.var_read >= 0 && row.sky_err >= 0 && row.excess2 >= 1))
    return fail(ErrorCode::BadInput,
                fmt::format("var_read = {}, sky_err = {}, excess2 = {}; variances are 0 or more, "
                            "excess2 1 or more",
                            row.var_read, row.sky_err, row.excess2),
                where);
  if (!(row.scintillation >= 0 && std::isfinite(row.scintillation)))
    return fail(ErrorCode::BadInput,
                fmt::format("scint_sd = {}; 0 or more was expected", row.scintillation), where);
  if (!(std::abs(row.counts) < too_large && std::abs(row.sky) < too_large))
    return fail(ErrorCode::BadInput,
                fmt::format("counts = {}, sky = {}; counts of electrons were expected", row.counts,
                            row.sky),
                where);
  if (std::abs(row.dec_deg) > 90 || std::abs(row.ra_deg) > 360 || row.range_km < 0)
    return fail(
        ErrorCode::BadInput,
        fmt::format("ra = {}, dec = {}, range = {}; degrees up to 360 and 90 and a distance "
                    "in km were expected, or empty cells",
                    row.ra_deg, row.dec_deg, row.range_km),
        where);
  if (row.airmass < 0)
    return fail(ErrorCode::BadInput,
                fmt::format("airmass = {}; 1 or more was expected, or an empty cell", row.airmass),
                where);
  if (row.phase_angle_deg < 0 || row.phase_angle_deg > 180)
    return fail(ErrorCode::BadInput,
                fmt::format("phase_angle = {}; 0 to 180 degrees were expected, or an empty cell",
                            row.phase_angle_deg),
                where);
  // At the Earth's surface light of 300 nm loses four, and a fit may find a little less than none.
  if (row.k_mag < -1 || row.k_mag > 20)
    return fail(
        ErrorCode::BadInput,
        fmt::format("k_mag = {}; -1 to 20 magnitudes per air mass were expected (0.1 to 0.5 "
                    "as a rule), or an empty cell",
                    row.k_mag),
        where);
  return check_response(row.row, where);
}

/// Rows of one time, among which none may stand twice: a set would count its light twice.
class RowsOfATime {
public:
  /// Whether a row is the same as one before it: a channel of its exposure, or without names of
  /// channels or numbers of exposures the same in every number.
  bool has_twice(const CountRow &row, bool has_exposures) {
    if (seconds_between(row.time, time_) != 0)
      seen_.clear();
    time_ = row.time;
    const auto [w0, w1, w2, w3] = row.row;
    const auto numbers = row.channel.empty() || !has_exposures
                             ? std::array{row.counts, row.sky, w0, w1, w2, w3}
                             : std::array<double, 6>{};
    const std::int64_t exposure = has_exposures ? row.exposure : 0;
    return !seen_.insert({row.name, row.band, row.channel, row.set, exposure, numbers}).second;
  }

private:
  Epoch<Utc> time_{};
  std::set<std::tuple<std::string, std::string, std::string, std::int64_t, std::int64_t,
                      std::array<double, 6>>>
      seen_;
};

/// Times of an object, which may not go back from row to row, nor within a band where rows of
/// others come between.
class RisingTimes {
public:
  /// The time before a row that is later than its own.
  std::optional<Epoch<Utc>> later_than(const CountRow &row) {
    const auto is_back = [&](Epoch<Utc> from) { return seconds_between(row.time, from) < -1e-6; };
    const Epoch<Utc> last = std::exchange(last_, row.time);
    if (std::exchange(name_, row.name) == row.name && !latest_.empty() && is_back(last))
      return last;
    const auto [at, is_first] = latest_.try_emplace({row.name, row.band}, row.time);
    if (is_first)
      return std::nullopt;
    if (is_back(at->second))
      return at->second;
    at->second =
        std::max(at->second, row.time, [](auto a, auto b) { return seconds_between(a, b) < 0; });
    return std::nullopt;
  }

private:
  Epoch<Utc> last_{};
  std::string name_;
  std::map<std::pair<std::string, std::string>, Epoch<Utc>> latest_; ///< by name and band
};

/// Sets of an object in a band, each of which is one piece of the table: tables that were put
/// together begin their numbers again, and light of two nights would be one set.
class SetsInARow {
public:
  /// The set after which this row's comes a second time.
  std::optional<std::int64_t> broken_by(const CountRow &row) {
    Sets &sets = sets_[{row.name, row.band}];
    if (!sets.seen.empty() && sets.last == row.set)
      return std::nullopt;
    const std::int64_t before = std::exchange(sets.last, row.set);
    return sets.seen.insert(row.set).second ? std::nullopt : std::optional(before);
  }

private:
  struct Sets {
    std::set<std::int64_t> seen;
    std::int64_t last = 0;
  };
  std::map<std::pair<std::string, std::string>, Sets> sets_; ///< by name and band
};

/// What rows of a table are to each other: times rise, sets stand together, nothing comes twice.
class RowOrder {
public:
  Result<void> check(const CountRow &row, bool has_exposures, const Where &where) {
    if (const auto before = rising_.later_than(row))
      return fail(ErrorCode::BadInput,
                  fmt::format("times go back, from {} to {}; sort the rows by time",
                              to_iso(*before), to_iso(row.time)),
                  where);
    if (const auto between = sets_.broken_by(row))
      return fail(ErrorCode::BadInput,
                  fmt::format("set_id = {} again after rows of set {}{}: rows of a set follow each "
                              "other. Where tables were put together, number the sets of each on "
                              "from the last of the one before",
                              row.set, *between,
                              row.name.empty() ? "" : " of " + printable(row.name)),
                  where);
    if (rows_of_time_.has_twice(row, has_exposures))
      return fail(
          ErrorCode::BadInput,
          row.channel.empty() || !has_exposures
              ? std::string("the same row a second time; take one of them out")
              : fmt::format("channel \"{}\" a second time in this exposure; take one of them "
                            "out",
                            printable(row.channel)),
          where);
    return {};
  }

private:
  RowsOfATime rows_of_time_;
  RisingTimes rising_;
  SetsInARow sets_;
};

/// Numbers of exposures where a table has none: rows of one time are one, unless a channel comes
/// again. Sequences of analysers at times of their own are several, each with its own scintillation
/// and cloud.
class ExposureNumbers {
public:
  std::int64_t next(const CountRow &row) {
    const bool is_new =
        seconds_between(row.time, time_) != 0 || row.name != name_ || row.band != band_ ||
        (!row.channel.empty() && std::ranges::find(channels_, row.channel) != channels_.end());
    if (is_new) {
      ++number_;
      channels_.clear();
    }
    time_ = row.time;
    name_ = row.name;
    band_ = row.band;
    channels_.push_back(row.channel);
    return number_;
  }

private:
  Epoch<Utc> time_{};
  std::string name_, band_;
  std::vector<std::string> channels_;
  std::int64_t number_ = -1;
};

/// Electrons are no fewer than none but for what reading does.
bool is_below_nothing(const CountRow &row) {
  constexpr double deviations = 5;
  return row.counts < -deviations * std::sqrt(row.var_read + 1);
}

/// Rows that are left out: for want of counts, or of the sky beside them.
struct Dropped {
  std::size_t without_counts = 0, without_sky = 0;
};

void warn_of_rows(const Dropped &dropped, std::size_t negative, std::size_t all,
                  const std::string &file, Diagnostics &diagnostics) {
  for (const auto &[number, what] : {std::pair{dropped.without_counts, "counts"},
                                     {dropped.without_sky, "sky (0 where none was taken off)"}})
    if (number > 0)
      diagnostics.warn(
          fmt::format("{} of {} left out: without {}", number, counted(all, "row"), what), {file});
  if (negative > 0)
    diagnostics.warn(fmt::format("{} of {} below 0 by more than reading does: counts hold the sky, "
                                 "and no bias; was one of them taken off twice?",
                                 negative, counted(all, "count")),
                     {file});
}

} // namespace

Result<CountsFile> read_counts_text(std::string_view text, const std::string &file,
                                    Diagnostics &diagnostics) {
  UMOV_ASSIGN(table, is_fits(text) ? read_fits_table(text, file) : read_text_table(text, file));
  if (table.columns.empty())
    return fail(ErrorCode::BadInput, "holds no table: names of columns and rows were expected",
                {file});
  const CountCells cells(table, file);
  UMOV_TRY(check_columns(cells, table, file));
  UMOV_TRY(check_notes(table, file));
  CountsFile out;
  out.notes = table.notes;
  Dropped dropped;
  std::size_t negative = 0;
  RowOrder order;
  ExposureNumbers exposures;
  const bool has_exposures = cells.has("exposure");
  std::vector<std::size_t> lines;
  out.rows.reserve(table.rows());
  Epoch<Utc> time{};
  for (std::size_t k = 0; k < table.rows(); ++k) {
    CountRow row;
    const std::string_view stamp = cells.text("time_utc", k);
    if (k == 0 || stamp != cells.text("time_utc", k - 1)) { // channels share a time
      const auto read = utc_from_iso(stamp);
      if (!read)
        return fail(ErrorCode::BadInput, read.error().message, cells.where(k));
      time = *read;
    }
    row.time = time;
    row.name = cells.text("name", k);
    row.band = cells.text("band", k);
    row.channel = cells.text("channel", k);
    UMOV_ASSIGN(is_saturated, truth_in(cells, "saturated", k));
    row.is_saturated = is_saturated;
    UMOV_TRY(read_numbers(cells, k, row));
    if (!has_exposures)
      row.exposure = exposures.next(row);
    row.retardance_deg = retardance_in(out.notes, row.band);
    if (!std::isfinite(row.counts) || !std::isfinite(row.sky)) {
      ++(std::isfinite(row.counts) ? dropped.without_sky : dropped.without_counts);
      continue;
    }
    UMOV_TRY(check_row(row, cells.where(k)));
    UMOV_TRY(order.check(row, has_exposures, cells.where(k)));
    negative += is_below_nothing(row) ? 1u : 0u;
    out.rows.push_back(std::move(row));
    lines.push_back(table.lines[k]);
  }
  warn_of_rows(dropped, negative, table.rows(), file, diagnostics);
  if (out.rows.empty())
    return fail(ErrorCode::BadInput,
                dropped.without_sky > 0
                    ? "no row with sky; beside each count it was expected, 0 where there is none"
                    : "no row of counts; some were expected below the names",
                {file});
  warn_of_notes(out, file, diagnostics);
  warn_of_analysers(out, lines, cells.has("x_axis_pa"), file, diagnostics);
  return out;
}

} // namespace umov
