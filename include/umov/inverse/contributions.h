#pragma once
// What each band and Stokes component gave to an answer: docs/theory/inverse.md, section 5.

#include <umov/inverse/pose_search.h>

namespace umov {

/// Numbers of one band that were measured alike.
struct Contribution {
  std::size_t band = 0; ///< of the curve
  CurveLikelihood::Measured what{};
  std::size_t numbers = 0;
  double chi2 = 0; ///< their part of it
  /// Their part of what is known of the unknowns: tr(C H_s) / n, of n unknowns that have the
  /// inverse covariance C^-1 = sum H_s in all, H_s = J_s^T J_s theirs. The parts add up to 1, but
  /// for what the priors of zero points and materials hold.
  double share = 0;
};

/// At the heaviest mode of an answer, whose parts of the light and zero points move along; in order
/// of bands, I first. Nothing without a mode, where the light does not tell the unknowns, or where
/// `model` was stopped.
std::vector<Contribution> contributions_to(const PoseAnswer &answer, const CurveModel &model,
                                           unsigned threads);

} // namespace umov
