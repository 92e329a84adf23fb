#include "inverse/track_spread.h"

#include "algebra/dense.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <umov/core/quantity.h>

namespace umov::inverse {

using Eigen::Index;

namespace {

constexpr double cell_rad = 4 * pi / 180; // standard deviation of a narrow one
constexpr double apart = 1.5;             // of them, in those: their sum has ripples below 1 %
constexpr double reach = 3;               // in standard deviations of the wide one

/// Where narrow ones stand along a principal axis of a wide one, in its standard deviations.
std::vector<double> places_along(double sd, double cell) {
  if (!(sd > wide_rad))
    return {0};
  const double step = apart * cell / sd;
  const int count = static_cast<int>(std::ceil(reach / step));
  std::vector<double> out;
  for (int k = -count; k <= count; ++k)
    out.push_back(k * step);
  return out;
}

/// The same along all, as coarse as their number asks for; makes `cell` what they are wide.
std::array<std::vector<double>, 3> places_of(const Eigen::Vector3d &sd, std::size_t unknowns,
                                             double &cell) {
  constexpr double most = 8000, numbers = 2.5e6, coarser = 1.1; // of covariances together
  const double room = std::min(most, numbers / static_cast<double>(unknowns * unknowns));
  for (cell = cell_rad;; cell *= coarser) {
    std::array<std::vector<double>, 3> out;
    double count = 1;
    int wide = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      out[k] = places_along(sd[static_cast<Index>(k)], cell);
      count *= static_cast<double>(out[k].size());
      wide += out[k].size() > 1 ? 1 : 0;
    }
    if (count * (wide == 3 ? pi / 6 : wide == 2 ? pi / 4 : 1) <= room) // of the box the ball
      return out;
  }
}

} // namespace

SpreadBelief::SpreadBelief(const Belief &belief) : narrow_(belief) {
  const auto eigen = algebra::symmetric_eigen(belief.covariance.topLeftCorner(3, 3));
  sd_ = eigen.values.cwiseMax(0).cwiseSqrt();
  along_ = algebra::product(belief.covariance.leftCols(3), eigen.vectors);
  double cell = 0;
  const auto places = places_of(sd_, static_cast<std::size_t>(belief.mean.size()), cell);
  Eigen::Vector3d left = Eigen::Vector3d::Ones(); // of the variance along each axis: of the places
  for (Index k = 0; k < 3; ++k) {
    along_.col(k) /= std::max(sd_[k], 1e-12);
    if (places[static_cast<std::size_t>(k)].size() == 1)
      continue;
    left[k] = 1 - cell * cell / (sd_[k] * sd_[k]);
    narrow_.covariance -= left[k] * along_.col(k) * along_.col(k).transpose();
  }
  double sum = 0;
  for (const double x : places[0])
    for (const double y : places[1])
      for (const double z : places[2]) {
        const Eigen::Vector3d at(x, y, z);
        // Behind half a turn the same attitude stands on the other side.
        if (at.squaredNorm() > reach * reach || (along_.topRows(3) * at).norm() > pi)
          continue;
        places_.push_back({std::exp(-at.cwiseAbs2().cwiseQuotient(left).sum() / 2), at});
        sum += places_.back().weight;
      }
  for (Place &place : places_)
    place.weight /= sum;
}

Eigen::VectorXd SpreadBelief::mean(std::size_t k) const {
  return narrow_.mean + along_ * places_[k].at;
}

Quaternion SpreadBelief::attitude(std::size_t k) const { return attitude_of(narrow_, mean(k)); }

Belief SpreadBelief::belief(std::size_t k) const {
  Belief out = narrow_;
  out.mean = mean(k);
  return reset(out);
}

} // namespace umov::inverse
