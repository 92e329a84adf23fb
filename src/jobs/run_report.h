#pragma once
// Private: the report of a run.

#include <string>
#include <umov/core/diagnostics.h>
#include <umov/io/report.h>
#include <umov/io/scenario.h>
#include <umov/lightcurve/compute.h>

namespace umov::jobs {

/// Periods that a law has by itself; none where it follows its targets alone.
std::vector<TurningPeriod> turning_periods(const AttitudeLaw &law);

/// The page with key frames and pure-material curves.
Result<std::string> make_run_report(const Scenario &scenario, const LoadedObject &object,
                                    const LightCurveRequest &request,
                                    const LightCurveOutcome &outcome,
                                    const Diagnostics &diagnostics);

} // namespace umov::jobs
