#include "inverse/posterior.h"

#include "algebra/dense.h"
#include "inverse/sample_weights.h"
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

constexpr double tail = 5; // degrees of freedom of the proposals

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
  constexpr double most = 0.02, of_all = 0.8; // a mode that seems light is looked at too
  const double least = std::min(most, of_all / static_cast<double>(modes.size()));
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

/// A draw of Student's t about a mode.
Turning draw_from(const Proposal &p, double span_s, std::uint64_t seed, std::uint32_t stream,
                  std::uint64_t index) {
  const Eigen::Index n = p.root.rows();
  const auto z = normal_vector(seed, stream, index, n + static_cast<Eigen::Index>(tail));
  const double chi = z.tail(static_cast<Eigen::Index>(tail)).squaredNorm();
  return stepped(p.centre, p.root * z.head(n) * std::sqrt(tail / chi), span_s);
}

/// Draws of the first round, whose use is to tell covariances: fewer, where modes are few.
std::size_t first_draws(const std::vector<Proposal> &mixture, std::size_t samples) {
  constexpr std::size_t per_unknown = 40; // of each mode
  const auto unknowns = static_cast<std::size_t>(mixture.front().root.rows());
  return std::min(samples, std::max(samples * 2 / 5, per_unknown * unknowns * mixture.size()));
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
    const auto draws =
        static_cast<double>(round == 0 ? first_draws(mixture, options.samples) : options.samples);
    std::vector<Turning> drawn;
    for (std::size_t m = 0, k = 0; m < mixture.size(); ++m) {
      const auto count = static_cast<std::size_t>(std::ceil(mixture[m].weight * draws));
      for (std::size_t j = 0; j < count; ++j, ++k)
        drawn.push_back(draw_from(mixture[m], span, options.seed,
                                  0x706f7300u + static_cast<std::uint32_t>(round), k));
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
      out.draws[k].scale = compared[k].scale;
      log_weight[k] = -compared[k].minus_2_log / 2 - log_density(mixture, drawn[k], span);
    });
    out.log_evidence = normalize(out.draws, log_weight) -
                       std::log(static_cast<double>(drawn.size())) - std::log(8 * pi * pi);
    out.effective = effective_size(out.draws);
    update(modes, mixture, out.draws, log_weight, span);
  }
  return out;
}

struct AroundModes::Tails {
  std::vector<Proposal> mixture;
  std::vector<std::size_t> counts;
};

namespace {
constexpr double no_span = 1; // [s]: of attitudes that stay as they are
} // namespace

AroundModes::AroundModes(const std::vector<PoseMode> &modes, std::size_t count) {
  auto tails = std::make_unique<Tails>();
  if (!modes.empty())
    tails->mixture = mixture_of(modes, no_span);
  for (const Proposal &p : tails->mixture) {
    tails->counts.push_back(
        static_cast<std::size_t>(std::ceil(p.weight * static_cast<double>(count))));
    count_ += tails->counts.back();
  }
  for (std::size_t m = 0; m < tails->mixture.size(); ++m) // as many as are drawn
    tails->mixture[m].weight = static_cast<double>(tails->counts[m]) / static_cast<double>(count_);
  tails_ = std::move(tails);
}

AroundModes::~AroundModes() = default;

std::vector<Turning> AroundModes::drawn(std::uint64_t seed, std::uint32_t stream) const {
  std::vector<Turning> out;
  for (std::size_t m = 0; m < tails_->mixture.size(); ++m)
    for (std::size_t j = 0; j < tails_->counts[m]; ++j)
      out.push_back(draw_from(tails_->mixture[m], no_span, seed, stream, out.size()));
  return out;
}

double AroundModes::density(const Turning &at) const {
  constexpr double all = 8 * pi * pi; // attitudes, in the measure of rotation vectors
  return tails_->mixture.empty() ? 0 : all * std::exp(log_density(tails_->mixture, at, no_span));
}

} // namespace umov::inverse
