#pragma once
// Light of an object for directions, without an orbit.

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <umov/io/table_sink.h>
#include <umov/jobs/monitor.h>
#include <umov/jobs/requests.h>
#include <vector>

namespace umov::jobs {

/// Poses by index, and the numbers that they have in the output. Pure and thread safe.
struct PoseList {
  std::size_t count = 0;
  std::function<Pose(std::size_t)> at;
  std::function<std::int64_t(std::size_t)> number;
  std::string origin; ///< differs whenever the poses do
};

/// `per_phase` random poses at each phase angle (Usage unless 0 to 180 deg), by the counter-based
/// stream of a seed: pose k is the same whatever else is asked for.
Result<PoseList> random_poses(std::size_t per_phase, const std::vector<double> &phases_deg,
                              std::uint64_t seed);
/// From a CSV file with columns sun_x sun_y sun_z obs_x obs_y obs_z, body frame, any length. Rows
/// in turn with the same number in a column "pose" are one pose: so a table that `signature` wrote,
/// with a row per band, gives its poses back.
Result<PoseList> poses_from_file(const std::string &path);

/// What lights the object, and how well.
struct SignatureRequest {
  /// What the light comes from.
  enum class Source { Sun, Laser, Thermal };
  Source source = Source::Sun;
  /// Laser: Stokes of the incoming light per unit irradiance, in the scattering frame.
  Stokes<ScatteringPlane> state{1, 0, 0, 0};
  /// Thermal: "300" K of the whole body, "GROUP=K" of a part.
  std::vector<std::string> temperatures;
  std::optional<LightMethod> method;    ///< over the scenario's
  std::optional<double> accuracy;       ///< over the scenario's; neither: `for_many_poses`
  std::optional<std::uint64_t> seed;    ///< over the scenario's: of point sets and paths
  std::optional<BetweenMethod> between; ///< over the scenario's
  std::filesystem::path mask_file;      ///< LightOptions::mask_file
  bool has_half_widths = true;          ///< as in LightOptions; false where nobody writes them
  bool is_for_search = false;           ///< as in LightOptions
};

/// Rows of all poses into `sink`, block by block: memory does not grow with their number. The
/// scenario's orbit, time and observer are not used; parts that follow the Sun or the observer, or
/// stand at an angle, do so, others stand as in the mesh, with a warning. What the
/// same job finished before it was ended is taken from JobOptions::journal: the same bytes. Usage
/// for what does not go together; Interrupted after a stop, with the finished rows kept.
Result<void> signature(const Scenario &scenario, const PoseList &poses,
                       const SignatureRequest &request, TableSink &sink, const JobOptions &options,
                       const Monitor &monitor, Diagnostics &diagnostics);

} // namespace umov::jobs
