#pragma once
// Private: the neighbours of a turning from which the derivatives of its light are taken.

#include "inverse/turning_step.h"

#include <cstddef>
#include <span>

namespace umov::inverse {

/// Where neighbours lie, in steps.
///
/// A glint holds two directions of an attitude a hundred times better than the third. A difference
/// over a hundred widths of the narrow ones is wrong by as much as the wide one's whole derivative,
/// and a fit stands still on the side of a valley, wherever it is.
class Neighbours {
public:
  /// One for each unknown, on one side, all as far [rad].
  static Neighbours alike(Eigen::Index unknowns, double distance);
  /// Along the axes of an inverse covariance, to both sides, each half a width away and no farther
  /// than `longest` [rad]: what curves along an axis cancels out.
  static Neighbours half_widths(const Eigen::MatrixXd &information, double longest);

  [[nodiscard]] std::size_t count() const;
  [[nodiscard]] Step step(std::size_t neighbour) const;
  /// Derivatives (row: residual, column: unknown) from residuals at the centre, and next to it in
  /// order of `step`.
  [[nodiscard]] Eigen::MatrixXd
  jacobian(const std::vector<double> &centre,
           std::span<const std::vector<double> *const> residuals) const;

private:
  Eigen::MatrixXd axes_; ///< columns
  Eigen::VectorXd distances_;
  bool has_both_sides_ = false;
};

} // namespace umov::inverse
