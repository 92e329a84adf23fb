#include "jobs/observations_counts.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <map>
#include <set>
#include <umov/core/text.h>
#include <umov/jobs/reduce.h>

namespace umov::jobs {
namespace {

/// The first line that is no comment.
std::string_view header_of(std::string_view text) {
  while (text.starts_with('#')) {
    const std::size_t end = text.find('\n');
    if (end == text.npos)
      return {};
    text.remove_prefix(end + 1);
  }
  return text.substr(0, text.find('\n'));
}

bool has_column(std::string_view header, std::string_view name) {
  const auto is_part = [](char c) { return c != ' ' && c != ',' && c != '"' && c != '\r'; };
  for (std::size_t at = header.find(name); at != header.npos; at = header.find(name, at + 1)) {
    const std::size_t end = at + name.size();
    if ((at == 0 || !is_part(header[at - 1])) && (end == header.size() || !is_part(header[end])))
      return true;
  }
  return false;
}

/// Rows stand where exposures do: those of a sequence begin and end at other times.
void put_on_exposures(ObservationsFile &file) {
  std::map<std::string, std::vector<Epoch<Utc>>> times; // of each band
  for (const CountRow &count : file.counts)
    times[count.band].push_back(count.time);
  const auto is_before = [](const Epoch<Utc> &a, const Epoch<Utc> &b) {
    return seconds_between(a, b) < 0;
  };
  for (auto &[band, all] : times)
    std::ranges::sort(all, is_before);
  for (ObservedRow &row : file.rows) {
    const std::vector<Epoch<Utc>> &all = times[row.band];
    auto at = std::ranges::lower_bound(all, row.time, is_before);
    if (all.empty())
      continue; // every count of the band was saturated
    const bool is_first = at == all.begin();
    if (at == all.end() || (!is_first && std::abs(seconds_between(*(at - 1), row.time)) <=
                                             std::abs(seconds_between(*at, row.time))))
      --at;
    row.time = *at;
  }
}

/// Sets that none of the rows is of.
void warn_of_sets(const CountsFile &counts, const ObservationsFile &rows, const Where &where,
                  Diagnostics &diagnostics) {
  std::set<std::pair<std::string, std::int64_t>> all, cut;
  for (const CountRow &row : counts.rows) {
    all.insert({row.band, row.set});
    if (row.is_saturated)
      cut.insert({row.band, row.set});
  }
  const std::size_t lost = all.size() - std::min(all.size(), rows.rows.size());
  const std::size_t dark = lost - std::min(lost, cut.size());
  if (lost > dark)
    diagnostics.warn(fmt::format("{} of {} left out: some of their counts are saturated",
                                 lost - dark, counted(all.size(), "set")),
                     where);
  if (dark > 0)
    diagnostics.warn(fmt::format("{} of {} left out: their counts tell no brightness", dark,
                                 counted(all.size(), "set")),
                     where);
}

/// Analysers one after the other: what they add up to is I of a body that stood still meanwhile.
void warn_of_sequences(const CountsFile &counts, const Where &where, Diagnostics &diagnostics) {
  double longest = 0;
  for (std::size_t k = 1; k < counts.rows.size(); ++k)
    if (const CountRow &a = counts.rows[k - 1], &b = counts.rows[k];
        a.set == b.set && a.band == b.band)
      longest = std::max(longest, seconds_between(b.time, a.time));
  if (longest > 0)
    diagnostics.warn(
        fmt::format("I alone is that of sets of exposures, which are {:.2g} s apart: of a "
                    "body whose light changes meanwhile it is wrong. With q and u each "
                    "exposure is compared at its own time",
                    longest),
        where);
}

} // namespace

bool is_counts_table(std::string_view text) {
  const std::string_view header = header_of(text);
  return has_column(header, "counts") && has_column(header, "w0");
}

Result<ObservationsFile> observations_of_counts(std::string_view text, const std::string &file,
                                                bool has_polarization, unsigned threads,
                                                Diagnostics &diagnostics) {
  UMOV_ASSIGN(counts, read_counts_text(text, file, diagnostics));
  for (const CountRow &row : counts.rows)
    if (row.name != counts.rows.front().name)
      return fail(ErrorCode::BadInput,
                  fmt::format("counts of \"{}\" and of \"{}\": an inversion is of one object; keep "
                              "the rows of one",
                              printable(counts.rows.front().name), printable(row.name)),
                  {file});
  ReduceOptions how;
  how.threads = threads;
  Diagnostics of_sets; // what is strange about the table, which is not what is fitted
  UMOV_ASSIGN(reduced, reduce(counts, how, Monitor{}, of_sets));
  UMOV_ASSIGN(out, read_observations_text(to_ecsv(reduced), file, of_sets));
  if (!has_polarization) {
    warn_of_sets(counts, out, {file}, diagnostics);
    warn_of_sequences(counts, {file}, diagnostics);
    return out;
  }
  const std::size_t all = counts.rows.size();
  std::erase_if(counts.rows, [](const CountRow &row) { return row.is_saturated; });
  if (const std::size_t full = all - counts.rows.size(); full > 0)
    diagnostics.warn(fmt::format("{} of {} left out: saturated", full, counted(all, "count")),
                     {file});
  const auto pupils = counts.notes.find("pupils");
  out.has_separate_pupils = pupils != counts.notes.end() && pupils->second == "separate";
  out.counts = std::move(counts.rows);
  put_on_exposures(out);
  return out;
}

} // namespace umov::jobs
