#include "jobs/period_search.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <umov/core/text.h>

namespace umov::jobs {
namespace {

/// A band has magnitudes beside its fluxes: those are what people know.
bool has_magnitudes_beside(const ObservationsFile &file, const std::string &band) {
  return std::ranges::any_of(file.rows, [&](const ObservedRow &row) {
    return row.band == band && std::isfinite(row.mag_beside);
  });
}

/// What a row says of brightness; NaN where it says nothing, or only that it is less.
double magnitude_of(const ObservedRow &row, bool is_beside) {
  if (row.is_limit)
    return std::nan("");
  if (is_beside && std::isfinite(row.flux))
    return row.mag_beside;
  return row.flux > 0 ? -2.5 * std::log10(row.flux) : row.mag;
}

void add_stretches(const ObservationsFile &file, const std::string &band, double gap_s,
                   std::vector<Stretch> &out) {
  const std::size_t before = out.size();
  const bool is_beside = has_magnitudes_beside(file, band);
  for (const ObservedRow &row : file.rows) {
    const double magnitude = magnitude_of(row, is_beside);
    if (row.band != band || !std::isfinite(magnitude))
      continue;
    const bool is_first = out.size() == before;
    const double seconds = is_first ? 0 : seconds_between(row.time, out.back().begin);
    if (is_first || seconds - out.back().seconds.back() > gap_s) {
      out.push_back({band, row.time, {0}, {magnitude}, row.flux > 0 && !is_beside});
    } else {
      out.back().seconds.push_back(seconds);
      out.back().magnitudes.push_back(magnitude);
    }
  }
}

std::vector<std::string> bands_of(const ObservationsFile &file) {
  std::vector<std::string> out;
  for (const ObservedRow &row : file.rows)
    if (std::ranges::find(out, row.band) == out.end())
      out.push_back(row.band);
  return out;
}

Result<std::vector<std::string>> wanted_bands(const ObservationsFile &observations,
                                              const std::string &band) {
  std::vector<std::string> bands = bands_of(observations);
  if (band.empty())
    return bands;
  if (std::ranges::find(bands, band) == bands.end())
    return fail(ErrorCode::BadInput,
                fmt::format("holds no band \"{}\"; it has {}", printable(band),
                            bands == std::vector<std::string>{""}
                                ? "no column \"band\": leave --band out"
                                : printable(fmt::format("{}", fmt::join(bands, ", ")))),
                {observations.path});
  return std::vector<std::string>{band};
}

/// The longest periods that are tried take more than any peak.
bool is_slow(const Periodogram &found, const std::vector<PeriodPeak> &peaks) {
  return !found.power.empty() && (peaks.empty() || found.power.front() > peaks.front().power);
}

/// What a peak is, in words.
std::string meaning_of(const PeakRelation &relation) {
  using Kind = PeakRelation::Kind;
  const std::string of = fmt::format("rank {}", relation.to + 1);
  if (relation.kind == Kind::Own)
    return "period";
  if (relation.kind == Kind::Sampling)
    return "alias of " + of;
  if (relation.ratio == 2 || relation.ratio == 0.5)
    return (relation.ratio == 2 ? "twice " : "half of ") + of;
  return relation.ratio > 1.6   ? fmt::format("{:g} times {}", relation.ratio, of)
         : relation.ratio > 1.4 ? "3/2 of " + of
         : relation.ratio > 0.6 ? "2/3 of " + of
                                : fmt::format("1/{:g} of {}", 1 / relation.ratio, of);
}

/// Rows of the answer, column by column.
struct PeriodRows {
  std::vector<std::string> time, band, meaning;
  std::vector<std::int64_t> epochs, rank;
  std::vector<double> span, period, error, power, false_alarm;
  std::vector<const Stretch *> stretch;

  void add(const Stretch &of, std::span<const PeriodPeak> peaks) {
    const std::vector<PeakRelation> relations = relate_peaks(peaks, of.seconds);
    for (std::size_t k = 0; k < peaks.size(); ++k) {
      time.push_back(to_iso(of.begin));
      band.push_back(of.band);
      epochs.push_back(static_cast<std::int64_t>(of.seconds.size()));
      rank.push_back(static_cast<std::int64_t>(k + 1));
      span.push_back(of.seconds.back());
      period.push_back(peaks[k].period_s);
      error.push_back(peaks[k].period_err_s);
      power.push_back(peaks[k].power);
      false_alarm.push_back(peaks[k].false_alarm);
      meaning.push_back(meaning_of(relations[k]));
      stretch.push_back(&of);
    }
  }

  /// The row of the surest highest peak.
  [[nodiscard]] std::size_t surest() const {
    std::size_t best = 0;
    for (std::size_t k = 0; k < rank.size(); ++k)
      if (rank[k] == 1 && (false_alarm[k] < false_alarm[best] ||
                           (false_alarm[k] == false_alarm[best] && power[k] > power[best])))
        best = k;
    return best;
  }
  /// What that peak is.
  [[nodiscard]] SurestPeak surest_peak() const {
    const std::size_t k = surest();
    return {stretch[k], period[k],
            band[k].empty() ? "" : fmt::format(" ({}, {})", printable(band[k]), time[k])};
  }
};

Table table_of(PeriodRows &&rows, const PeriodRequest &request, const std::string &path) {
  Table out;
  out.note("what", "periods that the light of " + path + " shows, by Lomb-Scargle");
  const SurestPeak best = rows.surest_peak();
  out.note("spin",
           describe(repetition_of(*best.stretch, best.period_s, request.false_alarm), best.where));
  out.note("synodic", "they are of the light as the observer saw it: a spin is off by the turn of "
                      "the bisector of Sun and observer, and two like sides show half of it");
  out.add("time_utc", "", "begin of the stretch", std::move(rows.time));
  out.add("band", "", "band", std::move(rows.band));
  out.add("epochs", "", "brightnesses in the stretch", std::move(rows.epochs));
  out.add("span", "s", "from the first to the last", std::move(rows.span));
  out.add("rank", "", "1: the highest peak", std::move(rows.rank));
  out.add("period", "s", "of the peak", std::move(rows.period));
  out.add("period_err", "s", "standard deviation, if what the sine leaves is noise",
          std::move(rows.error));
  out.add("power", "", "part of the variance that a sine of that period takes",
          std::move(rows.power));
  out.add("false_alarm", "",
          "chance that white noise has a peak as high; of lower ranks an upper bound, since the "
          "higher peaks count as noise",
          std::move(rows.false_alarm));
  out.add("meaning", "",
          "period; part or multiple of a higher peak; alias: made of one by the times",
          std::move(rows.meaning));
  out.set_precision("span", {"", 3, 0});
  out.set_precision("period", {"period_err", 0, 0});
  out.set_precision("period_err", {"", 0, 2});
  out.set_precision("power", {"", 4, 0});
  out.set_precision("false_alarm", {"", 0, 3});
  return out;
}

/// What a search through all stretches found, and what stood in its way.
struct Findings {
  PeriodRows rows;
  std::size_t too_few = 0, too_slow = 0, noisy = 0; ///< stretches
  double surest = 1;                                ///< chance that noise has a peak as high
  double cut_s = 0;                                 ///< periods below were not looked at

  void look_at(const Stretch &one, const PeriodRequest &request) {
    constexpr std::size_t all = 1000;
    const Periodogram found = periodogram(one.seconds, one.magnitudes);
    if (found.is_cut)
      cut_s = std::max(cut_s, found.period_s.back());
    auto peaks = highest_peaks(found, one.seconds, all);
    too_slow += is_slow(found, peaks) ? 1u : 0u;
    std::erase_if(peaks, [&](const PeriodPeak &peak) {
      return peak.period_s < request.shortest_s || peak.period_s > request.longest_s;
    });
    peaks.resize(std::min(peaks.size(), request.peaks));
    too_few += peaks.empty() ? 1u : 0u;
    const bool had_peaks = !peaks.empty();
    if (had_peaks)
      surest = std::min(surest, peaks.front().false_alarm);
    std::erase_if(peaks,
                  [&](const PeriodPeak &peak) { return peak.false_alarm > request.false_alarm; });
    noisy += had_peaks && peaks.empty() ? 1u : 0u;
    rows.add(one, peaks);
  }
};

void warn_of_search(const Findings &found, const PeriodRequest &request, const std::string &path,
                    Diagnostics &diagnostics) {
  if (found.too_slow > 0)
    diagnostics.warn(
        fmt::format("in {} most of the change is slower than half the stretch: a trend, "
                    "or a period too long to be told; the peaks listed are what is "
                    "left",
                    counted(found.too_slow, "stretch", "stretches")),
        {path});
  if (found.cut_s > request.shortest_s)
    diagnostics.warn(fmt::format("a stretch is so long that periods below {:.4g} s were not looked "
                                 "at; a shorter --gap-s makes more and shorter stretches of it",
                                 found.cut_s),
                     {path});
}

/// Rows that say something of brightness of which no magnitude can be made: without them the
/// faintest part of the curve is missing, and that changes which period is seen.
void warn_of_rows_without_magnitude(const ObservationsFile &file,
                                    const std::vector<std::string> &bands,
                                    Diagnostics &diagnostics) {
  std::size_t no_light = 0, limits = 0, line = 0;
  for (const std::string &band : bands) {
    const bool is_beside = has_magnitudes_beside(file, band);
    for (const ObservedRow &row : file.rows) {
      if (row.band != band || std::isfinite(magnitude_of(row, is_beside)))
        continue;
      if (row.is_limit)
        ++limits;
      else if (std::isfinite(row.flux) && ++no_light == 1)
        line = row.line;
    }
  }
  if (no_light > 0)
    diagnostics.warn(fmt::format("{} left out: a flux of 0 or less, or none in magnitudes where "
                                 "others have one. The search is of magnitudes, and the faintest "
                                 "part of the curve has no share in it; means of several rows "
                                 "above 0 would",
                                 counted(no_light, "row", "rows")),
                     {file.path, line});
  if (limits > 0)
    diagnostics.warn(fmt::format("{} left out: limits of brightness (mag_limit), fainter than "
                                 "told",
                                 counted(limits, "row", "rows")),
                     {file.path});
}

void warn_of_left_out(const Findings &found, const std::string &path, Diagnostics &diagnostics) {
  if (found.noisy > 0)
    diagnostics.warn(fmt::format("{} whose peaks do not stand out of noise, left out",
                                 counted(found.noisy, "stretch", "stretches")),
                     {path});
  if (found.too_few > 0)
    diagnostics.warn(fmt::format("{} with fewer than twelve brightnesses, or with no peak in the "
                                 "range asked for, left out",
                                 counted(found.too_few, "stretch", "stretches")),
                     {path});
}

/// Peaks of all stretches; at least one. Warnings go to `diagnostics`, where it is given.
Result<Findings> search(const std::vector<Stretch> &stretches, const PeriodRequest &request,
                        const std::string &path, Diagnostics *diagnostics = nullptr) {
  if (!(request.shortest_s < request.longest_s))
    return fail(ErrorCode::Usage, fmt::format("periods from {:g} to {:g} s: none lies between",
                                              request.shortest_s, request.longest_s));
  Findings found;
  for (const Stretch &one : stretches)
    found.look_at(one, request);
  if (diagnostics != nullptr)
    warn_of_search(found, request, path, *diagnostics);
  if (found.rows.period.empty() && found.noisy > 0)
    return fail(
        ErrorCode::Nothing,
        fmt::format("{} shows no period that stands out of noise: white noise has a peak as "
                    "high as the highest with a chance of {:.2g}, and {:g} was asked for. "
                    "Longer or denser series tell more; --false-alarm 1 lists all peaks",
                    path, found.surest, request.false_alarm));
  if (found.rows.period.empty())
    return fail(
        ErrorCode::Nothing,
        fmt::format("{} shows no period: twelve brightnesses without a gap of {:g} s that "
                    "change otherwise than evenly are needed, with a peak in the range asked for",
                    path, request.gap_s));
  if (diagnostics != nullptr)
    warn_of_left_out(found, path, *diagnostics);
  return found;
}

} // namespace

Result<std::vector<Stretch>> stretches_of(const ObservationsFile &file,
                                          const PeriodRequest &request) {
  UMOV_ASSIGN(bands, wanted_bands(file, request.band));
  std::vector<Stretch> out;
  for (const std::string &band : bands)
    add_stretches(file, band, request.gap_s, out);
  return out;
}

Result<SurestPeak> surest_peak(const std::vector<Stretch> &stretches, const PeriodRequest &request,
                               const std::string &path) {
  UMOV_ASSIGN(found, search(stretches, request, path));
  return found.rows.surest_peak();
}

Result<Table> brightness(const ObservationsFile &observations, const PeriodRequest &request,
                         Diagnostics &diagnostics) {
  UMOV_ASSIGN(bands, wanted_bands(observations, request.band));
  UMOV_ASSIGN(stretches, stretches_of(observations, request));
  warn_of_rows_without_magnitude(observations, bands, diagnostics);
  std::vector<std::int64_t> number;
  std::vector<std::string> band, begin;
  std::vector<double> seconds, magnitudes;
  for (const Stretch &one : stretches) {
    const std::size_t count = one.seconds.size();
    number.insert(number.end(), count, &one - stretches.data() + 1);
    band.insert(band.end(), count, one.band);
    begin.insert(begin.end(), count, to_iso(one.begin));
    seconds.insert(seconds.end(), one.seconds.begin(), one.seconds.end());
    magnitudes.insert(magnitudes.end(), one.magnitudes.begin(), one.magnitudes.end());
  }
  Table out;
  out.add("stretch", "", "without a long gap, from 1", std::move(number));
  out.add("band", "", "band", std::move(band));
  out.add("begin_utc", "", "begin of the stretch", std::move(begin));
  out.add("seconds", "s", "since then", std::move(seconds));
  out.add("mag", "mag", "magnitude; of fluxes -2.5 lg", std::move(magnitudes));
  return out;
}

Result<Table> period(const ObservationsFile &observations, const PeriodRequest &request,
                     Diagnostics &diagnostics) {
  const std::string &path = observations.path;
  UMOV_ASSIGN(bands, wanted_bands(observations, request.band));
  UMOV_ASSIGN(stretches, stretches_of(observations, request));
  warn_of_rows_without_magnitude(observations, bands, diagnostics);
  UMOV_ASSIGN(found, search(stretches, request, path, &diagnostics));
  return table_of(std::move(found.rows), request, path);
}

} // namespace umov::jobs
