#include "inverse/posterior.h"

#include "algebra/dense.h"
#include "inverse/some_epochs.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <umov/core/parallel.h>
#include <umov/core/random.h>
#include <umov/inverse/attitude_grid.h>

namespace umov::inverse {
namespace {

constexpr double tail = 5;           // degrees of freedom of the proposals
constexpr double no_weight = -1e300; // ln of it: of what is no number

/// A mode as a density to draw from, in the units of Step.
struct Proposal {
  Turning centre;
  Eigen::MatrixXd root, inverse_root;
  double log_norm = 0, weight = 0;
};

Proposal proposal_of(const PoseMode &mode, double span_s) {
  Proposal out;
  out.centre = mode.turning;
  constexpr double wider = 1.3; // tails that are too short cost more than ones too long
  const Eigen::MatrixXd covariance = in_steps(mode.covariance, mode.turning, span_s) * wider;
  out.root = algebra::cholesky_root(covariance);
  out.inverse_root = algebra::inverse_of(out.root);
  const auto n = static_cast<double>(covariance.rows());
  out.log_norm = std::lgamma((tail + n) / 2) - std::lgamma(tail / 2) - n / 2 * std::log(tail * pi) -
                 out.root.diagonal().array().log().sum();
  return out;
}

/// ln density of a mixture in the measure in which all attitudes are alike, and all rates, in
/// radians per span.
double log_density(const std::vector<Proposal> &mixture, const Turning &at, double span_s) {
  double sum = 0;
  for (const Proposal &p : mixture) {
    const Step step = step_between(p.centre, at, p.root.rows(), span_s);
    const double x2 = (p.inverse_root * step).squaredNorm();
    const auto n = static_cast<double>(step.size());
    sum += p.weight * std::exp(p.log_norm - (tail + n) / 2 * std::log1p(x2 / tail) -
                               log_volume(p.centre, step, span_s));
  }
  return std::log(sum + 1e-300);
}

/// Weights from logarithms, and what they add up to. What has none (NaN) weighs nothing.
double normalize(std::vector<PoseSample> &draws, std::vector<double> log_weight) {
  for (double &one : log_weight)
    one = one > no_weight ? one : no_weight;
  const double highest = *std::ranges::max_element(log_weight);
  double sum = 0;
  for (std::size_t k = 0; k < draws.size(); ++k)
    sum += draws[k].weight = std::exp(log_weight[k] - highest);
  for (PoseSample &s : draws)
    s.weight /= sum;
  return highest + std::log(sum);
}

double effective_size(const std::vector<PoseSample> &draws) {
  double squares = 0;
  for (const PoseSample &s : draws)
    squares += s.weight * s.weight;
  return squares > 0 ? 1 / squares : 0;
}

/// Which mode a sample belongs to: the nearest, in units of its own spread.
std::size_t nearest(const std::vector<Proposal> &mixture, const Turning &at, double span_s) {
  std::size_t best = 0;
  double least = 1e300;
  for (std::size_t m = 0; m < mixture.size(); ++m) {
    const Proposal &p = mixture[m];
    const double x2 =
        (p.inverse_root * step_between(p.centre, at, p.root.rows(), span_s)).squaredNorm();
    if (x2 < least) {
      least = x2;
      best = m;
    }
  }
  return best;
}

/// Weights, from their logarithms, to a power; of the highest 1.
std::vector<double> to_power(const std::vector<double> &log_weights, double power) {
  const double highest = *std::ranges::max_element(log_weights);
  std::vector<double> out;
  out.reserve(log_weights.size());
  for (const double w : log_weights)
    out.push_back(w > no_weight ? std::exp(power * (w - highest)) : 0);
  return out;
}

/// How many samples weights are worth.
double worth(const std::vector<double> &weights) {
  double sum = 0, squares = 0;
  for (const double w : weights) {
    sum += w;
    squares += w * w;
  }
  return sum * sum / squares;
}

/// The largest power, `most` at most, that leaves weights worth `wanted` samples; 0 if none does.
double power_worth(const std::vector<double> &log_weights, double most, double wanted) {
  if (worth(to_power(log_weights, most)) >= wanted)
    return most;
  double low = 0, high = most;
  constexpr int halvings = 40;
  for (int k = 0; k < halvings; ++k) {
    const double middle = (low + high) / 2;
    (worth(to_power(log_weights, middle)) >= wanted ? low : high) = middle;
  }
  return low;
}

/// Weights to the power that leaves them worth `wanted` samples; none where no power does. Where a
/// proposal misses the shape of a peak a few draws hold all of the weight, and say nothing of a
/// covariance; what lies between proposal and peak leads from one to the other.
std::vector<double> evened(const std::vector<double> &log_weights, double wanted) {
  if (log_weights.empty() || !(*std::ranges::max_element(log_weights) > no_weight))
    return {};
  auto out = to_power(log_weights, power_worth(log_weights, 1, wanted));
  return worth(out) >= wanted ? out : std::vector<double>();
}

/// Weights and covariances of modes from their samples.
void update(std::vector<PoseMode> &modes, const std::vector<Proposal> &mixture,
            const std::vector<PoseSample> &draws, const std::vector<double> &log_weights,
            double span_s) {
  const Eigen::Index n = mixture.front().root.rows();
  const double wanted = 10 * static_cast<double>(n); // that tell a covariance
  std::vector<std::vector<double>> own(modes.size());
  std::vector<std::vector<Step>> steps(modes.size());
  for (PoseMode &mode : modes)
    mode.weight = 0;
  for (std::size_t k = 0; k < draws.size(); ++k) {
    const std::size_t m = nearest(mixture, draws[k].turning, span_s);
    modes[m].weight += draws[k].weight;
    own[m].push_back(log_weights[k]);
    steps[m].push_back(step_between(mixture[m].centre, draws[k].turning, n, span_s));
  }
  for (std::size_t m = 0; m < modes.size(); ++m) {
    const std::vector<double> even = evened(own[m], wanted);
    if (even.empty())
      continue;
    Eigen::MatrixXd second = Eigen::MatrixXd::Zero(n, n);
    for (std::size_t k = 0; k < even.size(); ++k)
      second += even[k] * steps[m][k] * steps[m][k].transpose();
    second /= std::accumulate(even.begin(), even.end(), 0.0);
    modes[m].covariance = out_of_steps(second, mixture[m].centre, span_s);
  }
}

std::vector<Proposal> mixture_of(const std::vector<PoseMode> &modes, double span_s) {
  std::vector<Proposal> out;
  double sum = 0;
  constexpr double least = 0.02; // a mode that seems light is looked at too
  for (const PoseMode &mode : modes) {
    out.push_back(proposal_of(mode, span_s));
    sum += out.back().weight = std::max(mode.weight, least);
  }
  for (Proposal &p : out)
    p.weight /= sum;
  return out;
}

} // namespace

Eigen::VectorXd normal_vector(std::uint64_t seed, std::uint32_t stream, std::uint64_t index,
                              Eigen::Index size) {
  Eigen::VectorXd out(size);
  constexpr Eigen::Index per = 4;
  constexpr std::uint64_t blocks = 8; // of four numbers, kept free for one index
  for (Eigen::Index k = 0; k < size; k += per) {
    const auto u = uniform4(seed, stream, index * blocks + static_cast<std::uint64_t>(k / per));
    for (Eigen::Index j = 0; j < per && k + j < size; ++j) { // Box & Muller 1958
      const auto pair = static_cast<std::size_t>(j / 2 * 2);
      const double r = std::sqrt(-2 * std::log(u[pair])), a = 2 * pi * u[pair + 1];
      out[k + j] = j % 2 == 0 ? r * std::cos(a) : r * std::sin(a);
    }
  }
  return out;
}

namespace {

/// The likelihood of draws around modes. Of a long curve a twelfth of the epochs is looked at
/// first: a draw that these rule out by e^20 and more beside the best of them has no weight
/// whatever the others say, and what they say of it stands for all. Where a valley is narrow and
/// bent that is nearly all draws. Not of counts, whose variances are the model's. Empty if it was
/// stopped.
std::vector<Comparison> compare_draws(const CurveModel &model, const CurveLikelihood &likelihood,
                                      std::span<const Turning> drawn, unsigned threads) {
  constexpr std::size_t share = 12, few = 8;
  constexpr double nothing = 40; // twice the e-folds
  const std::size_t count = model.curve().epochs.size();
  if (!model.curve().counts.empty() || count < share * few)
    return compare_all(model, likelihood, drawn, {}, threads);
  const auto epochs = some_epochs(count, count / share);
  const CurveLikelihood some(model.curve(), likelihood.errors(), epochs);
  auto out = compare_all(model, some, drawn, epochs, threads);
  double least = std::numeric_limits<double>::infinity();
  for (const Comparison &one : out)
    least = std::min(least, one.minus_2_log);
  std::vector<Turning> likely;
  std::vector<std::size_t> places;
  for (std::size_t k = 0; k < out.size(); ++k)
    if (out[k].minus_2_log - least < nothing) {
      likely.push_back(drawn[k]);
      places.push_back(k);
    }
  if (likely.empty()) // none of them has a number there
    return out.empty() ? out : compare_all(model, likelihood, drawn, {}, threads);
  const auto exact = compare_all(model, likelihood, likely, {}, threads);
  if (exact.empty())
    return {};
  const Comparison &best = *std::ranges::min_element(exact, {}, &Comparison::minus_2_log);
  const double times = static_cast<double>(count) / static_cast<double>(epochs.size());
  for (Comparison &one : out) {
    const double worse = (one.minus_2_log - least) * times;
    one.minus_2_log = best.minus_2_log + worse;
    one.chi2 = best.chi2 + worse;
  }
  for (std::size_t j = 0; j < places.size(); ++j)
    out[places[j]] = exact[j];
  return out;
}

} // namespace

Samples sample_modes(const CurveModel &model, const CurveLikelihood &likelihood,
                     std::vector<PoseMode> &modes, const SearchOptions &options) {
  Samples out;
  const double span = span_of(model.curve());
  // Each round from the covariances of the one before (Cappe et al. 2004).
  constexpr int least = 2, most = 6;
  constexpr double enough = 100; // effective samples
  for (int round = 0; round < least || (round < most && out.effective < enough); ++round) {
    const auto mixture = mixture_of(modes, span);
    const Eigen::Index n = mixture.front().root.rows();
    std::vector<Turning> drawn;
    for (std::size_t m = 0, k = 0; m < mixture.size(); ++m) {
      const auto count = static_cast<std::size_t>(
          std::ceil(mixture[m].weight * static_cast<double>(options.samples)));
      for (std::size_t j = 0; j < count; ++j, ++k) {
        const auto z = normal_vector(options.seed, 0x706f7300u + static_cast<std::uint32_t>(round),
                                     k, n + static_cast<Eigen::Index>(tail));
        const double chi = z.tail(static_cast<Eigen::Index>(tail)).squaredNorm();
        drawn.push_back(
            stepped(mixture[m].centre, mixture[m].root * z.head(n) * std::sqrt(tail / chi), span));
      }
    }
    const auto compared = compare_draws(model, likelihood, drawn, options.threads);
    if (compared.empty())
      return {};
    std::vector<double> log_weight(drawn.size());
    out.draws.assign(drawn.size(), {});
    parallel_for(drawn.size(), options.threads, [&](std::size_t k) {
      out.draws[k].turning = drawn[k];
      out.draws[k].minus_2_log = compared[k].minus_2_log;
      out.draws[k].chi2 = compared[k].chi2;
      log_weight[k] = -compared[k].minus_2_log / 2 - log_density(mixture, drawn[k], span);
    });
    out.log_evidence = normalize(out.draws, log_weight) -
                       std::log(static_cast<double>(drawn.size())) - std::log(8 * pi * pi);
    out.effective = effective_size(out.draws);
    update(modes, mixture, out.draws, log_weight, span);
  }
  return out;
}

namespace {

/// The next power of the likelihood that leaves half of the sample effective.
double next_power(const std::vector<PoseSample> &draws, double power, double wanted) {
  std::vector<double> log_weights;
  log_weights.reserve(draws.size());
  for (const PoseSample &s : draws)
    log_weights.push_back(-s.minus_2_log / 2);
  const double more = power_worth(log_weights, 1 - power, wanted);
  return more < 1 - power ? power + std::max(more, 1e-9) : 1;
}

/// Systematic resampling by the weights that a higher power gives; adds to the evidence.
std::vector<PoseSample> resampled(const std::vector<PoseSample> &draws, double power, double next,
                                  std::size_t count, double offset, double &log_evidence) {
  std::vector<double> weight(draws.size());
  double least = 1e300, sum = 0;
  for (const PoseSample &s : draws)
    least = std::min(least, s.minus_2_log);
  for (std::size_t k = 0; k < draws.size(); ++k)
    sum += weight[k] = std::exp(-(next - power) * (draws[k].minus_2_log - least) / 2);
  log_evidence += std::log(sum / static_cast<double>(draws.size())) - (next - power) * least / 2;
  std::vector<PoseSample> out;
  double reached = 0;
  std::size_t k = 0;
  for (std::size_t j = 0; j < count; ++j) {
    const double target = (static_cast<double>(j) + offset) / static_cast<double>(count) * sum;
    while (k + 1 < draws.size() && reached + weight[k] < target)
      reached += weight[k++];
    out.push_back(draws[k]);
    out.back().weight = 1 / static_cast<double>(count);
  }
  return out;
}

/// Distance of every sample to its `rank`-th neighbour that is not the same attitude.
std::vector<double> neighbour_distances(const std::vector<PoseSample> &draws, std::size_t rank,
                                        unsigned threads) {
  std::vector<double> out(draws.size(), pi);
  parallel_for(draws.size(), threads, [&](std::size_t k) {
    std::vector<double> all;
    for (const PoseSample &other : draws)
      if (const double d = angle_between(draws[k].turning.attitude, other.turning.attitude);
          d > 1e-7)
        all.push_back(d);
    if (all.size() < rank)
      return;
    const auto at = all.begin() + static_cast<std::ptrdiff_t>(rank - 1);
    std::nth_element(all.begin(), at, all.end());
    out[k] = *at;
  });
  return out;
}

/// What one round of steps is drawn with.
struct Round {
  std::uint64_t seed = 0;
  std::uint32_t stream = 0;
  double scale = 0; ///< of the particles' own distances [rad]
};

/// A step in any direction, of a length over two decades about the particles' own distances: sheets
/// and peaks are followed by it, and a line as far as it is thick.
Turning any_way(const std::vector<PoseSample> &draws, std::size_t k, const Round &round) {
  const auto z = normal_vector(round.seed, round.stream, k, 3);
  const double u = uniform4(round.seed, round.stream + 0x10000u, k)[0];
  return stepped(draws[k].turning, z * (round.scale * std::pow(10, 1.7 * u - 1.2)), 1);
}

/// A step by a part of what turns one particle into another (differential evolution: ter Braak
/// 2006). A glint holds two directions to minutes of arc and leaves the turn about the flat's
/// normal free: all such attitudes are a ring, two of which differ by a turn about that normal, and
/// the same turn keeps every other on it. The two are of those that stand still meanwhile, every
/// other particle, so that the steps are exact.
Turning along_others(const std::vector<PoseSample> &draws, std::size_t k, const Round &round) {
  const auto u = uniform4(round.seed, round.stream + 0x10000u, k);
  const std::size_t other = 1 - k % 2, count = (draws.size() + 1 - other) / 2;
  const auto pick = [&](double at) {
    return 2 * std::min(static_cast<std::size_t>(at * static_cast<double>(count)), count - 1) +
           other;
  };
  const Vec3<Body> turn =
      turn_between(draws[pick(u[0])].turning.attitude, draws[pick(u[2])].turning.attitude);
  const auto z = normal_vector(round.seed, round.stream, k, 3);
  constexpr double beside = 0.03; // of the distances: to every side a little
  return stepped(draws[k].turning,
                 Eigen::Vector3d(turn.x, turn.y, turn.z) * u[3] + z * (beside * round.scale), 1);
}

/// Tries a step for each of every `stride`-th particle; false if it was stopped.
template <class Propose>
bool try_steps(const CurveModel &model, const CurveLikelihood &likelihood,
               const SearchOptions &options, double power, const Round &round, std::size_t first,
               std::size_t stride, Propose propose, std::vector<PoseSample> &draws) {
  std::vector<Turning> tried;
  for (std::size_t k = first; k < draws.size(); k += stride)
    tried.push_back(propose(draws, k, round));
  const auto compared = compare_all(model, likelihood, tried, {}, options.threads);
  if (compared.empty())
    return tried.empty();
  for (std::size_t j = 0; j < tried.size(); ++j) {
    PoseSample &s = draws[first + j * stride];
    const double coin = uniform4(round.seed, round.stream + 0x20000u, first + j * stride)[1];
    if (std::log(coin) < power * (s.minus_2_log - compared[j].minus_2_log) / 2) {
      s.turning = tried[j];
      s.minus_2_log = compared[j].minus_2_log;
    }
  }
  return true;
}

/// Metropolis steps of all particles under a power of the likelihood. False if it was stopped.
bool move(const CurveModel &model, const CurveLikelihood &likelihood, const SearchOptions &options,
          double power, std::uint32_t level, std::vector<PoseSample> &draws) {
  auto apart = neighbour_distances(draws, 4, options.threads);
  const auto middle = apart.begin() + static_cast<std::ptrdiff_t>(apart.size() / 2);
  std::nth_element(apart.begin(), middle, apart.end());
  constexpr std::uint32_t steps = 6;
  for (std::uint32_t step = 0; step < steps; ++step) {
    const Round round{options.seed, 0x736d6300u + level * steps + step, *middle};
    if (step % 2 == 0) {
      if (!try_steps(model, likelihood, options, power, round, 0, 1, any_way, draws))
        return false;
      continue;
    }
    for (const std::size_t half : {0u, 1u})
      if (!try_steps(model, likelihood, options, power, round, half, 2, along_others, draws))
        return false;
  }
  return true;
}

/// Effective size where copies that have not moved apart count as one: no more than that many are
/// independent.
double different(std::vector<PoseSample> draws) {
  std::ranges::stable_sort(draws, {}, [](const PoseSample &s) { return s.minus_2_log; });
  double squares = 0;
  for (std::size_t k = 0; k < draws.size();) {
    double weight = 0;
    const Quaternion q = draws[k].turning.attitude;
    const double value = draws[k].minus_2_log;
    for (; k < draws.size() && draws[k].minus_2_log == value &&
           angle_between(draws[k].turning.attitude, q) < 1e-7;
         ++k)
      weight += draws[k].weight;
    squares += weight * weight;
  }
  return squares > 0 ? 1 / squares : 0;
}

} // namespace

Samples sample_all(const CurveModel &model, const CurveLikelihood &likelihood,
                   const SearchOptions &options) {
  constexpr std::size_t first = 20'000;
  std::vector<Turning> begin;
  for (const Quaternion &q : attitude_grid(std::min(first, options.grid)))
    begin.push_back({q, {}});
  const auto compared = compare_all(model, likelihood, begin, {}, options.threads);
  if (compared.empty())
    return {};
  Samples out;
  for (std::size_t k = 0; k < begin.size(); ++k)
    out.draws.push_back({begin[k], 1 / static_cast<double>(begin.size()), compared[k].minus_2_log});
  double power = 0;
  for (std::uint32_t level = 0; power < 1; ++level) {
    const double next = next_power(out.draws, power, static_cast<double>(options.samples) / 2);
    const double offset = uniform4(options.seed, 0x72657300u, level)[0];
    out.draws = resampled(out.draws, power, next, options.samples, offset, out.log_evidence);
    power = next;
    if (!move(model, likelihood, options, power, level, out.draws))
      return {};
    if (options.progress)
      options.progress("posterior", static_cast<std::size_t>(power * 1000), 1000);
  }
  out.effective = different(out.draws);
  return out;
}

namespace {

/// How large a ball may be: one standard deviation of the mode that its sample belongs to.
double width_at(Quaternion attitude, std::span<const PoseMode> modes) {
  double least = 1e300, width = 0;
  for (const PoseMode &mode : modes)
    if (const double d = angle_between(mode.turning.attitude, attitude) / mode.sd_rad();
        d < least) {
      least = d;
      width = mode.sd_rad();
    }
  return width;
}

} // namespace

std::vector<AttitudeBall> highest_density(const std::vector<PoseSample> &samples,
                                          std::span<const PoseMode> modes) {
  std::vector<PoseSample> inside = samples;
  std::ranges::stable_sort(inside, {}, &PoseSample::minus_2_log);
  double sum = 0;
  std::size_t count = 0;
  while (count < inside.size() && sum < 0.95)
    sum += inside[count++].weight;
  inside.resize(count);
  const auto apart =
      neighbour_distances(inside, std::min<std::size_t>(4, std::max<std::size_t>(count, 2) - 1), 0);
  std::vector<double> sorted = apart;
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  std::vector<AttitudeBall> out;
  for (std::size_t k = 0; k < inside.size(); ++k) {
    const Quaternion q = inside[k].turning.attitude;
    const double largest = modes.empty() ? 3 * *middle : width_at(q, modes);
    if (out.empty() || angle_between(q, out.back().attitude) > 1e-7)
      out.push_back({q, std::min(apart[k], largest)});
  }
  return out;
}

double share_of(std::span<const AttitudeBall> set) {
  double out = 0;
  for (const AttitudeBall &ball : set) {
    // Each place counts once: a ball's volume over the number of balls that hold its centre.
    double holders = 0;
    for (const AttitudeBall &other : set)
      holders += angle_between(ball.attitude, other.attitude) <= other.radius_rad ? 1 : 0;
    out += share_within(ball.radius_rad) / std::max(holders, 1.0);
  }
  return std::min(out, 1.0);
}

} // namespace umov::inverse
