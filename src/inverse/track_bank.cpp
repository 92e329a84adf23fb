#include <umov/inverse/track.h>

#include "inverse/tempered.h"
#include "inverse/track_spread.h"
#include "inverse/track_update.h"
#include "inverse/turning_fit.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <umov/core/quantity.h>
#include <umov/inverse/attitude_grid.h>
#include <utility>

namespace umov {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using inverse::Belief;
using inverse::FilterUpdate;

namespace {

/// Of a gain that a start told, in parts of it: no point of a filter, sqrt(3) standard deviations
/// off, has light below 0.
constexpr double gain_open = 0.5;
/// Share of the probability from which on a filter's doubt is the bank's.
constexpr double counting_share = 0.01;
/// Filters side by side where some are split.
constexpr std::size_t together = 60;

} // namespace

TrackMode track_mode(const Turning &turning, const std::vector<double> &covariance, double scale,
                     bool is_absolute, std::size_t bands, const std::vector<PartKind> &parts,
                     const CurveErrors &errors) {
  TrackMode out;
  out.turning = turning;
  const bool is_known = is_absolute && errors.scale_sd > 0;
  out.scale = is_known ? 1 : scale;
  const std::size_t gains = errors.has_clouds ? 1 : bands;
  out.nuisances.assign(gains, out.scale);
  for (const PartKind &part : parts)
    out.nuisances.insert(out.nuisances.end(), part.unknowns(), 0.0);
  const auto n = static_cast<Index>(inverse::nuisances_at + out.nuisances.size());
  MatrixXd all = MatrixXd::Identity(n, n); // of parts: in units of their priors
  all.topLeftCorner<6, 6>() = Eigen::Map<const MatrixXd>(covariance.data(), 6, 6);
  const double common = out.scale * (is_known ? errors.scale_sd : gain_open),
               own = out.scale * std::max(errors.zero_point_sd, 1e-6);
  const auto count = static_cast<Index>(gains);
  auto block = all.block(inverse::nuisances_at, inverse::nuisances_at, count, count);
  block.setConstant(common * common);
  block.diagonal().array() += own * own;
  out.covariance.assign(all.data(), all.data() + all.size());
  return out;
}

namespace {

/// A filter and what it is learning.
struct Learning {
  TrackMode mode;
  std::unique_ptr<FilterUpdate> update;
  bool is_whole = false; ///< it is as narrow as it shall be
};

/// The transparency of an epoch in clouds is its own: as open as it began.
void forget_gain(Belief &belief, double scale) {
  const Index at = inverse::nuisances_at;
  belief.mean[at] = scale;
  belief.covariance.row(at).setZero();
  belief.covariance.col(at).setZero();
  belief.covariance(at, at) = gain_open * gain_open * scale * scale;
}

/// A filter as its neighbours are asked for.
struct Neighbour {
  Belief belief;
  double log_determinant = 0;
};
Neighbour neighbour_of(const TrackMode &mode) {
  Neighbour out{inverse::belief_of(mode), 0};
  out.log_determinant = inverse::log_determinant(inverse::lower_root(out.belief.covariance));
  return out;
}

/// From one to the other: differences of their means.
VectorXd between(const Neighbour &one, const Neighbour &other) {
  VectorXd out = other.belief.mean - one.belief.mean;
  out.head<3>() = inverse::eigen_of(turn_between(one.belief.attitude, other.belief.attitude));
  return out;
}

/// They are one: Bhattacharyya's distance is that of two of the same covariance that lie a standard
/// deviation apart.
bool is_one(const Neighbour &one, const Neighbour &other, const VectorXd &apart) {
  constexpr double least = 0.125;
  // Their turns alone are farther apart than that, as of most: spares the rest.
  const auto variance = [](const Neighbour &n) {
    return n.belief.covariance.diagonal().head<3>().sum();
  };
  if (apart.head<3>().squaredNorm() > (variance(one) + variance(other)) / 2)
    return false;
  const MatrixXd middle = (one.belief.covariance + other.belief.covariance) / 2;
  const MatrixXd root = inverse::lower_root(middle);
  return inverse::square_in(root, apart) / 8 +
             (inverse::log_determinant(root) - (one.log_determinant + other.log_determinant) / 2) /
                 2 <
         least;
}

double log_sum(double a, double b) {
  return std::max(a, b) + std::log1p(std::exp(-std::abs(a - b)));
}

} // namespace

AttitudeBank::AttitudeBank(std::vector<TrackMode> modes, PoseLighting light,
                           std::vector<std::string> bands, std::vector<PartKind> parts,
                           const TrackOptions &options)
    : modes_(std::move(modes)), light_(std::move(light)), bands_(std::move(bands)),
      parts_(std::move(parts)), options_(options) {}

Result<TrackStep> AttitudeBank::step(const ObservedCurve &epoch, double seconds) {
  look_for_opening(seconds);
  for (TrackMode &mode : modes_)
    mode = turned_on(mode, seconds, options_.rate_noise);
  TrackStep out;
  if (loss_ == TrackLoss::None)
    UMOV_TRY(learn(epoch, out));
  settle(out);
  look_for_loss(out);
  return out;
}

/// How far attitudes open by an epoch, by the rate's and the attitude's own errors, which are not
/// folded at half a turn as attitudes are.
void AttitudeBank::look_for_opening(double seconds) {
  const double open_rad = pi / std::sqrt(3.0); // points of it lie beyond half a turn
  double open = 0;
  for (const TrackMode &mode : modes_) {
    const Belief belief = inverse::belief_of(mode);
    const auto variances = belief.covariance.diagonal();
    const double most = std::sqrt(variances.head<3>().maxCoeff()) +
                        std::sqrt(variances.segment<3>(inverse::rate_at).maxCoeff()) * seconds +
                        options_.rate_noise * std::sqrt(seconds * seconds * seconds / 3);
    open += most > open_rad ? std::exp(mode.log_weight) : 0;
  }
  if (loss_ == TrackLoss::None && open > counting_share)
    loss_ = TrackLoss::Open;
}

namespace {

/// A narrow filter of a wide one.
struct Place {
  std::size_t mode = 0, of = 0; ///< of the bank, and among those that it is spread over
  double log_prior = 0, log_posterior = 0;
};

/// The likeliest of places that hold all but a thousandth of what the rough likelihood leaves them.
void keep_likely(std::vector<Place> &places) {
  constexpr double left_out = 1e-3;
  std::ranges::stable_sort(places, std::greater<>(), &Place::log_posterior);
  double sum = 0;
  for (const Place &place : places)
    sum += std::exp(place.log_posterior - places.front().log_posterior);
  double held = 0;
  std::size_t kept = 0;
  while (kept < places.size() && held < (1 - left_out) * sum)
    held += std::exp(places[kept++].log_posterior - places.front().log_posterior);
  places.resize(kept);
}

/// -2 ln of how likely an epoch is in a light whose scale is as open as a filter's was at first.
double minus_2_log_of(const Comparison &seen, double scale) {
  const double off = std::log(std::max(seen.scale, 1e-30) / scale) / gain_open;
  return seen.minus_2_log + off * off;
}

} // namespace

/// Filters that have become too wide to look over their light are narrow ones on a grid from here
/// on. Which of them are kept a likelihood decides that forgives a quarter of I, as in a search;
/// their weights are those that they had before, so that the epoch counts once.
Result<void> AttitudeBank::spread_wide(const CurveModel &model, TrackStep &out) {
  std::vector<inverse::SpreadBelief> spreads;
  std::vector<Place> places;
  std::vector<Turning> asked;
  for (std::size_t m = 0; m < modes_.size(); ++m) {
    spreads.emplace_back(inverse::belief_of(modes_[m]));
    for (std::size_t k = 0; k < spreads[m].size(); ++k) {
      places.push_back({m, k, modes_[m].log_weight + std::log(spreads[m].weight(k)), 0});
      asked.push_back({spreads[m].attitude(k), {}});
    }
  }
  if (places.size() == modes_.size())
    return {};
  const CurveLikelihood rough(model.curve(), inverse::tempered(options_.errors, model.curve()));
  const bool is_lit =
      model.for_each(asked, {}, options_.threads, [&](std::size_t k, const ModelLight &light) {
        places[k].log_posterior =
            places[k].log_prior -
            minus_2_log_of(rough.compare(light), modes_[places[k].mode].scale) / 2;
      });
  if (!is_lit)
    return tl::unexpected(inverse::stopped());
  out.poses_lit += asked.size();
  out.spread = places.size();
  memory_.was_spread = true;
  keep_likely(places);
  std::vector<TrackMode> all;
  std::vector<bool> is_named(modes_.size(), false);
  for (const Place &place : places) {
    TrackMode one = modes_[place.mode];
    inverse::put(spreads[place.mode].belief(place.of), one);
    one.log_weight = place.log_prior;
    one.number = is_named[place.mode] ? memory_.next_number++ : one.number;
    is_named[place.mode] = true;
    all.push_back(std::move(one));
  }
  modes_ = std::move(all);
  return {};
}

/// All filters side by side, so that the light of all their points comes in one batch.
Result<void> AttitudeBank::learn(const ObservedCurve &epoch, TrackStep &out) {
  const CurveLikelihood likelihood(epoch, options_.errors);
  out.measurements = likelihood.measurements();
  if (out.measurements == 0)
    return {};
  std::vector<std::size_t> column(bands_.size());
  for (std::size_t b = 0; b < column.size(); ++b)
    column[b] = b;
  const CurveModel model(epoch, light_, column, parts_);
  for (const TrackMode &mode : modes_)
    memory_.next_number = std::max(memory_.next_number, mode.number + 1);
  UMOV_TRY(spread_wide(model, out));
  std::vector<Learning> all;
  for (TrackMode &mode : modes_) {
    Belief belief = inverse::belief_of(mode);
    if (options_.errors.has_clouds)
      forget_gain(belief, mode.scale);
    all.push_back({std::move(mode), std::make_unique<FilterUpdate>(std::move(belief), likelihood)});
  }
  const std::size_t most = std::max(all.size(), together);
  constexpr double straight = 25; // squares of errors that a line may miss over a filter
  for (;;) {
    std::vector<Turning> asked;
    std::vector<std::size_t> of;
    for (std::size_t k = 0; k < all.size(); ++k)
      if (!all[k].update->is_done()) {
        of.push_back(k);
        for (std::size_t which = 0; which < FilterUpdate::asked; ++which)
          asked.push_back(all[k].update->attitude(which));
      }
    if (of.empty())
      break;
    const bool is_lit =
        model.for_each(asked, {}, options_.threads, [&](std::size_t k, const ModelLight &light) {
          all[of[k / FilterUpdate::asked]].update->take(k % FilterUpdate::asked, light);
        });
    if (!is_lit)
      return tl::unexpected(inverse::stopped());
    out.poses_lit += asked.size();
    for (const std::size_t k : of) {
      const FilterUpdate::Bend bend =
          all[k].is_whole ? FilterUpdate::Bend{} : all[k].update->bend();
      const bool is_bent = bend.square > straight, is_full = all.size() + 2 > most;
      memory_.is_wide = memory_.is_wide ||
                        (is_bent && is_full && all[k].mode.log_weight > std::log(counting_share));
      if (!is_bent || is_full) {
        all[k].is_whole = true;
        all[k].update->step();
        continue;
      }
      const Belief whole = all[k].update->before();
      const TrackMode mode = all[k].mode;
      const auto parts = inverse::split(whole, bend.column);
      for (std::size_t p = 0; p < parts.size(); ++p) {
        Learning part{mode, std::make_unique<FilterUpdate>(parts[p].second, likelihood)};
        part.mode.log_weight += std::log(parts[p].first);
        const bool is_middle = 2 * p + 1 == parts.size();
        part.mode.number = is_middle ? mode.number : memory_.next_number++;
        if (is_middle)
          all[k] = std::move(part);
        else
          all.push_back(std::move(part));
      }
    }
  }
  const auto best = std::ranges::max_element(all, {}, [](const Learning &one) {
    return one.mode.log_weight + one.update->log_evidence();
  });
  out.i = best->update->light().i;
  out.q = best->update->light().q;
  out.u = best->update->light().u;
  modes_.clear();
  for (Learning &one : all) {
    inverse::put(one.update->after(), one.mode);
    one.mode.log_weight += one.update->log_evidence();
    one.mode.chi2 += one.update->chi2();
    one.mode.measurements += out.measurements;
    out.chi2.push_back(one.update->chi2());
    modes_.push_back(std::move(one.mode));
  }
  return {};
}

void AttitudeBank::sort_by_weight(TrackStep &out) {
  std::vector<std::size_t> order(modes_.size());
  for (std::size_t k = 0; k < order.size(); ++k)
    order[k] = k;
  std::ranges::stable_sort(order, std::greater<>(),
                           [&](std::size_t k) { return modes_[k].log_weight; });
  std::vector<TrackMode> modes;
  std::vector<double> chi2;
  for (const std::size_t k : order) {
    modes.push_back(std::move(modes_[k]));
    chi2.push_back(out.chi2[k]);
  }
  modes_ = std::move(modes);
  out.chi2 = std::move(chi2);
}

/// Heaviest first, without the hopeless, what became one as one, weights that add up to one.
void AttitudeBank::settle(TrackStep &out) {
  out.chi2.resize(modes_.size(), std::nan(""));
  sort_by_weight(out);
  drop_light(out);
  join_near(out);
  sort_by_weight(out); // two that became one may outweigh those before them
  double all = -std::numeric_limits<double>::infinity();
  for (const TrackMode &mode : modes_)
    all = std::isfinite(all) ? log_sum(all, mode.log_weight) : mode.log_weight;
  for (TrackMode &mode : modes_)
    mode.log_weight -= all;
}

/// Of more filters than can be split those go too that together hold next to nothing.
void AttitudeBank::drop_light(TrackStep &out) {
  constexpr double least = -20, next_to_nothing = 1e-4;
  std::size_t kept = 0;
  while (kept < modes_.size() && modes_[kept].log_weight >= modes_[0].log_weight + least)
    ++kept;
  double sum = 0;
  for (std::size_t k = 0; k < kept; ++k)
    sum += std::exp(modes_[k].log_weight - modes_[0].log_weight);
  double left = next_to_nothing * sum;
  while (kept > together &&
         (left -= std::exp(modes_[kept - 1].log_weight - modes_[0].log_weight)) > 0)
    --kept;
  for (std::size_t k = kept; k < modes_.size(); ++k)
    out.dropped.push_back(modes_[k].number);
  modes_.resize(kept);
  out.chi2.resize(kept);
}

void AttitudeBank::join_near(TrackStep &out) {
  std::vector<Neighbour> all;
  for (const TrackMode &mode : modes_)
    all.push_back(neighbour_of(mode));
  for (std::size_t a = 0; a < modes_.size(); ++a)
    for (std::size_t b = a + 1; b < modes_.size();) {
      const VectorXd apart = between(all[a], all[b]);
      if (!is_one(all[a], all[b], apart)) {
        ++b;
        continue;
      }
      // Mean and covariance of both together.
      const double both = log_sum(modes_[a].log_weight, modes_[b].log_weight),
                   part = std::exp(modes_[b].log_weight - both);
      Belief joined = all[a].belief;
      joined.mean += part * apart;
      joined.covariance = (1 - part) * joined.covariance + part * all[b].belief.covariance +
                          part * (1 - part) * apart * apart.transpose();
      out.joined.emplace_back(modes_[b].number, modes_[a].number);
      inverse::put(joined, modes_[a]);
      modes_[a].log_weight = both;
      all[a] = neighbour_of(modes_[a]);
      const auto at = static_cast<std::ptrdiff_t>(b);
      modes_.erase(modes_.begin() + at);
      all.erase(all.begin() + at);
      out.chi2.erase(out.chi2.begin() + at);
    }
}

void AttitudeBank::look_for_loss(const TrackStep &now) {
  constexpr double unlikely = 1e-3;
  constexpr std::size_t several = 3;
  if (now.measurements > 0) {
    const auto count = static_cast<double>(now.measurements);
    const bool is_missed =
        chi2_probability(now.chi2.front(), count) < unlikely && now.chi2.front() > 2 * count;
    memory_.misses = is_missed ? memory_.misses + 1 : 0;
    if (memory_.misses >= several)
      loss_ = TrackLoss::Misfit;
  }
}

} // namespace umov
