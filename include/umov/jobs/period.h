#pragma once
// The periods that a light curve shows, ours or anybody's.

#include <umov/io/observations_file.h>
#include <umov/io/table.h>

namespace umov::jobs {

/// What is looked for.
struct PeriodRequest {
  std::string band;          ///< "": all, each by itself
  std::size_t peaks = 5;     ///< of each stretch and band
  double shortest_s = 0;     ///< periods below are left out
  double longest_s = 1e300;  ///< periods above are left out
  double gap_s = 1200;       ///< a longer gap begins a new stretch: another pass
  double false_alarm = 0.01; ///< peaks that white noise has more often are left out
};

/// Peaks of the periodogram of every stretch and band, the highest first, each with what it is: a
/// period, a part or a multiple of a higher one, or what the times of the data make of one. The
/// note "spin" says which spins the surest of them may mean, and whether turns twice as long
/// differ. BadInput for a band that the file does not have; Nothing where no stretch has twelve
/// brightnesses that change, or none stands out of noise.
Result<Table> period(const ObservationsFile &observations, const PeriodRequest &request,
                     Diagnostics &diagnostics);

/// What the search looks at: each brightness that has a magnitude, by stretch and band: number of
/// the stretch, band, time, seconds since its begin, magnitude. Errors as of `period`, but for
/// stretches too short for a search.
Result<Table> brightness(const ObservationsFile &observations, const PeriodRequest &request,
                         Diagnostics &diagnostics);

/// A page of figures of the stretch with the surest peak: its brightness, its periodogram, and the
/// curve folded at the period and at twice that. Errors as of `period`.
Result<std::string> period_page(const ObservationsFile &observations, const PeriodRequest &request);

} // namespace umov::jobs
