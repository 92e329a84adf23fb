#pragma once
// Which observations would tell alternatives apart: docs/theory/inverse.md, section 13.

#include <cstdint>
#include <span>
#include <string>
#include <umov/inverse/likelihood.h>
#include <umov/inverse/unmix.h>
#include <vector>

namespace umov {

/// Errors that an observer would have: [epoch * bands + band]. NaN: would not be measured.
struct ExpectedErrors {
  std::vector<double> i_sd; ///< of I, in the units of the light
  std::vector<double> q_sd; ///< of q and of u, each
};
/// What may be the case: its light, and what an observer of it would have for errors.
struct Alternative {
  EndMember light;
  ExpectedErrors errors;
};

/// What an observer of `truth` gets in the mean, at the epochs and bands of `layout`, whose samples
/// say which of them are observed: light without noise, with its errors. The scale is 1.
ObservedCurve expected_curve(const ObservedCurve &layout, const Alternative &truth);

/// Expected ln of the Bayes factor of what is the case against each alternative: element
/// [truth * n + other], 0 where both are the same. Scale, zero points and clouds are unknown as
/// `errors` says. Exact for normal errors that the data fix, since then noise adds the same to both
/// sides; a difference of the nuisances' own part in it, below one half for each band, is left out.
std::vector<double> expected_log_bayes(const ObservedCurve &layout, const CurveErrors &errors,
                                       std::span<const Alternative> alternatives);

/// How well alternatives would be told apart.
struct Discrimination {
  double information_bits = 0;  ///< mutual information of data and alternative
  double right = 0;             ///< chance that the likeliest alternative is the true one
  double decided = 0;           ///< chance that the true one gets more than 95 %
  double hardest_log_bayes = 0; ///< the smallest expected ln Bayes factor of a pair, of both truths
  std::size_t hardest_a = 0, hardest_b = 0; ///< that pair
};

/// From expected ln Bayes factors: with normal errors the ln likelihood ratios are normal too, and
/// their means and covariances follow from those of the pairs. Two alternatives by quadrature, more
/// by 4096 antithetic draws. `prior`: chances before, which are scaled to the sum 1.
Discrimination discrimination(std::span<const double> log_bayes, std::span<const double> prior,
                              std::uint64_t seed);

} // namespace umov
