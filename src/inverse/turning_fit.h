#pragma once
// Private: many least-squares fits of turnings at once.

#include "inverse/turning_step.h"

#include <umov/core/quantity.h>
#include <umov/core/result.h>
#include <umov/inverse/curve_model.h>
#include <vector>

namespace umov::inverse {

/// [rad]
inline constexpr double degree = pi / 180;

/// What a search that was ended says.
inline Error stopped() {
  return {ErrorCode::Interrupted, "stopped by the user; nothing was written", {}};
}

/// What is free: the attitude alone, or the rate too.
enum class Freedom { Attitude = 3, AttitudeAndRate = 6 };

/// From second 0, at which the attitude is told, to the farthest of the epochs (empty: all), before
/// or after it [s].
double farthest_of(const ObservedCurve &curve, std::span<const std::size_t> epochs = {});
/// The same, at least 1 [s]. A rate is asked in steps of it: in steps of a longer one they would
/// turn the body by less than what derivatives by differences can see.
double span_of(const ObservedCurve &curve, std::span<const std::size_t> epochs = {});

/// One fit.
struct TurningFit {
  Turning turning;
  Comparison at;               ///< without residuals
  Eigen::MatrixXd information; ///< inverse covariance: J^T J of the whitened residuals
  bool is_converged = false;   ///< further steps gain next to nothing
};

/// How fits are run.
struct FitPlan {
  Freedom freedom = Freedom::Attitude;
  int iterations = 12;
  int cut_after = 0; ///< iterations after which only the best `kept` go on; 0: all
  std::size_t kept = 0;
  /// Of the derivatives, until steps gain little: masks are steps on a finer scale. From there on
  /// half a width of its peak in each direction, if that is shorter (`Neighbours`).
  double difference_rad = 2e-3;
  unsigned threads = 0;
  bool drops_hopeless = false; ///< at each cut: fits that would not come near the best by the end
  /// Each fit's `information` is that at its end, by half widths; else of wherever it was asked
  /// last, and a neighbour of each for each unknown is not lit.
  bool tells_covariance = true;
};

/// A few steps of fixed attitudes on the way of a search, which goes on from their ends alone.
inline FitPlan on_the_way(int steps, double difference_rad, unsigned threads) {
  return {.iterations = steps,
          .difference_rad = difference_rad,
          .threads = threads,
          .tells_covariance = false};
}

/// Levenberg-Marquardt (Marquardt 1963) of all starts side by side, scale and zero points
/// eliminated in each residual (variable projection: Golub & Pereyra 1973); sorted by chi2, of
/// those that came together the best. Empty if it was stopped.
std::vector<TurningFit> fit_turnings(const CurveModel &model, const CurveLikelihood &likelihood,
                                     std::vector<Turning> starts,
                                     std::span<const std::size_t> epochs, const FitPlan &plan);

/// The first of some turnings, which come best first, no two attitudes within `apart_rad`.
std::vector<Turning> spread_out(const std::vector<Turning> &sorted, std::size_t count,
                                double apart_rad);
/// Turnings of the first fits.
std::vector<Turning> turnings_of(const std::vector<TurningFit> &fits, std::size_t count);

/// -2 ln likelihood of each turning; empty if it was stopped. `near`: of each, the parts of one
/// next to it (`CurveLikelihood::compare`), if there are any.
std::vector<Comparison> compare_all(const CurveModel &model, const CurveLikelihood &likelihood,
                                    std::span<const Turning> turnings,
                                    std::span<const std::size_t> epochs, unsigned threads,
                                    bool keeps_residuals = false,
                                    std::span<const std::span<const double>> near = {});

} // namespace umov::inverse
