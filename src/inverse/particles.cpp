// Particles that are followed from all attitudes to the posterior.

#include "inverse/attitude_set.h"
#include "inverse/chords.h"
#include "inverse/local_steps.h"
#include "inverse/posterior.h"
#include "inverse/sample_weights.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <umov/core/parallel.h>
#include <umov/core/random.h>
#include <umov/inverse/attitude_grid.h>

namespace umov::inverse {
namespace {

/// One attitude that is followed.
struct Particle {
  Turning turning;
  Comparison quick, last; ///< of the light for the way, and of that of the last steps
  double start = 0;       ///< -2 ln of the density that particles begin with
};

/// A density on the way from where particles begin to the posterior: powers of the density there,
/// of the likelihood by quick light, and of that by the light of the last steps.
struct Density {
  double start = 0, quick = 0, last = 0; ///< the powers
  [[nodiscard]] double minus_2_log(const Particle &p) const {
    // Light that was not asked for has no part.
    return start * p.start + (quick > 0 ? quick * p.quick.minus_2_log : 0) +
           (last > 0 ? last * p.last.minus_2_log : 0);
  }
};

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
  for (std::size_t k = 0; k < count; ++k)
    out.push_back(draws[k * draws.size() / count]);
  return out;
}

/// What one round of steps is drawn with.
struct Round {
  std::uint64_t seed = 0;
  std::uint32_t stream = 0;
  double scale = 0; ///< of the particles' own distances [rad]
};

/// A step to be tried.
struct Tried {
  Turning to;
  double back = 0; ///< ln of how much more often the step back is tried from there
};

/// A step in any direction, of a length over two decades about the particles' own distances: sheets
/// and peaks are followed by it, and a line as far as it is thick.
Tried any_way(const std::vector<Particle> &draws, std::size_t k, const Round &round) {
  const auto z = normal_vector(round.seed, round.stream, k, 3);
  const double u = uniform4(round.seed, round.stream + 0x10000u, k)[0];
  return {stepped(draws[k].turning, z * (round.scale * std::pow(10, 1.7 * u - 1.2)), 1)};
}

/// A step by a part of what turns one particle into another (differential evolution: ter Braak
/// 2006). A glint holds two directions to minutes of arc and leaves the turn about the flat's
/// normal free: all such attitudes are a ring, two of which differ by a turn about that normal, and
/// the same turn keeps every other on it. The two are of those that stand still meanwhile, every
/// other particle, so that the steps are exact.
Tried along_others(const std::vector<Particle> &draws, std::size_t k, const Round &round) {
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
  return {stepped(draws[k].turning,
                  Eigen::Vector3d(turn.x, turn.y, turn.z) * u[3] + z * (beside * round.scale), 1)};
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

/// How many a run follows.
struct Crowd {
  std::size_t first = 0;    ///< attitudes that it begins with
  std::size_t followed = 0; ///< particles
  double wanted = 0;        ///< of them, that are effective after a step
};

/// The fewer epochs, the quicker particles are lit, and the more places are alike.
Crowd crowd_of(const ObservedCurve &curve, const SearchOptions &options, bool is_large) {
  constexpr std::size_t first = 20'000, lit = 480'000, lit_large = 1'000'000;
  constexpr std::size_t wide = 80, short_epochs = 20, most = 10;
  constexpr std::size_t most_of = 20; // times a grid that was told to be small
  const std::size_t epochs = std::max<std::size_t>(curve.epochs.size(), 1);
  Crowd out;
  if (is_large) {
    out.first = std::min(std::max(first, lit_large / epochs), most_of * options.grid);
    out.followed = options.samples * std::clamp<std::size_t>(wide / epochs, 2, most);
  } else {
    out.first = std::min(std::max(first, lit / epochs), most_of * options.grid);
    out.followed = options.samples * (epochs <= short_epochs ? 2 : 1);
  }
  constexpr double tenth = 0.1;
  out.wanted =
      std::max(static_cast<double>(options.samples) / 2, tenth * static_cast<double>(out.followed));
  return out;
}

constexpr std::uint32_t least_steps = 6, most_steps = 12; // of a level

/// One run from all attitudes to the posterior.
class Run {
public:
  Run(const CurveModel &quick, const CurveModel &last, const CurveLikelihood &likelihood,
      const std::vector<PoseMode> &modes, const SearchOptions &options, std::uint32_t number,
      Crowd crowd)
      : quick_(quick), last_(last), likelihood_(likelihood), around_(modes, crowd.followed),
        options_(options), of_run_(number << 24u), crowd_(crowd) {}

  /// Empty if it was stopped.
  Samples samples() {
    if (!begin() || !follow() || !take_last_light())
      return {};
    Samples out;
    std::vector<double> log_weights;
    for (std::size_t k = 0; k < draws_.size(); ++k) {
      const Comparison &at = has_last_light() ? draws_[k].last : draws_[k].quick;
      out.draws.push_back({draws_[k].turning, 0, at.minus_2_log, at.chi2, at.scale});
      log_weights.push_back(left_.empty() ? 0 : -left_[k] / 2);
    }
    out.log_evidence = log_evidence_ + normalize(out.draws, log_weights) -
                       std::log(static_cast<double>(draws_.size()));
    return out;
  }

private:
  [[nodiscard]] bool has_last_light() const { return &quick_ != &last_; }

  /// A grid turned by a rotation of the run's own, and draws around what is known.
  bool begin() {
    const Quaternion by = any_rotation(options_.seed, 0x726f7400u + of_run_);
    std::vector<Turning> turnings;
    for (const Quaternion &q : attitude_grid(crowd_.first))
      turnings.push_back({of_run_ == 0 ? q : product(by, q), {}});
    of_modes_ = static_cast<double>(around_.count()) /
                static_cast<double>(turnings.size() + around_.count());
    for (const Turning &one : around_.drawn(options_.seed, 0x6d6f6400u + of_run_))
      turnings.push_back(one);
    return light({1, 1, 0}, turnings, draws_);
  }

  /// Particles with the light that a density asks for; false if it was stopped.
  bool light(const Density &density, std::span<const Turning> turnings,
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

  /// Tries a step for each of every `stride`-th particle; false if it was stopped.
  template <class Propose>
  bool try_steps(const Density &density, const Round &round, std::size_t first, std::size_t stride,
                 Propose propose) {
    const std::size_t count = (draws_.size() + stride - 1 - first) / stride;
    std::vector<Tried> proposals(count);
    parallel_for(count, options_.threads,
                 [&](std::size_t j) { proposals[j] = propose(draws_, first + j * stride, round); });
    std::vector<Turning> turnings;
    for (const Tried &one : proposals)
      turnings.push_back(one.to);
    std::vector<Particle> tried;
    if (!light(density, turnings, tried))
      return false;
    for (std::size_t j = 0; j < tried.size(); ++j) {
      const std::size_t k = first + j * stride;
      const double coin = uniform4(round.seed, round.stream + 0x20000u, k)[1];
      if (!(std::log(coin) < (density.minus_2_log(draws_[k]) - density.minus_2_log(tried[j])) / 2 +
                                 proposals[j].back))
        continue;
      draws_[k] = std::move(tried[j]);
      has_moved_[k] = 1;
      ++accepted_;
    }
    return true;
  }

  /// Steps of the shape of what lies around, among those particles that stand still meanwhile.
  bool try_local(const Density &density, const Round &round) {
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
                       return local_step(steps, draws[k].turning, k, of);
                     }))
        return false;
    }
    // Too many of them in vain: they are too long; nearly none: they lead nowhere.
    const double share = static_cast<double>(accepted_) / static_cast<double>(draws_.size());
    constexpr double few = 0.15, many = 0.4, least = 0.01, most = 2;
    width_ = std::clamp(width_ * (share < few ? 0.5 : share > many ? 1.4 : 1), least, most);
    return true;
  }

  [[nodiscard]] Tried local_step(const LocalSteps &steps, const Turning &from, std::size_t k,
                                 const Round &of) const {
    const auto z = normal_vector(of.seed, of.stream, k, 3);
    const double u = uniform4(of.seed, of.stream + 0x10000u, k)[0];
    const double times = width_ * std::pow(10, 1.4 * u - 1); // spikes are on sheets
    const auto root = steps.root_at(from.attitude, times);
    const Vec3<Body> step = LocalSteps::step(root, {z[0], z[1], z[2]});
    Tried out{{turned(from.attitude, step), from.rate_rad_s}};
    out.back = LocalSteps::log_density(steps.root_at(out.to.attitude, times), step) -
               LocalSteps::log_density(root, step);
    return out;
  }

  /// Metropolis steps of all particles, until nearly all have moved. False if it was stopped.
  bool move(const Density &density) {
    std::vector<PoseSample> some; // that tell how far they are apart
    for (const Particle &p : thinned(draws_, options_.samples))
      some.push_back({p.turning});
    auto apart = neighbour_distances(some, 4, options_.threads);
    const auto middle = apart.begin() + static_cast<std::ptrdiff_t>(apart.size() / 2);
    std::nth_element(apart.begin(), middle, apart.end());
    has_moved_.assign(draws_.size(), 0);
    constexpr double nearly_all = 0.9;
    const auto all = nearly_all * static_cast<double>(draws_.size());
    for (std::uint32_t step = 0; step < most_steps; ++step) {
      if (step >= least_steps && static_cast<double>(std::ranges::count(has_moved_, 1)) > all)
        break;
      if (!take_step(density, {options_.seed, 0x736d6300u + of_run_ + stream_++, *middle}, step))
        return false;
    }
    return true;
  }
  bool take_step(const Density &density, const Round &round, std::uint32_t step) {
    constexpr std::uint32_t kinds = 6; // one in any way, one along others, the rest local
    if (step % kinds == 0)
      return try_steps(density, round, 0, 1, any_way);
    if (step % kinds == 3)
      return try_steps(density, round, 0, 2, along_others) &&
             try_steps(density, round, 1, 2, along_others);
    return try_local(density, round);
  }

  /// Resamples by `more` of what has these values, and moves under the density that this leads to.
  bool go_on(const std::vector<double> &values, double more, std::size_t count,
             const Density &density) {
    const double offset = uniform4(options_.seed, 0x72657300u + of_run_, level_)[0];
    draws_ = resampled(draws_, values, more, count, offset, log_evidence_);
    const bool is_whole = move(density);
    ++level_;
    return is_whole;
  }

  /// Through powers of the likelihood, to 1.
  bool follow() {
    for (double power = 0; power < 1;) {
      std::vector<double> values;
      for (const Particle &p : draws_)
        values.push_back(p.quick.minus_2_log - p.start);
      // An island of the posterior begins with the part of all attitudes that it takes, and gains
      // on the others from power to power: at first there are many particles, then few.
      const std::size_t first = options_.needs_set ? 8 : 1; // evidence alone needs no such care
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

  /// To the light of the last steps, in which a mask's sliver of light is gone or has come: where
  /// few of the particles would hold all of the weight, through powers too. What is left are
  /// weights that half of them, or more, share.
  bool take_last_light() {
    if (!has_last_light())
      return true;
    std::vector<Turning> turnings;
    for (const Particle &p : draws_)
      turnings.push_back(p.turning);
    std::vector<Particle> lit;
    if (!light({0, 0, 1}, turnings, lit))
      return false;
    for (std::size_t k = 0; k < lit.size(); ++k)
      draws_[k].last = std::move(lit[k].last);
    const double wanted = static_cast<double>(options_.samples) / 2;
    for (double part = 0;;) {
      left_.clear();
      for (const Particle &p : draws_)
        left_.push_back(p.last.minus_2_log - p.quick.minus_2_log);
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

  const CurveModel &quick_;
  const CurveModel &last_;
  const CurveLikelihood &likelihood_;
  const AroundModes around_;
  double of_modes_ = 0; ///< part of them, of those that a run begins with
  const SearchOptions &options_;
  std::uint32_t of_run_, level_ = 0, stream_ = 0;
  double width_ = 1;            ///< of local steps, beside what lies around
  std::vector<char> has_moved_; ///< of each, in this level
  std::size_t accepted_ = 0;
  Crowd crowd_;
  std::vector<Particle> draws_;
  std::vector<double> left_; ///< -2 ln of the weights of the draws; empty: they weigh the same
  double log_evidence_ = 0;
};

/// Runs as one sample: each counts by its evidence and by how many it followed, and the mean of the
/// evidences is the evidence.
Samples pooled(const std::vector<Samples> &runs, const std::vector<double> &followed) {
  Samples out;
  std::vector<double> log_weights;
  for (std::size_t r = 0; r < runs.size(); ++r)
    for (const PoseSample &s : runs[r].draws) {
      out.draws.push_back(s);
      out.runs.push_back(r);
      log_weights.push_back(runs[r].log_evidence + std::log(followed[r] * s.weight));
    }
  out.log_evidence = normalize(out.draws, log_weights) -
                     std::log(std::accumulate(followed.begin(), followed.end(), 0.0));
  return out;
}

/// Their evidences are within a factor of 1.6.
bool are_alike(const std::vector<Samples> &runs) {
  constexpr double alike = 0.5;
  const auto [least, most] = std::ranges::minmax(runs, {}, &Samples::log_evidence);
  return most.log_evidence - least.log_evidence < alike;
}

} // namespace

Samples sample_all(const CurveModel &quick, const CurveModel &last,
                   const CurveLikelihood &likelihood, const std::vector<PoseMode> &modes,
                   const SearchOptions &options) {
  // Short curves leave the most open, and are lit the quickest.
  constexpr std::size_t least = 2, most_runs = 4, short_epochs = 20;
  const std::size_t epochs = std::max<std::size_t>(quick.curve().epochs.size(), 1);
  const std::size_t most =
      options.needs_set ? std::clamp(most_runs * short_epochs / epochs, least, most_runs) : 1;
  constexpr double little = 2; // of the growth of a set that its runs agree on
  std::vector<Samples> runs;
  std::vector<double> followed;
  Samples out;
  for (std::uint32_t run = 0; run < most; ++run) {
    const Crowd crowd = crowd_of(quick.curve(), options, run >= least && !are_alike(runs));
    runs.push_back(Run(quick, last, likelihood, modes, options, run, crowd).samples());
    if (runs.back().draws.empty())
      return {};
    followed.push_back(static_cast<double>(crowd.followed));
    out = pooled(runs, followed);
    if (run > 0 && are_alike(runs) && highest_density(out.draws, {}, out.runs).growth < little)
      break;
  }
  out.effective = different(out.draws);
  return out;
}

} // namespace umov::inverse
