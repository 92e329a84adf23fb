#pragma once
// Private: pages of plots of counts and of what they become.

#include <umov/core/diagnostics.h>
#include <umov/jobs/observe.h>

namespace umov::jobs {

/// Counts with their model, residuals, pulls, noise, and what was there.
Result<std::string> observation_page(const Observation &observation, const std::string &title,
                                     const Diagnostics &diagnostics);

} // namespace umov::jobs
