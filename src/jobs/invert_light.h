#pragma once
// Private: what every question to observations begins with.

#include <umov/jobs/invert.h>
#include <umov/jobs/pose_light.h>

namespace umov::jobs {

/// Observations, the object that they are of, and its light.
struct Prepared {
  ObservedLightCurve observed;
  PoseLight light;
};

/// Reads and compiles what a request names.
Result<Prepared> prepare(const Scenario &scenario, const InvertRequest &request,
                         const JobOptions &options, Diagnostics &diagnostics);
/// `light` and `monitor` must outlive it.
PoseLighting lighting_of(const PoseLight &light, unsigned threads, const Monitor &monitor);
/// How the search is run; `monitor` must outlive it.
SearchOptions search_options(const Scenario &scenario, const InvertRequest &request,
                             const JobOptions &options, const Monitor &monitor);

} // namespace umov::jobs
