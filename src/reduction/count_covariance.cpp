#include "reduction/count_covariance.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace umov {
namespace {

using Matrix = algebra::MatrixXd;
using Vector = algebra::VectorXd;

} // namespace

CommonEffects effects_of(std::span<const CommonError> common, Eigen::Index rows) {
  const auto is_own = [](const CommonError &one) { return one.effect.size() == 1; };
  const auto shared =
      static_cast<Eigen::Index>(common.size()) - std::ranges::count_if(common, is_own);
  CommonEffects out{Vector::Zero(rows), Matrix::Zero(rows, shared)};
  Eigen::Index column = 0;
  for (const CommonError &one : common) {
    const auto first = static_cast<Eigen::Index>(one.first),
               size = static_cast<Eigen::Index>(one.effect.size());
    const Vector effect = Eigen::Map<const Vector>(one.effect.data(), size) * one.sd;
    if (is_own(one))
      out.own(first) += effect(0) * effect(0);
    else
      out.shared.col(column++).segment(first, size) = effect;
  }
  return out;
}

CountCovariance::CountCovariance(const Vector &variance, const Vector &light,
                                 const AirOfCounts *air, Matrix effects)
    : weight_(variance.cwiseInverse()), light_(light), air_(air), effects_(std::move(effects)) {
  if (air_ != nullptr) {
    flickers_ = light_;
    widened_ = Vector::Ones(air_->flicker.size());
    for (Eigen::Index k = 0; k < light_.size(); ++k) {
      const Eigen::Index pupil = air_->pupil[static_cast<std::size_t>(k)];
      flickers_(k) *= air_->flicker(pupil);
      widened_(pupil) += flickers_(k) * flickers_(k) * weight_(k);
    }
    if (!air_->cloud.empty()) {
      clouded_ = own_inverse_times(light_).col(0);
      cloud_weights_ = Vector::Zero(air_->cloud.moments());
      for (Eigen::Index k = 0; k < light_.size(); ++k)
        cloud_weights_(air_->cloud.moment(static_cast<std::size_t>(k))) += light_(k) * clouded_(k);
    }
  }
  if (effects_.cols() == 0)
    return;
  weighted_effects_ = airy_inverse_times(effects_);
  small_.emplace(Matrix::Identity(effects_.cols(), effects_.cols()) +
                 algebra::transposed_product(effects_, weighted_effects_));
}

/// Every pupil is a diagonal and what its counts share (Sherman & Morrison).
Matrix CountCovariance::own_inverse_times(const Matrix &m) const {
  Matrix out = weight_.asDiagonal() * m;
  if (air_ == nullptr)
    return out;
  Matrix along = Matrix::Zero(widened_.size(), m.cols());
  for (Eigen::Index k = 0; k < m.rows(); ++k)
    along.row(air_->pupil[static_cast<std::size_t>(k)]) += flickers_(k) * out.row(k);
  for (Eigen::Index k = 0; k < m.rows(); ++k) {
    const Eigen::Index pupil = air_->pupil[static_cast<std::size_t>(k)];
    out.row(k) -= weight_(k) * flickers_(k) / widened_(pupil) * along.row(pupil);
  }
  return out;
}

/// The same under the cloud (Woodbury).
Matrix CountCovariance::airy_inverse_times(const Matrix &m) const {
  Matrix out = own_inverse_times(m);
  if (air_ == nullptr || air_->cloud.empty())
    return out;
  const CloudChain &cloud = air_->cloud;
  Matrix seen = Matrix::Zero(cloud.moments(), m.cols());
  for (Eigen::Index k = 0; k < m.rows(); ++k)
    seen.row(cloud.moment(static_cast<std::size_t>(k))) += clouded_(k) * m.row(k);
  const Matrix found = cloud.solve(cloud_weights_, std::move(seen));
  for (Eigen::Index k = 0; k < m.rows(); ++k)
    out.row(k) -= clouded_(k) * found.row(cloud.moment(static_cast<std::size_t>(k)));
  return out;
}

Matrix CountCovariance::inverse_times(const Matrix &m) const {
  Matrix out = airy_inverse_times(m);
  if (small_)
    out -= algebra::product(weighted_effects_,
                            small_->solve_columns(algebra::transposed_product(effects_, out)));
  return out;
}

double CountCovariance::log_determinant() const {
  double out = -weight_.array().log().sum();
  if (air_ != nullptr)
    out += widened_.array().log().sum();
  if (air_ != nullptr && !air_->cloud.empty())
    out += air_->cloud.log_determinant(cloud_weights_);
  return small_ ? out + small_->log_determinant() : out;
}

} // namespace umov
