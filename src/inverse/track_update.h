#pragma once
// Private: what one filter learns from one epoch.

#include "inverse/track_belief.h"

namespace umov::inverse {

/// Iterated posterior linearisation (Garcia-Fernandez et al. 2015, IEEE Trans. Signal Process. 63,
/// 5561): residuals as a straight line through sigma points about the belief that the step before
/// left, with what bends as an error of its own; each step begins at the belief before the epoch.
/// The data come in by powers, so that no step rests on a line through points that lie wider than
/// the line is straight.
class FilterUpdate {
public:
  /// `likelihood` must outlive it.
  FilterUpdate(Belief before, const CurveLikelihood &likelihood);

  /// Attitudes whose light a step asks for: the middle, and two for each axis of the attitude.
  static constexpr std::size_t asked = 7;
  [[nodiscard]] Turning attitude(std::size_t which) const;
  /// Light of one of them; from any thread.
  void take(std::size_t which, const ModelLight &light);
  /// Makes a step of what was taken.
  void step();
  [[nodiscard]] bool is_done() const { return is_done_; }

  /// Before the first step: what the data's line bends by over the belief, in squares of errors,
  /// and along which column of its root most.
  struct Bend {
    Eigen::Index column = 0;
    double square = 0;
  };
  [[nodiscard]] Bend bend() const;

  [[nodiscard]] const Belief &before() const { return before_; }
  /// The belief with the epoch in it.
  [[nodiscard]] const Belief &after() const { return now_; }
  /// ln of how likely the epoch was to this filter, up to what it is to all.
  [[nodiscard]] double log_evidence() const { return log_evidence_; }
  /// Square of the innovation in its own errors.
  [[nodiscard]] double chi2() const { return chi2_; }
  /// Light of the middle, its parts as the filter has them.
  struct Light {
    std::vector<double> i, q, u;
  };
  [[nodiscard]] const Light &light() const { return light_; }

private:
  void spread();
  [[nodiscard]] Eigen::VectorXd point(Eigen::Index column, double sign) const;
  /// A line through the points, of residuals by columns of the root.
  struct Line {
    Eigen::VectorXd middle;  ///< mean of the residuals
    Eigen::MatrixXd by_root; ///< their slopes
    Eigen::MatrixXd bends;   ///< their second derivatives, one standard deviation a unit
    double more = 0;         ///< in -2 ln likelihood beside the squares
  };
  [[nodiscard]] Line line(Eigen::Index columns) const; ///< the first ones of the root
  [[nodiscard]] double cost() const;

  Belief before_, now_; ///< now: about which the line is drawn
  const CurveLikelihood &likelihood_;
  Eigen::MatrixXd root_, first_root_; ///< of the belief of now, and before
  Eigen::VectorXd reach_;             ///< of the points, in columns of the root
  /// Residuals of the middle, and of the points on either side of it, one for each column.
  Eigen::VectorXd middle_;
  std::vector<Eigen::VectorXd> up_, down_;
  double more_ = 0;  ///< -2 ln likelihood of the middle, less the squares
  double power_ = 0; ///< of the likelihood that the step before left in `now_`
  int steps_ = 0;
  Belief best_; ///< where whole steps began, that with the least cost
  double least_ = 1e300;
  bool is_done_ = false;
  double log_evidence_ = 0, chi2_ = 0;
  Light light_;
};

} // namespace umov::inverse
