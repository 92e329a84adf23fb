#pragma once
// The periods that a light curve shows, ours or anybody's.

#include <umov/io/observations_file.h>
#include <umov/io/table.h>

namespace umov::jobs {

/// What is looked for.
struct PeriodRequest {
  std::string band;         ///< "": all, each by itself
  std::size_t peaks = 5;    ///< of each stretch and band
  double shortest_s = 0;    ///< periods below are left out
  double longest_s = 1e300; ///< periods above are left out
  double gap_s = 1200;      ///< a longer gap begins a new stretch: another pass
};

/// Peaks of the periodogram of every stretch and band, the highest first. BadInput for a band that
/// the file does not have; Nothing where no stretch has twelve brightnesses that change.
Result<Table> period(const ObservationsFile &observations, const PeriodRequest &request,
                     Diagnostics &diagnostics);

} // namespace umov::jobs
