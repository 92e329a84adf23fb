#pragma once
// How far the fast engine is from the reference path.

#include <umov/light/engine.h>
#include <umov/light/integrator.h>

namespace umov {

/// One pose whose fast result is far off.
struct EngineOutlier {
  std::size_t pose = 0;
  double error = 0;    ///< of I, relative
  double estimate = 0; ///< half-width of I, relative
  double light = 0;    ///< I over the median of all poses
};

/// Errors in one band. Quantiles are over poses with more than `dim` of the median light, since a
/// relative error says little where only a sliver is seen; `covered` and `outliers` take all.
struct EngineErrors {
  static constexpr double dim = 0.01;
  std::size_t poses = 0;                                ///< of the quantiles
  double i_median = 0, i_p90 = 0, i_p95 = 0, i_max = 0; ///< |I / I_ref - 1|
  double q_median = 0, q_p95 = 0, q_max = 0;            ///< |Q/I - (Q/I)_ref|
  double covered = 0;         ///< share of poses whose half-widths, added, cover the difference
  double estimate_median = 0; ///< half-width of I over I
  std::vector<EngineOutlier> outliers; ///< the five worst, the worst first
};

/// Errors of a fast table against the reference of the same poses, in one band.
EngineErrors compare_with_reference(const StokesTable &fast,
                                    const std::vector<PoseResult> &reference, std::size_t band);

} // namespace umov
