#pragma once
// Private: counts as a series over time, with q and u that stay.

#include "jobs/count_rows.h"

namespace umov::jobs {

/// A row for each object and band. What cannot be fitted is told by its name and takes nothing else
/// with it; the error of the first where nothing can.
Result<std::vector<Reduced>> reduce_series(const CountsFile &file, std::size_t parameters,
                                           bool has_separate_pupils, const ReduceOptions &options,
                                           Diagnostics &diagnostics);

} // namespace umov::jobs
