#include <umov/inverse/likelihood.h>

#include "inverse/likelihood_sums.h"
#include <umov/inverse/sample_errors.h>

#include <algorithm>
#include <cmath>

namespace umov {

double chi2_probability(double chi2, double dof) {
  if (!(dof > 0))
    return 1;
  const double k = 2 / (9 * dof);
  const double z = (std::cbrt(chi2 / dof) - (1 - k)) / std::sqrt(k);
  return std::erfc(z / std::sqrt(2.0)) / 2;
}

using inverse::Gains;

CurveLikelihood::CurveLikelihood(const ObservedCurve &curve, const CurveErrors &errors,
                                 std::span<const std::size_t> epochs)
    : bands_(curve.bands), errors_(errors), is_absolute_(curve.is_absolute) {
  median_i_ = errors.median_i > 0 ? errors.median_i : inverse::median_of_i(curve);
  groups_ = errors.has_clouds ? curve.epochs.size() : curve.bands.size();
  // One channel says nothing of I by itself while q and u are left aside: reduced sets do.
  if (!curve.counts.empty() && errors.has_polarization) {
    counts_ = std::make_shared<const inverse::CountLikelihood>(curve, errors, median_i_, epochs);
    measurements_ = counts_->size();
    return;
  }
  for (const ObservedSample &s : curve.samples) {
    if (!epochs.empty() && !std::ranges::binary_search(epochs, s.epoch))
      continue;
    Row row;
    row.at = s.epoch * curve.bands.size() + s.band;
    row.group = errors.has_clouds ? s.epoch : s.band;
    const inverse::SampleErrors known = inverse::errors_of(s, errors, median_i_);
    log_variance_ += known.log_variance;
    if (known.i_variance > 0) {
      row.i = s.i;
      row.weight = 1 / known.i_variance;
      ++measurements_;
    }
    if (known.l_qq > 0) {
      row.q = s.q;
      row.u = s.u;
      row.l_qq = known.l_qq;
      row.l_uu = known.l_uu;
      row.l_uq = known.l_uq;
      measurements_ += 2;
    }
    if (row.weight > 0 || row.l_qq > 0)
      rows_.push_back(row);
  }
}

std::size_t CurveLikelihood::residual_count() const {
  return 3 * rows_.size() + (counts_ ? counts_->size() : 0) + (errors_.has_clouds ? 0 : groups_) +
         1;
}

std::vector<CurveLikelihood::Block> CurveLikelihood::blocks() const {
  std::vector<Block> out;
  for (std::size_t k = 0; k < rows_.size(); ++k)
    out.push_back({3 * k, 3, (rows_[k].weight > 0 ? 1. : 0.) + (rows_[k].l_qq > 0 ? 2. : 0.)});
  if (counts_)
    for (const auto &set : counts_->sets())
      out.push_back({3 * rows_.size() + set.begin, set.size, static_cast<double>(set.size)});
  return out;
}

std::vector<CurveLikelihood::Place> CurveLikelihood::places() const {
  std::vector<Place> out;
  const std::size_t bands = bands_.size();
  for (std::size_t k = 0; k < rows_.size(); ++k)
    if (rows_[k].weight > 0)
      out.push_back({rows_[k].at / bands, rows_[k].at % bands, 3 * k, 1});
  if (counts_)
    for (const auto &set : counts_->sets())
      out.push_back({set.at / bands, set.at % bands, 3 * rows_.size() + set.begin, set.size});
  return out;
}

std::vector<CurveLikelihood::Number> CurveLikelihood::numbers() const {
  std::vector<Number> out;
  const std::size_t bands = bands_.size();
  for (const Row &row : rows_) {
    const std::size_t band = row.at % bands;
    const Measured ratio = row.l_qq > 0 ? Measured::Polarization : Measured::Nothing;
    out.push_back({row.weight > 0 ? Measured::Intensity : Measured::Nothing, band});
    out.insert(out.end(), 2, {ratio, band});
  }
  if (counts_)
    for (const auto &set : counts_->sets())
      out.insert(out.end(), set.size, {Measured::Electrons, set.at % bands});
  return out;
}

/// Weights of the rows: those of the data, less where the model itself is not sure.
CurveLikelihood::Weighed CurveLikelihood::weigh_at(const ModelLight &model, double scale) const {
  Weighed out;
  if (counts_) { // variances of the model's counts
    out.counts = counts_->whitened(model, scale);
    out.scale = scale;
    out.grown = out.counts.log_det;
    return out;
  }
  std::vector<double> &weights = out.weights;
  weights.resize(rows_.size());
  for (std::size_t k = 0; k < rows_.size(); ++k)
    weights[k] = rows_[k].weight;
  if (model.i_half_width.empty())
    return out;
  constexpr double half_width = 1.96; // of a normal error, in standard deviations
  for (std::size_t k = 0; k < rows_.size(); ++k) {
    const double sd = scale / half_width * model.i_half_width[rows_[k].at];
    const double factor = 1 + weights[k] * sd * sd;
    weights[k] /= factor;
    out.grown += std::log(factor);
  }
  return out;
}

/// The same at the scale that the data ask for themselves.
CurveLikelihood::Weighed CurveLikelihood::weigh(const ModelLight &model) const {
  double cross = 0, square = 0;
  const auto best = [&] { return square > 0 ? std::max(cross / square, 0.0) : 0; };
  if (!counts_) {
    for (const Row &row : rows_) {
      const double m = model.i[row.at];
      cross += row.weight * row.i * m;
      square += row.weight * m * m;
    }
    return weigh_at(model, best());
  }
  Weighed out;
  double scale = counts_->first_scale(model);
  constexpr int rounds = 2;
  for (int round = 0; round < rounds; ++round) {
    out = weigh_at(model, scale);
    cross = square = 0;
    for (std::size_t k = 0; k < counts_->size(); ++k) {
      cross += out.counts.net[k] * out.counts.light[k];
      square += out.counts.light[k] * out.counts.light[k];
    }
    scale = best();
  }
  return out;
}

CurveLikelihood::GainSums CurveLikelihood::sums_of(const ModelLight &model,
                                                   const Weighed &data) const {
  GainSums out{std::vector<double>(groups_, 0), std::vector<double>(groups_, 0)};
  for (std::size_t k = 0; k < rows_.size(); ++k)
    if (rows_[k].weight != 0)
      out.add(rows_[k].group, data.weights[k], rows_[k].i, model.i[rows_[k].at]);
  if (counts_)
    for (const auto &set : counts_->sets())
      for (std::size_t k = set.begin; k < set.begin + set.size; ++k)
        out.add(set.group, 1, data.counts.net[k], data.counts.light[k]);
  return out;
}

/// The best gains, by least squares: without clouds the gain of a band is normal around the scale,
/// g_b = s (1 + z_b), which for a given s is linear, and so is s then (section 2 of the page).
Gains CurveLikelihood::gains_of(const GainSums &sums) const {
  const auto &[cross, square, all_cross, all_square] = sums;
  constexpr double least = 1e-9; // light is not negative, however dark the data
  Gains out;
  out.gain.assign(groups_, 1);
  if (!(all_square > 0))
    return out;
  const double first = std::max(all_cross / all_square, least);
  out.scale = first;
  if (errors_.has_clouds) {
    for (std::size_t g = 0; g < groups_; ++g) {
      out.gain[g] = square[g] > 0 ? std::max(cross[g] / square[g], least) : 1;
      // The integral over ln of the gain, as of the scale below. Over the gain itself it would
      // prefer models that are dark but for one epoch, by as much as the others are darker.
      out.log_det += square[g] > 0 ? std::log1p(square[g] * out.gain[g] * out.gain[g]) : 0;
    }
    return out;
  }
  const double stiffness = 1 / std::pow(std::max(errors_.zero_point_sd, 1e-6) * first, 2);
  double top = 0, bottom = 0;
  for (std::size_t g = 0; g < groups_; ++g) {
    const double part = stiffness / (square[g] + stiffness);
    top += cross[g] * part;
    bottom += square[g] * part;
    out.log_det += std::log1p(square[g] / stiffness);
  }
  const bool has_scale_prior = is_absolute_ && errors_.scale_sd > 0;
  if (has_scale_prior) { // around 1, on top of what the light says
    top += 1 / (errors_.scale_sd * errors_.scale_sd);
    bottom += 1 / (errors_.scale_sd * errors_.scale_sd);
  }
  out.scale = std::max(top / bottom, least);
  // The integral over ln s; of light that is lost in noise it is that of a prior one e-fold wide,
  // and no model gains by being dark.
  out.log_det += std::log1p(bottom * out.scale * out.scale);
  for (std::size_t g = 0; g < groups_; ++g) {
    out.gain[g] = (cross[g] + stiffness * out.scale) / (square[g] + stiffness);
    const double off = (out.gain[g] - out.scale) * std::sqrt(stiffness);
    out.prior_chi2 += off * off;
  }
  if (has_scale_prior)
    out.prior_chi2 += std::pow((out.scale - 1) / errors_.scale_sd, 2);
  return out;
}

double CurveLikelihood::fill(const ModelLight &model, const Gains &gains, const Weighed &data,
                             std::vector<double> &residuals) const {
  residuals.assign(residual_count(), 0);
  double chi2 = 0;
  for (std::size_t k = 0; k < rows_.size(); ++k) {
    const Row &row = rows_[k];
    const double m = model.i[row.at];
    double *const r = &residuals[3 * k];
    r[0] = std::sqrt(data.weights[k]) * (row.i - gains.gain[row.group] * m);
    if (row.l_qq > 0) {
      const double dq = row.q - (m > 0 ? model.q[row.at] / m : 0);
      const double du = row.u - (m > 0 ? model.u[row.at] / m : 0);
      r[1] = row.l_qq * dq;
      r[2] = row.l_uq * dq + row.l_uu * du;
    }
    chi2 += r[0] * r[0] + r[1] * r[1] + r[2] * r[2];
  }
  if (counts_)
    for (const auto &set : counts_->sets())
      for (std::size_t k = set.begin; k < set.begin + set.size; ++k) {
        double &r = residuals[3 * rows_.size() + k];
        r = data.counts.net[k] - gains.gain[set.group] * data.counts.light[k];
        chi2 += r * r;
      }
  residuals.back() = std::sqrt(gains.prior_chi2);
  return chi2 + gains.prior_chi2;
}

Comparison CurveLikelihood::compare(const ModelLight &model, std::span<const double> near) const {
  if (model.parts.empty())
    return compare_as_it_is(model);
  FittedLight fitted = fit_parts(model, near);
  Comparison out = compare_as_it_is({fitted.i, fitted.q, fitted.u, model.i_half_width});
  for (const double off : fitted.off) {
    out.chi2 += off * off;
    out.minus_2_log += off * off;
    out.residuals.push_back(off);
  }
  out.minus_2_log += fitted.log_det;
  if (fitted.is_at_rest)
    out.off = std::move(fitted.off);
  return out;
}

CurveLikelihood::Mixed CurveLikelihood::mixture(const Block &block,
                                                std::span<const double> residuals) const {
  const double wide = errors_.outlier_factor, share = errors_.outlier_share;
  double x2 = 0;
  for (std::size_t j = 0; j < block.size; ++j)
    x2 += residuals[block.begin + j] * residuals[block.begin + j];
  // The wide one taken out, whose exponential would be 0 far out.
  const double good = (1 - share) * std::exp(-x2 / 2 * (1 - 1 / (wide * wide)));
  const double bad = share / std::pow(wide, block.measurements);
  return {(good + bad / (wide * wide)) / (good + bad),
          x2 / (wide * wide) - 2 * std::log(good + bad)};
}

Comparison CurveLikelihood::compare_at(const ModelLight &model,
                                       std::span<const double> gains) const {
  Comparison out;
  Gains known;
  known.gain.assign(gains.begin(), gains.end());
  double sum = 0;
  for (const double gain : gains)
    sum += gain;
  out.scale = sum / static_cast<double>(gains.size());
  const Weighed data = weigh_at(model, out.scale);
  out.chi2 = fill(model, known, data, out.residuals);
  out.minus_2_log =
      data.grown + (errors_.outlier_share > 0 ? trust(out.residuals).minus_2_log : out.chi2);
  return out;
}

CurveLikelihood::Trust CurveLikelihood::trust(std::span<const double> residuals) const {
  Trust out{std::vector<double>(residuals.size(), 1), 0};
  if (!(errors_.outlier_share > 0)) {
    for (const double r : residuals)
      out.minus_2_log += r * r;
    return out;
  }
  for (const Block &block : blocks()) {
    const Mixed one = mixture(block, residuals);
    out.minus_2_log += one.minus_2_log;
    std::fill_n(out.root.begin() + static_cast<std::ptrdiff_t>(block.begin), block.size,
                std::sqrt(one.trust));
  }
  return out;
}

Comparison CurveLikelihood::compare_as_it_is(const ModelLight &model) const {
  Comparison out;
  const Weighed data = weigh(model);
  Gains gains = gains_of(sums_of(model, data));
  out.chi2 = fill(model, gains, data, out.residuals);
  out.minus_2_log = out.chi2 + gains.log_det + data.grown;
  out.scale = gains.scale;
  if (!(errors_.outlier_share > 0))
    return out;
  // Each row is good, or with a small probability wrong by a larger error: expectation
  // maximisation of the mixture, three rounds (Dempster, Laird & Rubin 1977).
  const std::vector<Block> all = blocks();
  std::vector<double> trusted(all.size(), 1);
  constexpr int rounds = 3;
  for (int round = 0; round < rounds; ++round) {
    out.minus_2_log = gains.log_det + gains.prior_chi2 + data.grown;
    for (std::size_t k = 0; k < all.size(); ++k) {
      const Mixed one = mixture(all[k], out.residuals);
      trusted[k] = one.trust;
      out.minus_2_log += one.minus_2_log;
    }
    if (round + 1 < rounds) {
      Weighed less = data;
      for (std::size_t k = 0; k < rows_.size(); ++k)
        less.weights[k] *= trusted[k];
      for (std::size_t k = rows_.size(); k < all.size(); ++k)
        for (std::size_t j = 0; j < all[k].size; ++j) {
          const std::size_t at = all[k].begin + j - 3 * rows_.size();
          less.counts.net[at] *= std::sqrt(trusted[k]);
          less.counts.light[at] *= std::sqrt(trusted[k]);
        }
      gains = gains_of(sums_of(model, less));
      // As before, residuals are whitened by all of the weight.
      out.chi2 = fill(model, gains, data, out.residuals);
    }
  }
  out.scale = gains.scale;
  for (std::size_t k = 0; k < all.size(); ++k) // least squares then see what the mixture does
    for (std::size_t j = 0; j < all[k].size; ++j)
      out.residuals[all[k].begin + j] *= std::sqrt(trusted[k]);
  out.chi2 = 0;
  for (const double r : out.residuals)
    out.chi2 += r * r;
  return out;
}

std::vector<Parameter> CurveLikelihood::nuisances() const {
  std::vector<Parameter> out;
  if (is_absolute_ && errors_.scale_sd > 0)
    out.push_back({"scale", "", 0, 1e3, Prior::Normal, 1, errors_.scale_sd});
  else
    out.push_back({"scale", "", 1e-30, 1e30, Prior::LogFlat});
  if (errors_.has_clouds)
    out.push_back({"transparency of each epoch", "", 1e-30, 1e30, Prior::LogFlat});
  else
    for (const std::string &band : bands_)
      out.push_back({"zero point of " + band, "", -1, 1, Prior::Normal, 0, errors_.zero_point_sd});
  return out;
}

} // namespace umov
