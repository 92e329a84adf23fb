// How much light the parts of a body give, and how rough they are, as fits best at one attitude:
// docs/theory/inverse.md, section 2.

#include "inverse/likelihood_sums.h"
#include "inverse/part_mix.h"

#include "algebra/dense.h"

#include <algorithm>
#include <cmath>

namespace umov::inverse {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// One fit. Unknowns are those of PartMix.
class PartFit {
public:
  PartFit(const CurveLikelihood &likelihood, const ModelLight &model);
  CurveLikelihood::FittedLight run(std::span<const double> near);

private:
  /// A number that is linear in the light: I of a sample, or electrons of a channel.
  struct Linear {
    std::size_t at = 0, group = 0;
    double data = 0, light = 0;
  };
  void put_rows(const Weighed &data);
  void set(const VectorXd &off);
  void residuals();
  [[nodiscard]] double misfit() const;
  bool trust();
  void jacobian();
  void eliminate(MatrixXd &normal) const;
  bool step(VectorXd &off);
  bool settle(VectorXd &best);

  const CurveLikelihood &of_;
  const ModelLight &model_;
  std::size_t cells_;
  PartMix mix_; ///< the light now
  std::vector<Linear> linear_;
  MatrixXd linear_parts_;           ///< light of the parts in those numbers
  std::vector<std::size_t> ratios_; ///< rows with q and u
  std::vector<double> root_;        ///< of what each number is trusted
  std::vector<double> light_;       ///< of the linear numbers now
  Gains gains_;
  GainSums sums_;
  VectorXd residual_;
  MatrixXd jacobian_;
  double log_det_ = 0;
};

PartFit::PartFit(const CurveLikelihood &likelihood, const ModelLight &model)
    : of_(likelihood), model_(model), cells_(model.i.size()), mix_(model) {
  put_rows(of_.weigh(model));
  light_.resize(linear_.size());
  const auto numbers = static_cast<Index>(linear_.size() + 2 * ratios_.size());
  residual_.resize(numbers);
  root_.assign(static_cast<std::size_t>(numbers), 1);
  jacobian_.resize(numbers, static_cast<Index>(mix_.unknowns().size()));
}

void PartFit::put_rows(const Weighed &data) {
  std::vector<std::pair<std::size_t, double>> from; // row, root of its weight
  for (std::size_t k = 0; k < of_.rows_.size(); ++k) {
    const auto &row = of_.rows_[k];
    if (row.l_qq > 0 && model_.i[row.at] > 0)
      ratios_.push_back(k);
    if (!(data.weights[k] > 0))
      continue;
    const double root = std::sqrt(data.weights[k]);
    from.emplace_back(k, root);
    linear_.push_back({row.at, row.group, root * row.i, root * model_.i[row.at]});
  }
  if (of_.counts_)
    for (const auto &set : of_.counts_->sets())
      for (std::size_t k = set.begin; k < set.begin + set.size; ++k)
        linear_.push_back({set.at, set.group, data.counts.net[k], data.counts.light[k]});
  const auto parts = static_cast<Index>(model_.parts.size());
  linear_parts_.resize(static_cast<Index>(linear_.size()), parts);
  for (Index p = 0; p < parts; ++p)
    for (std::size_t k = 0; k < linear_.size(); ++k)
      linear_parts_(static_cast<Index>(k), p) =
          k < from.size()
              ? from[k].second * model_.parts[static_cast<std::size_t>(p)].i[linear_[k].at]
              : data.counts.parts[static_cast<std::size_t>(p)][k - from.size()];
}

void PartFit::set(const VectorXd &off) {
  mix_.set({off.data(), static_cast<std::size_t>(off.size())});
}

/// Puts residuals of the best gains.
void PartFit::residuals() {
  sums_ = GainSums{std::vector<double>(of_.groups_, 0), std::vector<double>(of_.groups_, 0)};
  for (std::size_t k = 0; k < linear_.size(); ++k)
    light_[k] = linear_[k].light;
  for (std::size_t p = 0; p < model_.parts.size(); ++p) {
    const double *const factor = &mix_.factor()[p * cells_];
    const auto part = linear_parts_.col(static_cast<Index>(p));
    for (std::size_t k = 0; k < linear_.size(); ++k)
      light_[k] += (factor[linear_[k].at] - 1) * part[static_cast<Index>(k)];
  }
  for (std::size_t k = 0; k < linear_.size(); ++k)
    sums_.add(linear_[k].group, root_[k] * root_[k], linear_[k].data, light_[k]);
  gains_ = of_.gains_of(sums_);
  for (std::size_t k = 0; k < linear_.size(); ++k)
    residual_[static_cast<Index>(k)] =
        root_[k] * (linear_[k].data - gains_.gain[linear_[k].group] * light_[k]);
  for (std::size_t j = 0; j < ratios_.size(); ++j) {
    const auto &row = of_.rows_[ratios_[j]];
    const double light = std::max(mix_.i()[row.at], 1e-9 * model_.i[row.at]);
    const double dq = row.q - mix_.q()[row.at] / light, du = row.u - mix_.u()[row.at] / light;
    const std::size_t at = linear_.size() + 2 * j;
    residual_[static_cast<Index>(at)] = root_[at] * row.l_qq * dq;
    residual_[static_cast<Index>(at + 1)] = root_[at + 1] * (row.l_uq * dq + row.l_uu * du);
  }
}

/// What a fit lessens, without the parts' priors: chi-square, or -2 ln of the mixture, which falls
/// with every step of reweighted least squares while chi-square rises as numbers are trusted more.
double PartFit::misfit() const {
  if (!(of_.errors_.outlier_share > 0))
    return residual_.squaredNorm() + gains_.prior_chi2;
  const double wide = of_.errors_.outlier_factor, share = of_.errors_.outlier_share;
  double out = gains_.prior_chi2;
  for (std::size_t k = 0; k < root_.size(); ++k) {
    const double x2 = std::pow(residual_[static_cast<Index>(k)] / root_[k], 2);
    // The wide one taken out, whose exponential would be 0 far out.
    const double beyond = std::exp(-x2 / 2 * (1 - 1 / (wide * wide)));
    out += x2 / (wide * wide) - 2 * std::log((1 - share) * beyond + share / wide);
  }
  return out;
}

/// Numbers that are likely wrong count less, each by itself, as in the mixture of `compare`; false
/// if all are trusted.
bool PartFit::trust() {
  if (!(of_.errors_.outlier_share > 0))
    return false;
  const double wide = of_.errors_.outlier_factor, share = of_.errors_.outlier_share;
  for (std::size_t k = 0; k < root_.size(); ++k) {
    const double x = residual_[static_cast<Index>(k)] / root_[k];
    // Which of both it is by logarithms: far out both densities are 0 in double precision.
    const double odds =
        std::log(share / ((1 - share) * wide)) + x * x / 2 * (1 - 1 / (wide * wide));
    const double wrong = 1 / (1 + std::exp(-odds));
    root_[k] = std::sqrt(1 - wrong + wrong / (wide * wide));
  }
  return true;
}

void PartFit::jacobian() {
  std::vector<double> by_light(linear_.size()), all(ratios_.size());
  for (std::size_t k = 0; k < linear_.size(); ++k)
    by_light[k] = -root_[k] * gains_.gain[linear_[k].group];
  for (std::size_t j = 0; j < ratios_.size(); ++j) {
    const std::size_t cell = of_.rows_[ratios_[j]].at;
    all[j] = std::max(mix_.i()[cell], 1e-9 * model_.i[cell]);
  }
  // What a part adds to a column, by the derivative of the factor of its light.
  const auto add = [&](std::size_t number, double *column, auto bend) {
    const PartLight &part = model_.parts[number];
    const double *const factor = &mix_.factor()[number * cells_];
    const double *const own = linear_parts_.col(static_cast<Index>(number)).data();
    for (std::size_t k = 0; k < linear_.size(); ++k) {
      const std::size_t cell = linear_[k].at;
      column[k] += by_light[k] * factor[cell] * bend(cell) * own[k];
    }
    for (std::size_t j = 0; j < ratios_.size(); ++j) {
      const auto &row = of_.rows_[ratios_[j]];
      const double more = factor[row.at] * bend(row.at) / all[j];
      const double dq = -more * (part.q[row.at] - mix_.q()[row.at] / all[j] * part.i[row.at]);
      const double du = -more * (part.u[row.at] - mix_.u()[row.at] / all[j] * part.i[row.at]);
      const std::size_t at = linear_.size() + 2 * j;
      column[at] += root_[at] * row.l_qq * dq;
      column[at + 1] += root_[at + 1] * (row.l_uq * dq + row.l_uu * du);
    }
  };
  jacobian_.setZero();
  for (std::size_t n = 0; n < mix_.unknowns().size(); ++n) {
    const PartMix::Unknown &unknown = mix_.unknowns()[n];
    double *const column = jacobian_.col(static_cast<Index>(n)).data();
    if (unknown.bends == 0)
      add(unknown.part, column, [&](std::size_t) { return model_.parts[unknown.part].sd; });
    for (std::size_t b = unknown.first; b < unknown.first + unknown.bends; ++b) {
      const double *const bend = &mix_.bend()[b * cells_];
      add(mix_.bent()[b], column, [&](std::size_t cell) { return bend[cell]; });
    }
  }
}

/// The gains and their scale move with the parts, and are eliminated (Schur's complement): gains of
/// groups, which are normal about the scale, then the scale itself.
void PartFit::eliminate(MatrixXd &normal) const {
  const auto count = static_cast<Index>(mix_.unknowns().size());
  const bool has_clouds = of_.errors_.has_clouds;
  MatrixXd along = MatrixXd::Zero(count, static_cast<Index>(of_.groups_));
  for (Index n = 0; n < count; ++n)
    for (std::size_t k = 0; k < linear_.size(); ++k)
      along(n, static_cast<Index>(linear_[k].group)) -=
          root_[k] * light_[k] * jacobian_(static_cast<Index>(k), n);
  // As gains_of has it, about the scale.
  const double sd = std::max(of_.errors_.zero_point_sd, 1e-6) * gains_.scale;
  const double stiffness = has_clouds ? 0 : 1 / (sd * sd);
  VectorXd by_scale = VectorXd::Zero(count);
  double scale = of_.is_absolute_ && of_.errors_.scale_sd > 0
                     ? 1 / (of_.errors_.scale_sd * of_.errors_.scale_sd)
                     : 0;
  for (std::size_t g = 0; g < of_.groups_; ++g) {
    const double own = sums_.square[g] + stiffness;
    if (!(own > 0))
      continue;
    const auto column = along.col(static_cast<Index>(g));
    normal -= column * column.transpose() / own;
    by_scale += column * (stiffness / own);
    scale += stiffness * sums_.square[g] / own;
  }
  if (!has_clouds && scale > 0)
    normal -= by_scale * by_scale.transpose() / scale;
}

/// A Gauss-Newton step; true if it was next to nothing.
bool PartFit::step(VectorXd &off) {
  jacobian();
  MatrixXd normal = algebra::gram(jacobian_);
  eliminate(normal);
  normal.diagonal().array() += 1; // the priors
  const algebra::SymmetricFactor factor(normal);
  log_det_ = factor.log_determinant();
  VectorXd by = factor.solve(-(algebra::transposed_times(jacobian_, residual_) + off));
  constexpr double longest = 2, smallest = 5e-3; // standard deviations
  const double length = by.cwiseAbs().maxCoeff();
  if (length > longest)
    by *= longest / length;
  off += by;
  return length < smallest;
}

/// Steps until they are next to nothing; false if they did not become so.
bool PartFit::settle(VectorXd &best) {
  VectorXd off = best;
  double least = 1e300;
  constexpr int rounds = 8;
  for (int round = 0; round < rounds && !mix_.unknowns().empty(); ++round) {
    set(off);
    residuals();
    const double objective = misfit() + off.squaredNorm();
    if (!(objective < least)) { // too far: half of the way
      if ((off - best).cwiseAbs().maxCoeff() < 1e-3)
        return false;
      off = (off + best) / 2;
      continue;
    }
    least = objective;
    best = off;
    if (trust())
      residuals(); // gains go with what each number counts
    if (step(off)) {
      best = off;
      return true;
    }
  }
  return mix_.unknowns().empty();
}

CurveLikelihood::FittedLight PartFit::run(std::span<const double> near) {
  VectorXd off = VectorXd::Zero(static_cast<Index>(mix_.unknowns().size()));
  bool is_at_rest = true;
  // One step more of numbers that are trusted anew is no derivative: reweighting comes to rest in
  // many steps, each a part of what is left.
  const bool is_mixture = of_.errors_.outlier_share > 0;
  if (!is_mixture && !near.empty() && near.size() == mix_.unknowns().size()) {
    std::ranges::copy(near, off.begin());
    set(off);
    residuals();
    step(off);
  } else {
    is_at_rest = settle(off);
  }
  set(off);
  return {mix_.i(), mix_.q(),  mix_.u(), {off.data(), off.data() + off.size()},
          log_det_, is_at_rest};
}

} // namespace umov::inverse

namespace umov {

CurveLikelihood::FittedLight CurveLikelihood::fit_parts(const ModelLight &model,
                                                        std::span<const double> near) const {
  return inverse::PartFit(*this, model).run(near);
}

} // namespace umov
