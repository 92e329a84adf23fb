#pragma once
// Private to the library: what counts have in common, without a matrix of all of them by all.

#include "reduction/cloud_chain.h"

#include <optional>
#include <umov/reduction/open_air.h>

namespace umov {

/// Which air is before each count.
struct AirOfCounts {
  std::vector<Eigen::Index> pupil; ///< of each count: an exposure of a pupil
  algebra::VectorXd flicker;       ///< relative standard deviation, of each of those
  CloudChain cloud;
};
AirOfCounts air_of(const OpenAir &air);

/// Common errors of counts: variances of those that concern one count by itself (gains of channels
/// without names are as many as counts), and the others as J sqrt(Sigma), one column for each.
struct CommonEffects {
  algebra::VectorXd own;
  algebra::MatrixXd shared;
};
CommonEffects effects_of(std::span<const CommonError> common, Eigen::Index rows);

/// D + the air + J J^T: variances of counts, flicker and cloud in proportion to their light, and
/// `effects` J. Its work is that of the counts, times the square of the effects' number.
class CountCovariance {
public:
  /// `air`: nullptr where it is known; outlives this.
  CountCovariance(const algebra::VectorXd &variance, const algebra::VectorXd &light,
                  const AirOfCounts *air, algebra::MatrixXd effects);

  [[nodiscard]] algebra::MatrixXd inverse_times(const algebra::MatrixXd &m) const;
  [[nodiscard]] double log_determinant() const;

private:
  [[nodiscard]] algebra::MatrixXd own_inverse_times(const algebra::MatrixXd &m) const;
  [[nodiscard]] algebra::MatrixXd airy_inverse_times(const algebra::MatrixXd &m) const;

  algebra::VectorXd weight_, light_;
  const AirOfCounts *air_;
  algebra::MatrixXd effects_;
  algebra::VectorXd flickers_;      ///< of each count: flicker times its light
  algebra::VectorXd widened_;       ///< of each pupil: 1 + F^T D^-1 F
  algebra::VectorXd clouded_;       ///< (D + F F^T)^-1 times the light
  algebra::VectorXd cloud_weights_; ///< of each moment
  algebra::MatrixXd weighted_effects_;
  std::optional<algebra::SymmetricFactor> small_;
};

} // namespace umov
