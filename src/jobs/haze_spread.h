#pragma once
// Private: [materials] vary.

#include <umov/jobs/run.h>

namespace umov::jobs {

/// The light curve of an object once more with every haze at each end of its stated range, into the
/// spread of its samples. A stop is told by `outcome.stopped`; rows that it left out have no
/// spread.
Result<void> add_haze_spread(ObjectRun &one, KeptBlocks blocks, const Monitor &monitor,
                             Diagnostics &diagnostics);

/// A line for people: by how much the light changes; empty without a spread.
std::string describe_spread(const LightCurve &curve);

/// Half of the samples change by less than `median` [mag], all by `most` at most; limits left out.
struct MagnitudeSpread {
  double median = 0, most = 0;
  std::size_t samples = 0;
};
MagnitudeSpread magnitude_spread(const LightCurve &curve);

} // namespace umov::jobs
