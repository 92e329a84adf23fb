#include <umov/inverse/design.h>

#include "algebra/dense.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <umov/core/quantity.h>
#include <umov/core/random.h>

namespace umov {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double sure = 0.95;

Index signed_of(std::size_t k) { return static_cast<Index>(k); }

/// Points of a standard normal vector and their weights, which add up to 1.
struct NormalPoints {
  std::vector<VectorXd> at;
  std::vector<double> weight;
};

NormalPoints on_a_line() {
  constexpr int steps = 1600;
  constexpr double far = 8; // beyond it 1e-15 of the probability
  NormalPoints out;
  double sum = 0;
  for (int k = 0; k <= steps; ++k) {
    const double x = far * (2. * k / steps - 1);
    out.at.emplace_back(VectorXd::Constant(1, x));
    out.weight.push_back(std::exp(-x * x / 2));
    sum += out.weight.back();
  }
  for (double &w : out.weight)
    w /= sum;
  return out;
}

/// Draws in pairs of opposite sign: what is odd in them has no error.
NormalPoints draws(std::size_t dimensions, std::uint64_t seed) {
  constexpr std::size_t pairs = 2048;
  constexpr std::uint32_t stream = 0x706c616e; // of its own
  NormalPoints out;
  for (std::size_t k = 0; k < pairs; ++k) {
    VectorXd x(signed_of(dimensions));
    for (std::size_t d = 0; d < dimensions; ++d) {
      const auto u = uniform4(seed, stream, k * dimensions + d);
      x[signed_of(d)] = std::sqrt(-2 * std::log(u[0])) * std::cos(2 * pi * u[1]);
    }
    out.at.push_back(x);
    out.at.emplace_back(-x);
  }
  out.weight.assign(out.at.size(), 1. / static_cast<double>(out.at.size()));
  return out;
}

/// R with R R^T = the covariance, whose diagonal is kept. Where errors depend on which alternative
/// is true, pairs need not fit together: the nearest correlations that do are taken (Rebonato &
/// Jackel 1999: negative eigenvalues to 0, rows to length 1).
MatrixXd root_of(const MatrixXd &covariance) {
  const VectorXd sd = covariance.diagonal().cwiseMax(0).cwiseSqrt();
  MatrixXd correlation = MatrixXd::Identity(sd.size(), sd.size());
  for (Index a = 0; a < sd.size(); ++a)
    for (Index b = 0; b < sd.size(); ++b)
      if (a != b && sd[a] > 0 && sd[b] > 0)
        correlation(a, b) = std::clamp(covariance(a, b) / (sd[a] * sd[b]), -1.0, 1.0);
  auto parts = algebra::symmetric_eigen(correlation);
  for (Index c = 0; c < sd.size(); ++c)
    parts.vectors.col(c) *= std::sqrt(std::max(parts.values[c], 0.0));
  for (Index r = 0; r < sd.size(); ++r)
    parts.vectors.row(r) *= sd[r] / std::max(parts.vectors.row(r).norm(), 1e-300);
  return parts.vectors;
}

/// Law of ln(p_k / p_truth) over the data of one truth, k running over the others.
struct RatioLaw {
  std::vector<std::size_t> other;
  VectorXd mean;
  MatrixXd root;
};

RatioLaw law_of(std::span<const double> log_bayes, std::size_t n, std::size_t truth) {
  const auto d = [&](std::size_t a, std::size_t b) { return std::max(log_bayes[a * n + b], 0.0); };
  RatioLaw out;
  for (std::size_t k = 0; k < n; ++k)
    if (k != truth)
      out.other.push_back(k);
  const Index m = signed_of(n - 1);
  out.mean.resize(m);
  MatrixXd covariance(m, m);
  for (Index a = 0; a < m; ++a) {
    const std::size_t k = out.other[static_cast<std::size_t>(a)];
    out.mean[a] = -d(truth, k);
    for (Index b = 0; b < m; ++b) {
      // |x - y|^2 of three points in the metric of the errors: the law of cosines.
      const std::size_t l = out.other[static_cast<std::size_t>(b)];
      const double apart = k == l ? 0 : (d(k, l) + d(l, k)) / 2;
      covariance(a, b) = d(truth, k) + d(truth, l) - apart;
    }
  }
  out.root = root_of(covariance);
  return out;
}

} // namespace

ObservedCurve expected_curve(const ObservedCurve &layout, const Alternative &truth) {
  ObservedCurve out = layout;
  for (ObservedSample &s : out.samples) {
    const std::size_t at = s.epoch * layout.bands.size() + s.band;
    const double i = truth.light.i[at], sd = truth.errors.q_sd[at];
    s.i = std::isnan(truth.errors.i_sd[at]) ? std::nan("") : i;
    s.i_sd = std::isnan(truth.errors.i_sd[at]) ? 0 : truth.errors.i_sd[at];
    const bool has_q = i > 0 && !std::isnan(sd);
    s.q = has_q ? truth.light.q[at] / i : std::nan("");
    s.u = has_q ? truth.light.u[at] / i : std::nan("");
    s.cov_qq = s.cov_uu = has_q ? sd * sd : 0;
    s.cov_qu = 0;
  }
  return out;
}

std::vector<double> expected_log_bayes(const ObservedCurve &layout, const CurveErrors &errors,
                                       std::span<const Alternative> alternatives) {
  const std::size_t n = alternatives.size();
  std::vector<double> out(n * n, 0);
  for (std::size_t truth = 0; truth < n; ++truth) {
    const CurveLikelihood likelihood(expected_curve(layout, alternatives[truth]), errors);
    const auto value = [&](std::size_t k) {
      const EndMember &light = alternatives[k].light;
      return likelihood.compare({light.i, light.q, light.u}).minus_2_log;
    };
    const double own = value(truth);
    for (std::size_t k = 0; k < n; ++k)
      if (k != truth)
        out[truth * n + k] = (value(k) - own) / 2;
  }
  return out;
}

Discrimination discrimination(std::span<const double> log_bayes, std::span<const double> prior,
                              std::uint64_t seed) {
  const std::size_t n = prior.size();
  const double sum = std::accumulate(prior.begin(), prior.end(), 0.0);
  Discrimination out;
  if (n < 2 || !(sum > 0))
    return out;
  out.hardest_log_bayes = log_bayes[1];
  out.hardest_b = 1;
  const NormalPoints points = n == 2 ? on_a_line() : draws(n - 1, seed);
  for (std::size_t truth = 0; truth < n; ++truth) {
    const RatioLaw law = law_of(log_bayes, n, truth);
    const double own = prior[truth] / sum;
    for (const std::size_t k : law.other)
      if (log_bayes[truth * n + k] < out.hardest_log_bayes) {
        out.hardest_log_bayes = log_bayes[truth * n + k];
        out.hardest_a = truth;
        out.hardest_b = k;
      }
    if (!(own > 0))
      continue;
    for (std::size_t p = 0; p < points.at.size(); ++p) {
      const VectorXd ratio = law.mean + algebra::times(law.root, points.at[p]);
      double others = 0, largest = 0;
      for (std::size_t a = 0; a < law.other.size(); ++a) {
        const double x = prior[law.other[a]] / sum * std::exp(ratio[signed_of(a)]);
        others += x;
        largest = std::max(largest, x);
      }
      const double weight = own * points.weight[p];
      out.information_bits -= weight * std::log2(own + others);
      out.right += own > largest ? weight : own == largest ? weight / 2 : 0;
      out.decided += own > sure * (own + others) ? weight : 0;
    }
  }
  out.information_bits = std::max(out.information_bits, 0.0);
  return out;
}

} // namespace umov
