#pragma once
// From light curves back to how an object was turned.

#include <string>
#include <umov/inverse/null_test.h>
#include <umov/inverse/pose_search.h>
#include <umov/inverse/symmetry.h>
#include <umov/io/run_folder.h>
#include <umov/io/table.h>
#include <umov/jobs/monitor.h>
#include <umov/jobs/observed_light.h>
#include <umov/jobs/requests.h>
#include <umov/light/light_model.h>
#include <vector>

namespace umov::jobs {

/// How well the materials of an object are known, as standard deviations of logarithms, and how
/// well their surfaces are aligned; 0: exactly.
struct MaterialErrors {
  double slope = 0.2;       ///< of the slopes of each lobe
  double reflectance = 0.1; ///< of what a lobe and a body reflect
  double haze = 0.3;        ///< of what a material without a body scatters beside its lobe
  double tilt_deg = 0;      ///< of a turn of all its surfaces about each body axis
  /// Of each group of the mesh apart, whatever groups share a material: areas and alignment are of
  /// a part, not of what it is made of.
  bool is_by_group = false;
  /// Any of them is not known.
  [[nodiscard]] bool is_any() const {
    return slope > 0 || reflectance > 0 || haze > 0 || tilt_deg > 0;
  }
};

/// What is asked of the observations.
struct InvertRequest {
  std::vector<std::string> observations; ///< files; all of them are one fit
  CurveErrors errors;
  MaterialErrors materials; ///< unknowns of a search for attitudes and spins
  double largest_floor =
      0.1; ///< of such a search, whose floor grows with the misfit; 0: it does not
  std::size_t grid = 60'000;
  LightMethod method = LightMethod::Auto;
  bool allow_old_elements = false; ///< over 30 days from the observations
};

/// How sure the answer is.
enum class Verdict {
  Determined,   ///< one attitude, up to turns of the body that no light tells apart
  Ambiguous,    ///< several
  Undetermined, ///< a wide region, or all
  NoFit         ///< none explains the data
};
/// "determined", "ambiguous", "undetermined" or "no_fit".
const char *name_of(Verdict verdict);

/// A table of the answer and the name of its file.
struct NamedTable {
  std::string name;
  Table table;
};

/// An answer, ready to be written and printed.
struct Inversion {
  Verdict verdict = Verdict::Undetermined;
  std::vector<NamedTable> tables; ///< the first is what a terminal shows
  std::string summary;            ///< for a person
  std::string json;               ///< verdict.json
  std::string page;               ///< report.html; empty where this build makes none
  std::string state = {}; ///< state.json, which the next tracking goes on from; may be empty
  std::vector<InputFile> inputs;
  std::uint64_t seed = 0;
  ManifestInput::Light light; ///< how the object was lit, for the manifest
};

/// Which fixed attitudes explain the observations: modes, samples, the 95 % set, twins, fit. The
/// scenario's attitude is not used; parts that follow the Sun or the observer do so.
Result<Inversion> invert_pose(const Scenario &scenario, const InvertRequest &request,
                              const JobOptions &options, const Monitor &monitor,
                              Diagnostics &diagnostics);

/// What is known of a spin before.
struct SpinOptions {
  double period_s = 0;     ///< inertial; 0: from the periodogram, with its aliases
  bool has_aliases = true; ///< a half, twice and four times the period are tried too
  char axis = 0;           ///< 'x', 'y' or 'z' of the body, either sense; 0: any
};

/// Which constant spins explain the observations: periods with their aliases, axis, rate and
/// attitude. BadInput where no period is given and the curve tells none.
Result<Inversion> invert_spin(const Scenario &scenario, const InvertRequest &request,
                              const SpinOptions &spin, const JobOptions &options,
                              const Monitor &monitor, Diagnostics &diagnostics);

/// How an attitude is followed.
struct TrackRequest {
  /// Folder of an answer of invert_pose, invert_spin or invert_track, or its modes.ecsv.
  std::string start;
  /// Random walk of the rate about each body axis [deg/s/sqrt(s)]; 0: it is constant.
  double rate_noise = 1e-4;
  double rate_sd = 0.01; ///< of the rate of attitudes that were taken for fixed [deg/s]
};

/// Follows the attitudes of an answer through observations that are later than its own, each by a
/// filter of its own, with weights: docs/theory/inverse.md, section 14. Usage without a start;
/// BadInput for one that is none, and where no observation is later than its data.
Result<Inversion> invert_track(const Scenario &scenario, const InvertRequest &request,
                               const TrackRequest &track, const JobOptions &options,
                               const Monitor &monitor, Diagnostics &diagnostics);

/// What a part of the body may consist of.
struct MaterialOptions {
  std::string group;                   ///< of the mesh
  std::vector<std::string> candidates; ///< materials by name: of the scenario or the library
};

/// Which of the candidates a mesh group is of, and in which parts if of several; the scenario's
/// attitude is taken as known. BadInput for a group, Usage for a material that there is not.
Result<Inversion> invert_material(const Scenario &scenario, const InvertRequest &request,
                                  const MaterialOptions &material, const JobOptions &options,
                                  const Monitor &monitor, Diagnostics &diagnostics);

/// What may have changed on the body since it was modelled.
struct HealthOptions {
  std::vector<std::string> drifts; ///< "GROUP=MATERIAL": towards which material, 1 being all of it
  std::vector<std::string> baseline; ///< observations of before: changes are counted from them
  double attitude_sd_deg = 0.1;      ///< how well the scenario's attitude is known, each body axis
};

/// How far groups of the mesh have drifted towards other materials, each with the smallest change
/// that would show; the scenario's attitude is taken as known to `attitude_sd_deg`. BadInput for a
/// group, Usage for a material that there is not.
Result<Inversion> invert_health(const Scenario &scenario, const InvertRequest &request,
                                const HealthOptions &health, const JobOptions &options,
                                const Monitor &monitor, Diagnostics &diagnostics);

/// Puts an answer into a folder, at once.
Result<void> write_inversion(const Inversion &inversion, const Scenario &scenario,
                             ManifestInput manifest, const Diagnostics &diagnostics,
                             RunFolder &folder);

} // namespace umov::jobs
