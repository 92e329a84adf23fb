#pragma once
// What a run would do, before it does it.

#include <string>
#include <umov/jobs/run.h>
#include <vector>

namespace umov::jobs {

/// What `compute_run` would light of objects that `load_run` has read, as a JSON object: folder,
/// method, accuracy (relative half-width of I), bounces, bands, for each object its epochs to light
/// and passes with pass_id, alt_max [deg] and epochs, and what it costs as counts of epochs and
/// rows. The epochs are looked for as the run does, and nothing is lit. Errors as those of
/// compute_run before its first row; an orbit that ends in the span is told in `stops` of its
/// object.
Result<std::string> run_plan_json(std::vector<ObjectRun> objects, const Scenario &scenario,
                                  const JobOptions &options, const Monitor &monitor);

} // namespace umov::jobs
