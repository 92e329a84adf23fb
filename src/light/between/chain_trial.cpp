#include "light/between/chain_trial.h"

#include "light/between/chain_matrices.h"
#include "light/reference/elements.h"

#include <algorithm>
#include <cmath>
#include <umov/core/stop.h>

namespace umov {
namespace {

constexpr std::size_t trial_rays = 32'768;
/// Kinds of surface, and pairs of them, that fewer chains are on than this are not told by them.
constexpr std::size_t least_met = 64;

/// Of a part phi of the light whose chains are R times as rare for it as those of the rest, none is
/// met by one pose in twenty where three are expected. The rest are then 3 R (1 - phi)/phi chains.
/// That goes unnoticed if they are more than the 48 that a pose wants, R > 16 phi/(1 - phi), and
/// their half-width, 2.13 in parts of the root of their number, is less than what lacks,
/// R > 1.5 (1 - phi)/phi.
constexpr double worst_odds = 0.306186; // at which the two are the same
double allowed_rareness(double odds) { return std::max(1.5 / odds, 16 * odds); }

/// A pose has up to so many times as much of the light of some chains as all poses have.
constexpr double more_at_a_pose = 4;

/// The most that is allowed over all the shares that a pose may have of what is `part` in the mean.
double allowed_at_poses(double part) {
  const auto odds = [](double share) { return share < 1 ? share / (1 - share) : INFINITY; };
  const double most = odds(std::min(1.0, more_at_a_pose * part)),
               least = odds(std::max(0.0, 1 - more_at_a_pose * (1 - part)));
  return allowed_rareness(std::clamp(worst_odds, least, std::max(least, most)));
}

/// Light that no half-width tells, beside .5 % for what visibility misses.
constexpr double negligible = 0.005 / more_at_a_pose;

} // namespace

ChainTrial::ChainTrial(const ChainRays &rays, const ChainCover &cover, std::size_t first,
                       const std::atomic<bool> *cancel)
    : rays_(rays), cover_(cover), number_(rays.number_of_first(0, first)),
      list_(rays.draw(0, first, trial_rays, cancel)), met_(cover.slots().size()) {
  const std::size_t kinds = met_.size();
  std::vector<std::size_t> of_pair(kinds * kinds);
  for (std::size_t k = 0; k < list_.chains.size(); ++k) {
    leave_if_stopped(cancel, k);
    const Chain &c = list_.chains[k];
    kept_.push_back(rays_.matters(list_, k, number_ + k));
    ++met_[c.q.kind];
    for (std::uint32_t at = c.first; at < c.first + c.count; ++at)
      ++met_[cover_.kind_of(list_.between[at].slot)];
    const auto [low, high] = std::minmax(c.p.kind, c.q.kind);
    ++of_pair[pair_.emplace_back(low * kinds + high)];
  }
  leave_if_stopped(cancel);
  for (std::size_t &pair : pair_) // few ones together
    pair = of_pair[pair] < least_met ? 0 : pair + 1;
  pairs_ = kinds * kinds + 1;
}

std::vector<double> ChainTrial::light_of(const Scene &scene, const ChainSurfaces &surfaces,
                                         std::size_t chain, ChainMatrices &of) const {
  const Chain &c = list_.chains[chain];
  const std::uint64_t number = 2 * (number_ + chain);
  const std::uint32_t p = surfaces.kind_of(&surface_of_slot(scene, c.p.slot)),
                      q = surfaces.kind_of(&surface_of_slot(scene, c.q.slot));
  std::vector<double> out(scene.grid.nodes().size());
  if (surfaces.part(p, q) == ChainPart::Nothing)
    return out;
  const double ends = (c.from_p + c.from_q) *
                      rays_.freedom(c.p, {Sampler(surfaces.surface(p))}, number) *
                      rays_.freedom(c.q, {Sampler(surfaces.surface(q))}, number + 1);
  const double cosine_p = cosine_of(c.p), cosine_q = cosine_of(c.q);
  of.start(vector_of(c.p.axis), vector_of(c.p.along));
  for (std::uint32_t k = c.first; k < c.first + c.count; ++k)
    of.pass(list_.between[k]);
  for (std::size_t b = 0; b < out.size(); ++b)
    out[b] = ends * surfaces.strength(p, cosine_p, b) * surfaces.strength(q, cosine_q, b) *
             of.transmitted(b);
  return out;
}

bool ChainTrial::is_even(std::vector<Portion> all) {
  std::erase_if(all, [](const Portion &one) { return !(one.light > 0); });
  std::ranges::stable_sort(all, [](const Portion &a, const Portion &b) {
    return a.light * b.kept > b.light * a.kept; // the rarest for their light first
  });
  // Of those from a place on: their light, and (sum light)^2 over how many chains they count as.
  std::vector<double> rest(all.size() + 1), squares(all.size() + 1);
  for (std::size_t k = all.size(); k-- > 0;) {
    rest[k] = rest[k + 1] + all[k].light;
    squares[k] = squares[k + 1] + all[k].light * all[k].light / std::max(all[k].kept, 1e-300);
  }
  Portion above;
  for (std::size_t k = 0; k + 1 < all.size(); ++k) {
    above.light += all[k].light;
    above.kept += all[k].kept;
    const double part = above.light / rest[0],
                 rareness = (above.light / above.kept) / (squares[k + 1] / rest[k + 1]);
    if (part > negligible && part < 1 - negligible && !(rareness <= allowed_at_poses(part)))
      return false;
  }
  return true;
}

/// What few chains are on must be within bounds at each surface, so that it is all along a chain.
bool ChainTrial::serves_rare_ones(const Scene &scene) const {
  const double most =
      std::pow(allowed_rareness(worst_odds), 1 / static_cast<double>(rays_.bounces()));
  for (std::size_t kind = 0; kind < met_.size(); ++kind) {
    if (met_[kind] < least_met && !cover_.is_within(scene, cover_.slots()[kind], most))
      return false;
  }
  return true;
}

bool ChainTrial::serves(const Scene &scene, const ChainSurfaces &surfaces,
                        const std::atomic<bool> *cancel) const {
  if (!cover_.has_kinds_of(scene, surfaces) || !serves_rare_ones(scene))
    return false;
  const std::size_t bands = scene.grid.nodes().size();
  std::vector<std::vector<double>> light(bands);
  ChainMatrices matrices(scene, scene.mesh);
  for (std::size_t k = 0; k < list_.chains.size(); ++k) {
    leave_if_stopped(cancel, k);
    const std::vector<double> one = light_of(scene, surfaces, k, matrices);
    for (std::size_t b = 0; b < bands; ++b)
      light[b].push_back(one[b]);
  }
  return std::ranges::all_of(
      light, [&](const std::vector<double> &of_band) { return is_even_in(of_band); });
}

bool ChainTrial::is_even_in(const std::vector<double> &light) const {
  std::vector<Portion> together;
  std::vector<std::vector<Portion>> of_pair(pairs_);
  for (std::size_t k = 0; k < light.size(); ++k) {
    together.push_back({light[k], kept_[k]});
    of_pair[pair_[k]].push_back({light[k], kept_[k]});
  }
  return is_even(std::move(together)) &&
         std::ranges::all_of(of_pair,
                             [](std::vector<Portion> &one) { return is_even(std::move(one)); });
}

} // namespace umov
