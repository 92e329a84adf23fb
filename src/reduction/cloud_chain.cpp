#include "reduction/cloud_chain.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace umov {
namespace {

using Matrix = algebra::MatrixXd;
using Vector = algebra::VectorXd;

/// Time from one moment to the next, in times of the cloud. Of moments closer than the least the
/// precision, 1/(2 x), would swallow that of the level, 1, which then nothing tells.
double apart_of(double seconds, const CloudPrior &prior) {
  constexpr double far = std::numeric_limits<double>::infinity(), least = 1e-10;
  return prior.time_s > 0 ? std::max(seconds / prior.time_s, least) : far;
}

} // namespace

CloudChain::CloudChain(std::span<const CountMoment> counts, const CloudPrior &prior) {
  if (!(prior.sd > 0))
    return;
  std::vector<std::size_t> order(counts.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&](std::size_t k) { return counts[k].time_s; });
  std::vector<double> apart;
  moment_.resize(counts.size());
  const CountMoment *last = nullptr, *begun = nullptr;
  for (const std::size_t k : order) {
    const CountMoment &one = counts[k];
    const bool is_new =
        begun == nullptr || (one.exposure != last->exposure && one.time_s - begun->time_s > 1e-9);
    if (is_new) {
      apart.push_back(begun == nullptr ? std::numeric_limits<double>::infinity()
                                       : apart_of(one.time_s - begun->time_s, prior));
      begun = &one;
    }
    last = &one;
    moment_[k] = static_cast<Eigen::Index>(apart.size()) - 1;
  }
  const auto n = static_cast<Eigen::Index>(apart.size());
  diagonal_ = before_ = Vector::Zero(n);
  for (Eigen::Index k = 0; k < n; ++k) {
    const double x = apart[static_cast<std::size_t>(k)], r = std::exp(-x);
    const double precision = -1 / (prior.sd * prior.sd * std::expm1(-2 * x));
    diagonal_(k) += precision;
    before_(k) = -r * precision;
    if (k > 0)
      diagonal_(k - 1) += r * r * precision;
  }
}

Vector CloudChain::pivots(const Vector &weights) const {
  Vector out = diagonal_ + weights;
  for (Eigen::Index k = 1; k < out.size(); ++k)
    out(k) -= before_(k) * before_(k) / out(k - 1);
  return out;
}

Matrix CloudChain::solve(const Vector &weights, Matrix m) const {
  const Vector pivot = pivots(weights);
  for (Eigen::Index k = 1; k < pivot.size(); ++k)
    m.row(k) -= before_(k) / pivot(k - 1) * m.row(k - 1);
  for (Eigen::Index k = pivot.size() - 1; k >= 0; --k) {
    if (k + 1 < pivot.size())
      m.row(k) -= before_(k + 1) * m.row(k + 1);
    m.row(k) /= pivot(k);
  }
  return m;
}

double CloudChain::log_determinant(const Vector &weights) const {
  const Vector known = pivots(Vector::Zero(diagonal_.size()));
  return (pivots(weights).array() / known.array()).log().sum();
}

} // namespace umov
