#pragma once
// What an instrument would record of the objects of a scenario.

#include <functional>
#include <umov/io/fits_image.h>
#include <umov/io/run_folder.h>
#include <umov/io/table.h>
#include <umov/jobs/monitor.h>
#include <umov/jobs/requests.h>

namespace umov::jobs {

/// Counts and truth of an observation.
struct Observation {
  Table counts;                             ///< one row per exposure and channel
  Table truth;                              ///< one row per exposure: what a reduction should find
  std::size_t exposures = 0, saturated = 0; ///< of them, with a channel that is full
  std::vector<InputFile> inputs;
  double light_s = 0, counts_s = 0;        ///< time that light and counts took
  std::size_t frames = 0;                  ///< that were made
  std::vector<ManifestInput::Light> light; ///< how each object was lit
  std::vector<std::string> left_out; ///< by the scenario's filters: how many exposures, and why
};

/// Takes the frames of `level = "image"` as they are made, in order, by the names of their files.
using FrameSink = std::function<Result<void>(const std::string &, const FitsImage &)>;

/// Simulates it: the light at nodes within every exposure, the air, the telescope, the polarimeter
/// and the detector. BadInput without [observation]; Nothing if no exposure falls in a pass;
/// Physics if every exposure is saturated. Frames go to `take_frame`, and nowhere without it.
Result<Observation> observe(const Scenario &scenario, const JobOptions &options,
                            const Monitor &monitor, Diagnostics &diagnostics,
                            const FrameSink &take_frame = {});

/// counts and truth as tables in the scenario's formats, locked scenario, log and manifest.
Result<void> write_observation(const Observation &observation, const Scenario &scenario,
                               ManifestInput manifest, const Diagnostics &diagnostics,
                               RunFolder &folder);

} // namespace umov::jobs
