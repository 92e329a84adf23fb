#pragma once
// Which attitudes a curve allows: docs/theory/inverse.md, sections 3 to 5.

#include <array>
#include <atomic>
#include <cstdint>
#include <umov/core/result.h>
#include <umov/inverse/curve_model.h>
#include <vector>

namespace umov {

/// How a search is run.
struct SearchOptions {
  CurveErrors errors;
  /// The model may turn out to be as far off as that, in parts of I: the floor is then as large as
  /// the misfit of the best attitude asks. 0: the floor is what `errors` say.
  double largest_floor = 0;
  std::size_t grid = 60'000;  ///< attitudes that are looked at first
  std::size_t starts = 1200;  ///< of them, spread out, that take a few steps; more of short curves
  std::size_t samples = 1000; ///< of the posterior
  /// The evidence alone is asked for: what a set needs more than that is left out.
  bool needs_set = true;
  std::uint64_t seed = 0; ///< of the samples
  unsigned threads = 0;   ///< the answer does not depend on it
  /// Told what is being done, and how much of it.
  std::function<void(const char *what, std::size_t done, std::size_t total)> progress = {};
};

/// One way to be turned that explains the curve.
struct PoseMode {
  Turning turning;
  /// Of the rotation vector in body axes [rad], and of the rate [rad/s] where it was free:
  /// row-major, 3 x 3 or 6 x 6.
  std::vector<double> covariance;
  double weight = 0; ///< share of the posterior
  double chi2 = 0, scale = 1;
  bool is_converged = true; ///< further steps gain next to nothing
  /// Root of the largest variance of the attitude [rad].
  [[nodiscard]] double sd_rad() const;
};

/// One draw from the posterior.
struct PoseSample {
  Turning turning;
  double weight = 0; ///< they add up to 1
  double minus_2_log = 0, chi2 = 0;
  double scale = 1; ///< observed over model
};

/// One ball of a set of attitudes.
struct AttitudeBall {
  Quaternion attitude;
  double radius_rad = 0;
};

/// What a curve says about the attitude.
struct PoseAnswer {
  std::vector<PoseMode> modes;      ///< heaviest first
  std::vector<PoseSample> samples;  ///< of the posterior
  std::vector<AttitudeBall> set95;  ///< their union holds 95 % of it
  double share_of_so3 = 0;          ///< volume of that union in parts of all attitudes
  double log_evidence = 0;          ///< over a prior that takes all attitudes alike
  double chi2 = 0;                  ///< of the best one
  CurveErrors errors;               ///< that it rests on
  double model_error = 0;           ///< in parts of I, as the misfit says; 0: nobody asked the data
  bool is_model_error_more = false; ///< than that, the largest that was asked for
  double related = 1;               ///< how many numbers are wrong together
  double misfit = 0; ///< chi2 of the best if numbers were off by `model_error` each by itself
  std::size_t measurements = 0, unknowns = 0;
  /// The posterior is no few narrow peaks: its samples were followed from all attitudes on, and
  /// covariances of modes say little.
  bool is_broad = false;
  /// Every mode that matters is a bottom: its fit came to rest and no sample fits better.
  bool is_settled = true;
  /// Where it is broad: by how much the ln evidences of its runs of particles differ. Runs that do
  /// not agree have lost places that others found, and all may have lost some.
  double evidences_apart = 0;
  double effective = 0; ///< size of an unweighted sample as good as `samples`
  std::size_t poses_lit = 0;
};

/// No attitude explains the curve: `misfit` is over twice its degrees of freedom and less likely
/// than 1e-6, or the best one misses the data by more than four times `floor` (CurveErrors::floor
/// as it was told, .005 at least), which no material within its priors makes up for.
bool explains_nothing(const PoseAnswer &answer, double floor);

/// Evidences of runs that agree differ by less, in ln.
inline constexpr double alike_evidences = 0.5;

/// All fixed attitudes that explain a curve; where none does, those that miss it the least, and no
/// particles are followed to what lies beside them. Interrupted if the light stopped; BadInput for
/// a curve without measurements.
Result<PoseAnswer> search_pose(const CurveModel &model, const SearchOptions &options);
/// Models of one curve, the more often they are asked the quicker.
struct SearchModels {
  const CurveModel &last; ///< for the last fits and samples of peaks
  /// For the first fits and what is far from the peaks; its parts are those of `last`.
  const CurveModel &first;
  const CurveModel &quick; ///< for the search over all attitudes
};
/// The same with quicker models where they will do.
Result<PoseAnswer> search_pose(const SearchModels &models, const SearchOptions &options);

/// Chi-square of the best fixed attitude: what a search for spins asks a body that does not turn,
/// without the posterior around it. Where the best of its places is ten standard deviations off in
/// each measurement after a dozen steps on few epochs, that is all: their chi-square in proportion,
/// which is no fit to all epochs. Errors as `search_pose`.
Result<double> least_chi2_at_rest(const SearchModels &models, const SearchOptions &options);

/// `search_pose` around given turnings with their rate free too: the last step of a search for a
/// spin. `first`: quicker light of the same parts, which tells the starts that may become the best.
/// The set is left empty: which attitudes it holds goes with the time that they are asked for.
Result<PoseAnswer> refine_spin(const CurveModel &model, const CurveModel &first,
                               std::span<const Turning> starts, const SearchOptions &options);

/// The attitude lies in the union of balls.
bool is_in(std::span<const AttitudeBall> set, Quaternion attitude);

} // namespace umov
