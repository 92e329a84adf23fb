#include "inverse/track_update.h"

#include "algebra/dense.h"
#include "inverse/part_mix.h"

#include <algorithm>
#include <cmath>

namespace umov::inverse {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

constexpr Index turns = 3; // columns of the root that turn the body

/// Residuals of a light at some unknowns.
class PointResiduals {
public:
  PointResiduals(const CurveLikelihood &likelihood, const ModelLight &light)
      : likelihood_(likelihood), light_(light), mix_(light) {}
  VectorXd at(const VectorXd &unknowns) {
    const double *const gains = unknowns.data() + nuisances_at;
    const std::size_t groups = likelihood_.groups();
    const auto all = static_cast<std::size_t>(unknowns.size() - nuisances_at);
    mix_.set({gains + groups, all - groups});
    found_ = likelihood_.compare_at({mix_.i(), mix_.q(), mix_.u(), light_.i_half_width},
                                    {gains, groups});
    return Eigen::Map<const VectorXd>(found_.residuals.data(),
                                      static_cast<Index>(found_.residuals.size()));
  }
  /// Of the last ones.
  [[nodiscard]] const Comparison &found() const { return found_; }
  [[nodiscard]] const PartMix &mix() const { return mix_; }

private:
  const CurveLikelihood &likelihood_;
  const ModelLight &light_;
  PartMix mix_;
  Comparison found_;
};

} // namespace

FilterUpdate::FilterUpdate(Belief before, const CurveLikelihood &likelihood)
    : before_(std::move(before)), now_(before_), likelihood_(likelihood),
      first_root_(lower_root(before_.covariance)), best_(before_) {
  spread();
}

/// Sigma points about the belief of now.
void FilterUpdate::spread() {
  root_ = lower_root(now_.covariance);
  const Index n = root_.rows();
  constexpr double least_rad = 2e-3; // masks are steps on a finer scale
  reach_ = VectorXd::Constant(n, std::sqrt(3.0));
  for (Index c = 0; c < turns; ++c)
    if (const double turn = root_.col(c).head<3>().norm(); turn > 0)
      reach_[c] = std::max(reach_[c], least_rad / turn);
  up_.assign(static_cast<std::size_t>(n), {});
  down_.assign(static_cast<std::size_t>(n), {});
}

VectorXd FilterUpdate::point(Index column, double sign) const {
  return now_.mean + sign * reach_[column] * root_.col(column);
}

Turning FilterUpdate::attitude(std::size_t which) const {
  if (which == 0)
    return {attitude_of(now_, now_.mean), {}};
  const auto column = static_cast<Index>((which - 1) / 2);
  return {attitude_of(now_, point(column, which % 2 == 1 ? 1 : -1)), {}};
}

void FilterUpdate::take(std::size_t which, const ModelLight &light) {
  PointResiduals of(likelihood_, light);
  if (which > 0) {
    const std::size_t column = (which - 1) / 2;
    const bool is_up = which % 2 == 1;
    (is_up ? up_ : down_)[column] = of.at(point(static_cast<Index>(column), is_up ? 1 : -1));
    return;
  }
  for (Index c = turns; c < root_.cols(); ++c) { // the same attitude
    up_[static_cast<std::size_t>(c)] = of.at(point(c, 1));
    down_[static_cast<std::size_t>(c)] = of.at(point(c, -1));
  }
  middle_ = of.at(now_.mean);
  more_ = of.found().minus_2_log;
  light_ = {of.mix().i(), of.mix().q(), of.mix().u()};
}

FilterUpdate::Line FilterUpdate::line(Index columns) const {
  const auto trust = likelihood_.trust({middle_.data(), static_cast<std::size_t>(middle_.size())});
  const Eigen::Map<const Eigen::ArrayXd> root(trust.root.data(), middle_.size());
  Line out{middle_, MatrixXd(middle_.size(), columns), MatrixXd(middle_.size(), columns), 0};
  for (Index c = 0; c < columns; ++c) {
    const VectorXd &up = up_[static_cast<std::size_t>(c)],
                   &down = down_[static_cast<std::size_t>(c)];
    out.by_root.col(c) = (root * (up - down).array()) / (2 * reach_[c]);
    out.bends.col(c) = (root * (up + down - 2 * middle_).array()) / (reach_[c] * reach_[c]);
  }
  const VectorXd trusted = root * middle_.array();
  out.middle = trusted + out.bends.rowwise().sum() / 2;
  out.more = more_ - trusted.squaredNorm();
  return out;
}

FilterUpdate::Bend FilterUpdate::bend() const {
  const Line now = line(turns);
  Bend out;
  for (Index c = 0; c < turns; ++c)
    if (const double square = now.bends.col(c).squaredNorm() / 2; square > out.square)
      out = {c, square};
  return out;
}

/// -2 ln of the posterior at the middle, up to a constant.
double FilterUpdate::cost() const {
  return more_ + square_in(first_root_, now_.mean - before_.mean);
}

void FilterUpdate::step() {
  constexpr int most = 12;            // whole steps
  constexpr double settled = 0.04;    // square of a step in standard deviations
  constexpr double first = 4, by = 8; // what a power lets in of what is not known yet
  const bool was_whole = power_ >= 1;
  if (const double cost_now = cost(); was_whole && !(cost_now < least_)) {
    now_.mean = (now_.mean + best_.mean) / 2; // too far: half of the way
    now_.covariance = best_.covariance;
    is_done_ = ++steps_ >= most;
    if (!is_done_)
      return spread();
    now_ = best_;
    return;
  } else if (was_whole) {
    least_ = cost_now;
    best_ = now_;
  }
  const Line now = line(root_.cols());
  const MatrixXd slopes = over_root(now.by_root, root_);
  const MatrixXd cross = algebra::product(slopes, before_.covariance);
  const MatrixXd spread_of = algebra::product(cross, slopes.transpose());
  // Other epochs bend the same way: an error that is not new each time counts as often as it comes
  // (with 1 the truth was 2.8 times as far off as thirty filters of a box said, with 10 it is 1.1).
  constexpr double again = 10;
  MatrixXd noise = algebra::product(now.bends, now.bends.transpose()) * (again / 2);
  noise.diagonal().array() += 1;
  if (power_ < 1) {
    const double told = algebra::SymmetricFactor(noise).solve_columns(spread_of).trace();
    power_ = power_ > 0 ? std::min(1.0, by * power_) : std::min(1.0, first / std::max(told, first));
  }
  const algebra::SymmetricFactor sum(spread_of + noise / power_);
  const VectorXd innovation = now.middle + slopes * (before_.mean - now_.mean);
  const VectorXd weighed = sum.solve(innovation);
  const VectorXd mean = before_.mean - cross.transpose() * weighed;
  MatrixXd covariance =
      before_.covariance - algebra::product(cross.transpose(), sum.solve_columns(cross));
  covariance = ((covariance + covariance.transpose()) / 2).eval();
  chi2_ = innovation.dot(weighed);
  log_evidence_ = -(chi2_ + sum.log_determinant() + now.more) / 2;
  const double moved = square_in(lower_root(covariance), mean - now_.mean);
  now_.mean = mean;
  now_.covariance = covariance;
  is_done_ = power_ >= 1 && (moved < settled || ++steps_ >= most);
  if (!is_done_)
    spread();
}

} // namespace umov::inverse
