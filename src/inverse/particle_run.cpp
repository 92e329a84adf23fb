#include "inverse/particle_run.h"

#include "inverse/attitude_set.h"
#include "inverse/sample_weights.h"

#include <algorithm>
#include <cmath>
#include <umov/core/parallel.h>
#include <umov/core/random.h>
#include <umov/inverse/attitude_grid.h>
#include <umov/light/poses.h>

namespace umov::inverse {
namespace {

/// Coins of a round have a stream of their own.
constexpr std::uint32_t coins = 0x20000u;

/// Values of -2 ln of particles. What is no number has no weight.
template <class Value>
std::vector<double> values_of(const std::vector<Particle> &draws, Value value) {
  constexpr double hopeless = 1e200;
  std::vector<double> out;
  out.reserve(draws.size());
  for (const Particle &p : draws) {
    const double one = value(p);
    out.push_back(one < hopeless ? one : hopeless);
  }
  return out;
}

/// How much more of what has these values of -2 ln leaves `wanted` of the particles effective.
double more_of(const std::vector<double> &values, double most, double wanted) {
  std::vector<double> log_weights;
  log_weights.reserve(values.size());
  for (const double v : values)
    log_weights.push_back(-v / 2);
  const double more = power_worth(log_weights, most, wanted);
  return more < most ? std::max(more, 1e-9) : most;
}

/// Systematic resampling by the weights that `more` of what has these values of -2 ln gives; adds
/// to the evidence.
std::vector<Particle> resampled(const std::vector<Particle> &draws,
                                const std::vector<double> &values, double more, std::size_t count,
                                double offset, double &log_evidence) {
  std::vector<double> weight(draws.size());
  double sum = 0;
  const double least = *std::ranges::min_element(values);
  for (std::size_t k = 0; k < draws.size(); ++k)
    sum += weight[k] = std::exp(-more * (values[k] - least) / 2);
  log_evidence += std::log(sum / static_cast<double>(draws.size())) - more * least / 2;
  std::vector<Particle> out;
  out.reserve(count);
  double reached = 0;
  std::size_t k = 0;
  for (std::size_t j = 0; j < count; ++j) {
    const double target = (static_cast<double>(j) + offset) / static_cast<double>(count) * sum;
    while (k + 1 < draws.size() && reached + weight[k] < target)
      reached += weight[k++];
    out.push_back(draws[k]);
  }
  return out;
}

/// Every n-th of some particles, `count` of them.
std::vector<Particle> thinned(std::vector<Particle> draws, std::size_t count) {
  if (draws.size() <= count)
    return draws;
  std::vector<Particle> out;
  out.reserve(count);
  for (std::size_t k = 0; k < count; ++k)
    out.push_back(draws[k * draws.size() / count]);
  return out;
}

/// How far particles are from their fourth neighbours, in the middle [rad].
double distance_of(const std::vector<Particle> &draws, std::size_t asked, unsigned threads) {
  std::vector<PoseSample> some;
  for (const Particle &p : thinned(draws, asked))
    some.push_back({p.turning});
  auto apart = neighbour_distances(some, 4, threads);
  const auto middle = apart.begin() + static_cast<std::ptrdiff_t>(apart.size() / 2);
  std::nth_element(apart.begin(), middle, apart.end());
  return *middle;
}

std::vector<Turning> turnings_of(const std::vector<Particle> &draws) {
  std::vector<Turning> out;
  out.reserve(draws.size());
  for (const Particle &p : draws)
    out.push_back(p.turning);
  return out;
}

} // namespace

Samples ParticleRun::samples() {
  if (!begin() || !follow() || !take_last_light())
    return {};
  Samples out;
  std::vector<double> log_weights;
  for (std::size_t k = 0; k < draws_.size(); ++k) {
    const Comparison &at = has_last_light() ? draws_[k].last : draws_[k].quick;
    out.draws.push_back({draws_[k].turning, 0, at.minus_2_log, at.chi2, at.scale});
    log_weights.push_back(has_last_light() ? -left_[k] / 2 : 0);
  }
  out.log_evidence = log_evidence_ + normalize(out.draws, log_weights) -
                     std::log(static_cast<double>(draws_.size()));
  return out;
}

bool ParticleRun::begin() {
  const Quaternion by = random_rotation(options_.seed, 0x726f7400u + of_run_, 0);
  std::vector<Turning> turnings;
  for (const Quaternion &q : attitude_grid(crowd_.first))
    turnings.push_back({of_run_ == 0 ? q : product(by, q), {}});
  of_modes_ =
      static_cast<double>(around_.count()) / static_cast<double>(turnings.size() + around_.count());
  for (const Turning &one : around_.drawn(options_.seed, 0x6d6f6400u + of_run_))
    turnings.push_back(one);
  return light({1, 1, 0}, turnings, draws_);
}

bool ParticleRun::follow() {
  for (double power = 0; power < 1;) {
    const auto values =
        values_of(draws_, [](const Particle &p) { return p.quick.minus_2_log - p.start; });
    // An island of the posterior begins with the part of all attitudes that it takes, and gains
    // on the others from power to power: at first there are many particles, then few. Evidence
    // alone needs no such care.
    const std::size_t first = options_.needs_set ? 8 : 1;
    const std::size_t times = std::max<std::size_t>(first >> level_, 1);
    const double more = more_of(values, 1 - power, crowd_.wanted * static_cast<double>(times));
    power = power + more < 1 ? power + more : 1;
    if (!go_on(values, more, crowd_.followed * times, {1 - power, power, 0}))
      return false;
    if (options_.progress)
      options_.progress("posterior", static_cast<std::size_t>(power * 1000), 1000);
  }
  draws_ = thinned(std::move(draws_), 2 * options_.samples);
  return true;
}

bool ParticleRun::take_last_light() {
  if (!has_last_light())
    return true;
  std::vector<Particle> lit;
  if (!light({0, 0, 1}, turnings_of(draws_), lit))
    return false;
  for (std::size_t k = 0; k < lit.size(); ++k)
    draws_[k].last = std::move(lit[k].last);
  const double wanted = static_cast<double>(options_.samples) / 2;
  for (double part = 0;;) {
    left_ = values_of(draws_,
                      [](const Particle &p) { return p.last.minus_2_log - p.quick.minus_2_log; });
    const double more = more_of(left_, 1 - part, wanted);
    if (more >= 1 - part) {
      for (double &value : left_)
        value *= 1 - part;
      return true;
    }
    part += more;
    if (!go_on(left_, more, draws_.size(), {0, 1 - part, part}))
      return false;
  }
}

bool ParticleRun::go_on(const std::vector<double> &values, double more, std::size_t count,
                        const Density &density) {
  const double offset = uniform4(options_.seed, 0x72657300u + of_run_, level_)[0];
  draws_ = resampled(draws_, values, more, count, offset, log_evidence_);
  const bool is_whole = move(density);
  ++level_;
  return is_whole;
}

bool ParticleRun::move(const Density &density) {
  constexpr std::uint32_t least_steps = 6, most_steps = 12;
  const double apart = distance_of(draws_, options_.samples, options_.threads);
  has_moved_.assign(draws_.size(), 0);
  constexpr double nearly_all = 0.9;
  const auto all = nearly_all * static_cast<double>(draws_.size());
  for (std::uint32_t step = 0; step < most_steps; ++step) {
    if (step >= least_steps && static_cast<double>(std::ranges::count(has_moved_, 1)) > all)
      break;
    if (!take_step(density, {options_.seed, 0x736d6300u + of_run_ + stream_++, apart}, step))
      return false;
  }
  return true;
}

bool ParticleRun::take_step(const Density &density, const Round &round, std::uint32_t step) {
  constexpr std::uint32_t kinds = 6; // one in any way, one along others, the rest local
  if (step % kinds == 0)
    return try_steps(density, round, 0, 1, any_way);
  if (step % kinds == 3)
    return try_steps(density, round, 0, 2, along_others) &&
           try_steps(density, round, 1, 2, along_others);
  return try_local(density, round);
}

bool ParticleRun::try_local(const Density &density, const Round &round) {
  constexpr double narrow = 0.03;      // of the particles' own distances
  constexpr std::size_t enough = 1000; // tell a shape
  accepted_ = 0;
  for (const std::size_t half : {0u, 1u}) {
    const std::size_t still = draws_.size() / 2;
    const std::size_t stride = 2 * std::max<std::size_t>(still / enough, 1);
    Chords around;
    for (std::size_t k = 1 - half; k < draws_.size(); k += stride)
      around.add(draws_[k].turning.attitude);
    const LocalSteps steps(std::move(around), narrow * round.scale);
    if (!try_steps(density, round, half, 2,
                   [&](const std::vector<Particle> &draws, std::size_t k, const Round &of) {
                     return local_step(steps, width_, draws[k].turning, k, of);
                   }))
      return false;
  }
  // Few are taken where they are too long; many where they are shorter than they could be.
  const double share = static_cast<double>(accepted_) / static_cast<double>(draws_.size());
  constexpr double few = 0.15, many = 0.4, least = 0.01, most = 2;
  width_ = std::clamp(width_ * (share < few ? 0.5 : share > many ? 1.4 : 1), least, most);
  return true;
}

template <class Propose>
bool ParticleRun::try_steps(const Density &density, const Round &round, std::size_t first,
                            std::size_t stride, Propose propose) {
  const std::size_t count = (draws_.size() + stride - 1 - first) / stride;
  std::vector<Tried> proposals(count);
  parallel_for(count, options_.threads,
               [&](std::size_t j) { proposals[j] = propose(draws_, first + j * stride, round); });
  std::vector<Turning> turnings;
  for (const Tried &one : proposals)
    turnings.push_back(one.to);
  // Where the light of the last steps has a part, what quick light refuses is not asked for it.
  // Half of its power at most: where light has come that quick light does not know, particles come
  // too.
  constexpr double most = 0.5;
  const Density asked = density.last > 0 ? Density{density.start, most, 0} : density;
  std::vector<Particle> tried;
  if (!light(asked, turnings, tried))
    return false;
  std::vector<std::size_t> taken; // of those that were tried
  for (std::size_t j = 0; j < tried.size(); ++j) {
    const std::size_t k = first + j * stride;
    const double coin = uniform4(round.seed, round.stream + coins, k)[1];
    if (std::log(coin) < asked.log_ratio(tried[j], draws_[k]) + proposals[j].back)
      taken.push_back(j);
  }
  accepted_ += taken.size();
  if (density.last > 0 && !keep_by_last_light(density, asked, round, first, stride, tried, taken))
    return false;
  for (const std::size_t j : taken) {
    const std::size_t k = first + j * stride;
    draws_[k] = std::move(tried[j]);
    has_moved_[k] = 1;
  }
  return true;
}

bool ParticleRun::keep_by_last_light(const Density &density, const Density &asked,
                                     const Round &round, std::size_t first, std::size_t stride,
                                     std::vector<Particle> &tried,
                                     std::vector<std::size_t> &taken) const {
  std::vector<Turning> turnings;
  for (const std::size_t j : taken)
    turnings.push_back(tried[j].turning);
  std::vector<Particle> lit;
  if (!light({0, 0, 1}, turnings, lit))
    return false;
  std::vector<std::size_t> kept;
  for (std::size_t t = 0; t < taken.size(); ++t) {
    const std::size_t j = taken[t], k = first + j * stride;
    tried[j].last = std::move(lit[t].last);
    const double coin = uniform4(round.seed, round.stream + coins, k)[2];
    const double more =
        density.log_ratio(tried[j], draws_[k]) - asked.log_ratio(tried[j], draws_[k]);
    if (std::log(coin) < more)
      kept.push_back(j);
  }
  taken = std::move(kept);
  return true;
}

bool ParticleRun::light(const Density &density, std::span<const Turning> turnings,
                        std::vector<Particle> &out) const {
  out.assign(turnings.size(), {});
  for (std::size_t k = 0; k < out.size(); ++k)
    out[k].turning = turnings[k];
  if (turnings.empty())
    return true;
  if (density.start > 0)
    parallel_for(out.size(), options_.threads, [&](std::size_t k) {
      out[k].start = -2 * std::log(1 - of_modes_ + of_modes_ * around_.density(turnings[k]));
    });
  const auto ask = [&](const CurveModel &model, Comparison Particle::*where) {
    auto compared = compare_all(model, likelihood_, turnings, {}, options_.threads);
    for (std::size_t k = 0; k < compared.size(); ++k)
      out[k].*where = std::move(compared[k]);
    return !compared.empty();
  };
  return (density.quick <= 0 || ask(quick_, &Particle::quick)) &&
         (density.last <= 0 || ask(last_, &Particle::last));
}

} // namespace umov::inverse
