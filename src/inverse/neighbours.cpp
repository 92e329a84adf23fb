#include "inverse/neighbours.h"

#include "algebra/dense.h"

#include <algorithm>
#include <cmath>

namespace umov::inverse {

Neighbours Neighbours::alike(Eigen::Index unknowns, double distance) {
  Neighbours out;
  out.axes_ = Eigen::MatrixXd::Identity(unknowns, unknowns);
  out.distances_ = Eigen::VectorXd::Constant(unknowns, distance);
  return out;
}

Neighbours Neighbours::half_widths(const Eigen::MatrixXd &information, double longest) {
  constexpr double shortest = 1e-6; // [rad]: light in single precision tells no less
  const auto eigen = algebra::symmetric_eigen(information);
  Neighbours out;
  out.axes_ = eigen.vectors;
  out.distances_ = eigen.values.unaryExpr([&](double value) {
    return std::clamp(0.5 / std::sqrt(std::max(value, 1e-12)), std::min(shortest, longest),
                      longest);
  });
  out.has_both_sides_ = true;
  return out;
}

std::size_t Neighbours::count() const {
  return static_cast<std::size_t>(distances_.size()) * (has_both_sides_ ? 2 : 1);
}

Step Neighbours::step(std::size_t neighbour) const {
  const auto k = static_cast<Eigen::Index>(neighbour);
  if (!has_both_sides_)
    return axes_.col(k) * distances_[k];
  return axes_.col(k / 2) * (k % 2 == 0 ? distances_[k / 2] : -distances_[k / 2]);
}

Eigen::MatrixXd Neighbours::jacobian(const std::vector<double> &centre,
                                     std::span<const std::vector<double> *const> residuals) const {
  using View = Eigen::Map<const Eigen::VectorXd>;
  const auto rows = static_cast<Eigen::Index>(centre.size());
  const auto at = [&](Eigen::Index k) {
    return View(residuals[static_cast<std::size_t>(k)]->data(), rows);
  };
  Eigen::MatrixXd along(rows, distances_.size());
  for (Eigen::Index k = 0; k < distances_.size(); ++k)
    if (has_both_sides_)
      along.col(k) = (at(2 * k) - at(2 * k + 1)) / (2 * distances_[k]);
    else
      along.col(k) = (at(k) - View(centre.data(), rows)) / distances_[k];
  return algebra::product(along, axes_.transpose());
}

} // namespace umov::inverse
