#pragma once
// What `umov run` says.

#include "console.h"

#include <chrono>
#include <umov/jobs/run.h>

namespace umov::cli {

/// That a scenario's objects were read and are in order.
void tell_of_objects(const std::string &scenario, const std::vector<jobs::ObjectRun> &objects,
                     const Common &common);
/// Many epochs take a while until the first of them is lit: said before.
void tell_of_search(const Scenario &scenario, const Common &common);
/// A summary, or JSON, of what stands in the folder.
void tell_of_run(const jobs::RunResult &result, const RunFolder &folder,
                 std::chrono::system_clock::time_point started, const Common &common);

} // namespace umov::cli
