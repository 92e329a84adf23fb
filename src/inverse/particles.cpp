// Particles that are followed from all attitudes to the posterior.

#include "inverse/attitude_set.h"
#include "inverse/posterior.h"
#include "inverse/sample_weights.h"

#include <algorithm>
#include <cmath>
#include <umov/core/parallel.h>
#include <umov/core/random.h>
#include <umov/inverse/attitude_grid.h>

namespace umov::inverse {
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
      s.scale = compared[j].scale;
    }
  }
  return true;
}

constexpr std::uint32_t steps_of_a_level = 6;

/// Metropolis steps of all particles under a power of the likelihood. False if it was stopped.
bool move(const CurveModel &model, const CurveLikelihood &likelihood, const SearchOptions &options,
          double power, std::uint32_t stream, std::vector<PoseSample> &draws) {
  auto apart = neighbour_distances(draws, 4, options.threads);
  const auto middle = apart.begin() + static_cast<std::ptrdiff_t>(apart.size() / 2);
  std::nth_element(apart.begin(), middle, apart.end());
  for (std::uint32_t step = 0; step < steps_of_a_level; ++step) {
    const Round round{options.seed, stream + step, *middle};
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

/// A rotation of a run's own, alike to all others (Shoemake 1992, Graphics Gems III, 124).
Quaternion any_rotation(std::uint64_t seed, std::uint32_t stream) {
  const auto u = uniform4(seed, stream, 0);
  const double a = std::sqrt(1 - u[0]), b = std::sqrt(u[0]);
  return {a * std::sin(2 * pi * u[1]), a * std::cos(2 * pi * u[1]), b * std::sin(2 * pi * u[2]),
          b * std::cos(2 * pi * u[2])};
}

/// One run from all attitudes to the posterior.
Samples one_run(const CurveModel &model, const CurveLikelihood &likelihood,
                const SearchOptions &options, std::uint32_t run) {
  constexpr std::size_t first = 20'000;
  const std::uint32_t of_run = run << 24u;
  const Quaternion by = any_rotation(options.seed, 0x726f7400u + of_run);
  std::vector<Turning> begin;
  for (const Quaternion &q : attitude_grid(std::min(first, options.grid)))
    begin.push_back({run == 0 ? q : product(by, q), {}});
  const auto compared = compare_all(model, likelihood, begin, {}, options.threads);
  if (compared.empty())
    return {};
  Samples out;
  for (std::size_t k = 0; k < begin.size(); ++k)
    out.draws.push_back({begin[k], 1 / static_cast<double>(begin.size()), compared[k].minus_2_log,
                         compared[k].chi2, compared[k].scale});
  double power = 0;
  for (std::uint32_t level = 0; power < 1; ++level) {
    const double next = next_power(out.draws, power, static_cast<double>(options.samples) / 2);
    const double offset = uniform4(options.seed, 0x72657300u + of_run, level)[0];
    out.draws = resampled(out.draws, power, next, options.samples, offset, out.log_evidence);
    power = next;
    if (!move(model, likelihood, options, power, 0x736d6300u + of_run + level * steps_of_a_level,
              out.draws))
      return {};
    if (options.progress)
      options.progress("posterior", static_cast<std::size_t>(power * 1000), 1000);
  }
  return out;
}

/// The same particles for another light of the same body, by its likelihood over that of the light
/// that they were followed by. False if it was stopped.
bool reweigh(const CurveModel &model, const CurveLikelihood &likelihood, unsigned threads,
             Samples &samples) {
  std::vector<Turning> turnings;
  for (const PoseSample &s : samples.draws)
    turnings.push_back(s.turning);
  const auto compared = compare_all(model, likelihood, turnings, {}, threads);
  if (compared.empty())
    return false;
  std::vector<double> log_weights;
  for (std::size_t k = 0; k < compared.size(); ++k) {
    PoseSample &s = samples.draws[k];
    log_weights.push_back(std::log(s.weight) + (s.minus_2_log - compared[k].minus_2_log) / 2);
    s.minus_2_log = compared[k].minus_2_log;
    s.chi2 = compared[k].chi2;
    s.scale = compared[k].scale;
  }
  samples.log_evidence += normalize(samples.draws, log_weights);
  return true;
}

/// Runs as one sample: each counts by its evidence, whose mean is the evidence.
Samples pooled(const std::vector<Samples> &runs) {
  Samples out;
  std::vector<double> log_weights;
  for (std::size_t r = 0; r < runs.size(); ++r)
    for (const PoseSample &s : runs[r].draws) {
      out.draws.push_back(s);
      out.runs.push_back(r);
      log_weights.push_back(runs[r].log_evidence + std::log(s.weight));
    }
  out.log_evidence = normalize(out.draws, log_weights) - std::log(static_cast<double>(runs.size()));
  return out;
}

} // namespace

Samples sample_all(const CurveModel &quick, const CurveModel &last,
                   const CurveLikelihood &likelihood, const SearchOptions &options) {
  // Short curves leave the most open, and are lit the quickest.
  constexpr std::size_t least = 2, most_runs = 4, short_epochs = 20;
  const std::size_t epochs = std::max<std::size_t>(quick.curve().epochs.size(), 1);
  const std::size_t most =
      options.needs_set ? std::clamp(most_runs * short_epochs / epochs, least, most_runs) : 1;
  constexpr double little = 2; // of the growth of a set that its runs agree on
  std::vector<Samples> runs;
  Samples out;
  for (std::uint32_t run = 0; run < most; ++run) {
    Samples one = one_run(quick, likelihood, options, run);
    if (one.draws.empty() || (&quick != &last && !reweigh(last, likelihood, options.threads, one)))
      return {};
    runs.push_back(std::move(one));
    out = pooled(runs);
    if (run > 0 && highest_density(out.draws, {}, out.runs).growth < little)
      break;
  }
  out.effective = different(out.draws);
  return out;
}

void add_lost(const Samples &peaks, Samples &particles) {
  const AttitudeSet set = highest_density(particles.draws, {}, particles.runs);
  std::vector<double> log_weights;
  for (const PoseSample &s : particles.draws)
    log_weights.push_back(particles.log_evidence + std::log(s.weight));
  std::size_t next = 1 + *std::ranges::max_element(particles.runs);
  for (const PoseSample &s : peaks.draws)
    if (s.weight > 0 && s.minus_2_log <= set.level && !is_in(set.balls, s.turning.attitude)) {
      particles.draws.push_back(s);
      particles.runs.push_back(next++);
      log_weights.push_back(peaks.log_evidence + std::log(s.weight));
    }
  particles.log_evidence = normalize(particles.draws, log_weights);
  particles.effective = different(particles.draws);
}

} // namespace umov::inverse
