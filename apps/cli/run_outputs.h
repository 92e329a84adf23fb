#pragma once
// What a run writes besides its tables: the report and the summary on the terminal.

#include <string>
#include <umov/core/diagnostics.h>
#include <umov/io/scenario.h>
#include <umov/lightcurve/compute.h>
#include <utility>
#include <vector>

namespace umov::cli {

/// The page with key frames and pure-material curves.
Result<std::string> make_run_report(const Scenario &scenario, const LoadedObject &object,
                                    const LightCurveRequest &request,
                                    const LightCurveOutcome &outcome,
                                    const Diagnostics &diagnostics);

/// Passes with brightness and polarization, as lines for a person.
std::string summarize(const LightCurveOutcome &outcome);

} // namespace umov::cli
