#include "jobs/reduce_series.h"

#include <cmath>
#include <fmt/format.h>
#include <map>
#include <optional>
#include <umov/core/quantity.h>
#include <umov/core/text.h>
#include <utility>

namespace umov::jobs {
namespace {

/// The series of one object and band, with what is common to its counts.
Result<SequenceFit> fit_series(Rows rows, std::size_t parameters, bool has_separate_pupils,
                               const ReduceOptions &options) {
  std::vector<TimedDatum> data;
  for (std::size_t k = 0; k < rows.size(); ++k)
    data.push_back({seconds_between(rows[k].time, rows.front().time), datum_of(rows[k], options),
                    has_separate_pupils ? k : static_cast<std::size_t>(rows[k].exposure),
                    rows[k].scintillation});
  const std::size_t unknowns = std::max<std::size_t>(3, parameters);
  const CloudPrior cloud{options.transparency_sd, options.transparency_time_s};
  UMOV_ASSIGN(fit, options.knot_s > 0
                       ? fit_spline(data, options.knot_s, unknowns, cloud)
                       : fit_sequence(data, options.period_s, options.harmonics, unknowns, cloud));
  std::vector<ModelledDatum> model;
  const auto gains = gains_of(rows);
  for (std::size_t k = 0; k < rows.size(); ++k)
    model.push_back(modelled(rows[k], data[k].datum, stokes_at(fit, data[k].time_s), gains[k]));
  const auto common = common_errors(options.priors, model);
  if (common.empty())
    return fit;
  return fit_sequence(data, fit, common, cloud);
}

/// Counts of one object in one band.
struct Series {
  std::vector<CountRow> rows;
  std::size_t full = 0; ///< saturated counts, which are not among them
};
using AllSeries = std::map<std::pair<std::string, std::string>, Series>;

/// A saturated count is a lower limit: no series is drawn through it.
AllSeries series_of(const CountsFile &file, Diagnostics &diagnostics) {
  AllSeries out;
  std::size_t full = 0;
  for (const CountRow &row : file.rows) {
    Series &one = out[{row.name, row.band}];
    if (!row.is_saturated) {
      one.rows.push_back(row);
      continue;
    }
    ++one.full;
    ++full;
  }
  if (full > 0 && full < file.rows.size())
    diagnostics.warn(fmt::format("{} of {} left out of the series: they are saturated",
                                 counted(full, "count"), file.rows.size()));
  return out;
}

std::string named(const AllSeries::key_type &key) {
  return key.first.empty() ? key.second : key.first + " " + key.second;
}

Reduced reduced_series(const Series &series, const SequenceFit &fit, const ReduceOptions &options) {
  Reduced out;
  out.middle = middle_of(series.rows);
  out.fractions = fit.fractions;
  out.fit.stokes[0] = fit.mean;
  out.fit.covariance[0][0] = fit.mean_variance;
  out.fit.chi2 = fit.chi2;
  out.fit.dof = fit.dof;
  if (series.full > 0)
    out.flags = "saturated";
  if (fit.mean > 3 * std::sqrt(fit.mean_variance))
    out.is_solved = true;
  else // nothing was seen, or the series is not the light's: fractions of it say nothing
    add_flag(out.flags, "faint");
  judge(out, options);
  return out;
}

} // namespace

Result<std::vector<Reduced>> reduce_series(const CountsFile &file, std::size_t parameters,
                                           bool has_separate_pupils, const ReduceOptions &options,
                                           Diagnostics &diagnostics) {
  std::vector<Reduced> out;
  std::optional<Error> first;
  for (const auto &[key, series] : series_of(file, diagnostics)) {
    if (series.rows.empty()) {
      diagnostics.warn(fmt::format("{}: all of its {} are saturated", named(key),
                                   counted(series.full, "count")));
      continue;
    }
    warn_of_gaps(series.rows, true, diagnostics);
    auto fit = fit_series(series.rows, parameters, has_separate_pupils, options);
    if (fit) {
      out.push_back(reduced_series(series, *fit, options));
      continue;
    }
    fit.error().message = named(key) + ": " + fit.error().message;
    if (first)
      diagnostics.warn(fit.error().message);
    else
      first = fit.error();
  }
  if (out.empty())
    return first ? tl::unexpected(*first) : all_saturated();
  if (first)
    diagnostics.warn(first->message);
  return out;
}

} // namespace umov::jobs
