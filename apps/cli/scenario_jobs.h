#pragma once
// What the verbs that read a scenario share.

#include "console.h"

#include <umov/io/run_folder.h>
#include <umov/io/scenario.h>

namespace umov::cli {

/// The light curve that a scenario asks for of one of its objects.
LightCurveRequest light_curve_request(const Scenario &scenario, const ScenarioObject &named,
                                      const LoadedObject &object, const Common &common);

/// Index of a band by its name, the middle one for "". Usage with the names that there are.
Result<std::size_t> band_index(const std::string &name, const std::vector<Band> &bands);

/// What every manifest says of the command: its line, threads, begin and duration until now.
ManifestInput manifest_of_command(const Common &common,
                                  std::chrono::system_clock::time_point started);

} // namespace umov::cli
