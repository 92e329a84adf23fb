#pragma once
// Private: a wide filter as a grid of narrow ones.

#include "inverse/track_belief.h"

namespace umov::inverse {

/// Wider than this about some axis a filter is spread: its line does not follow the light. 8 deg.
inline constexpr double wide_rad = 0.14;

/// A belief as narrow ones with their weights, on a grid along the principal axes of its attitude
/// out to three standard deviations: normals of 4 deg (wider where they would be more than 8000, or
/// covariances of 2.5 million numbers) that stand 1.5 of it apart. What else is unknown moves along
/// as it goes with the attitude.
class SpreadBelief {
public:
  explicit SpreadBelief(const Belief &belief);
  /// Root of the largest variance of the attitude [rad].
  [[nodiscard]] double widest_rad() const { return sd_.maxCoeff(); }
  /// How many there are; 1: the belief is narrow itself.
  [[nodiscard]] std::size_t size() const { return places_.size(); }
  /// They add up to 1.
  [[nodiscard]] double weight(std::size_t k) const { return places_[k].weight; }
  [[nodiscard]] Quaternion attitude(std::size_t k) const;
  [[nodiscard]] Belief belief(std::size_t k) const;

private:
  struct Place {
    double weight = 0;
    Eigen::Vector3d at; ///< in standard deviations along each axis
  };
  [[nodiscard]] Eigen::VectorXd mean(std::size_t k) const;

  Belief narrow_; ///< about the wide one's mean
  Eigen::Vector3d sd_;
  Eigen::MatrixXd along_; ///< what all unknowns change by, by one standard deviation of each axis
  std::vector<Place> places_;
};

} // namespace umov::inverse
