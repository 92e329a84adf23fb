#pragma once
// Private: stretches of brightness and what a search for periods found in them.

#include <umov/jobs/period.h>
#include <umov/lightcurve/periodogram.h>
#include <umov/lightcurve/repetition.h>

namespace umov::jobs {

/// Brightness of one band without a long gap, in magnitudes.
struct Stretch {
  std::string band;
  Epoch<Utc> begin{};
  std::vector<double> seconds, magnitudes;
  bool is_flux = false; ///< the file has fluxes: magnitudes have their unit for a zero point
};

/// Those of a file that are asked for, band by band. BadInput for a band that it does not have.
Result<std::vector<Stretch>> stretches_of(const ObservationsFile &file,
                                          const PeriodRequest &request);

/// The surest highest peak of all.
struct SurestPeak {
  const Stretch *stretch = nullptr;
  double period_s = 0;
  std::string where; ///< which stretch, "" or " (V, 2018-...)"
};
/// Nothing as `period` says it, where there is none.
Result<SurestPeak> surest_peak(const std::vector<Stretch> &stretches, const PeriodRequest &request,
                               const std::string &path);

/// After what time the light of a stretch repeats.
struct Repetition {
  double peak_s = 0;        ///< the highest peak
  double period_s = 0;      ///< the same, or twice or four times that where turns differ
  Alternation last_doubled; ///< of half of `period_s`, if it is not the peak
  Alternation at_period;    ///< whether turns of `period_s` differ: they do not as far as is told
};
/// Of the highest peak: doubled, twice at most, as long as turns differ more than noise makes them
/// with a chance of `false_alarm`.
Repetition repetition_of(const Stretch &stretch, double peak_s, double false_alarm);

/// Which spins it may mean, in words; `where` names the stretch, "" or " (V, 2018-...)".
std::string describe(const Repetition &repetition, const std::string &where);

} // namespace umov::jobs
