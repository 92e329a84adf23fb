#pragma once
// From a scenario to what the library computes; what all jobs have in common.

#include <filesystem>
#include <string>
#include <umov/core/diagnostics.h>
#include <umov/io/scenario.h>
#include <umov/jobs/index_range.h>
#include <vector>

namespace umov::jobs {

/// How a job runs, apart from what its scenario says.
struct JobOptions {
  unsigned threads = 0;             ///< 0: all cores; the bytes do not depend on it
  std::filesystem::path mask_cache; ///< folder of masks of earlier jobs; empty: none are kept
  DeviceOptions device;             ///< who adds up the light of the facets
  /// File for the finished blocks of a job: the same job goes on from it after a kill, and removes
  /// it when it is done. Empty: none are kept.
  std::filesystem::path journal;
  /// Of the poses of a signature, objects of a search, passes of a run, exposures of an
  /// observation.
  JobPart part;
  bool allow_bad_checksum = false; ///< of orbital elements
  bool allow_old_elements = false; ///< over 30 days from the span
};

/// How a scenario lights its objects: [render] of it, with the seed and the job's threads and
/// cache.
LightOptions light_options(const Scenario &scenario, const JobOptions &job);

/// The light curve that a scenario asks for of one of its objects.
LightCurveRequest light_curve_request(const Scenario &scenario, const ScenarioObject &named,
                                      const LoadedObject &object, const JobOptions &job);

/// Warns where cards were asked for if there are any and the processor was taken, at first or in
/// the end: `device` as LightModel::device says it.
void tell_of_device(const std::string &device, Diagnostics &diagnostics);

/// Index of a band by its name, the middle one for "". Usage with the names that there are.
Result<std::size_t> band_index(const std::string &name, const std::vector<Band> &bands);

} // namespace umov::jobs
