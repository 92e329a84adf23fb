#include <umov/reduction/sequence.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace umov {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

/// 1, cos, sin, cos 2, sin 2 ... of the phase.
Vector basis_at(double phase, Eigen::Index harmonics) {
  Vector out(1 + 2 * harmonics);
  out(0) = 1;
  for (Eigen::Index k = 1; k <= harmonics; ++k) {
    const double turned = static_cast<double>(k) * phase;
    out(2 * k - 1) = std::cos(turned);
    out(2 * k) = std::sin(turned);
  }
  return out;
}

/// Series and fractions, the series scaled so that its mean is in counts.
struct State {
  Vector series, fractions;
};

struct Linearised {
  Matrix jacobian;
  Vector mean;
};

Linearised linearise(std::span<const TimedDatum> data, const Matrix &basis, const State &state,
                     double scale) {
  const auto n = static_cast<Eigen::Index>(data.size());
  const auto terms = state.series.size(), fractions = state.fractions.size();
  Linearised out{Matrix(n, terms + fractions), Vector(n)};
  for (Eigen::Index r = 0; r < n; ++r) {
    const ChannelDatum &d = data[static_cast<std::size_t>(r)].datum;
    const double brightness = basis.row(r).dot(state.series);
    double response = d.row[0];
    for (Eigen::Index k = 0; k < fractions; ++k)
      response += d.row[static_cast<std::size_t>(k + 1)] * state.fractions(k);
    out.mean(r) = brightness * response / scale + d.sky;
    out.jacobian.row(r).head(terms) = basis.row(r) * (response / scale);
    for (Eigen::Index k = 0; k < fractions; ++k)
      out.jacobian(r, terms + k) = brightness * d.row[static_cast<std::size_t>(k + 1)] / scale;
  }
  return out;
}

} // namespace

std::complex<double> false_polarization(std::span<const double> angles_rad,
                                        std::span<const double> light) {
  std::complex<double> sum;
  double mean = 0;
  const auto n = static_cast<double>(light.size());
  for (std::size_t k = 0; k < light.size(); ++k) {
    sum += std::polar(1.0, 2 * angles_rad[k]) * light[k];
    mean += light[k] / n;
  }
  return 2 / n * sum / mean;
}

namespace {

/// Every unknown has an effect of its own: the smallest eigenvalue in units of each one's own.
bool tells_apart(const Matrix &normal) {
  const Vector root = normal.diagonal().cwiseSqrt();
  if (!(root.minCoeff() > 0) || !root.allFinite())
    return false;
  const Vector inverse = root.cwiseInverse();
  const Matrix unit = inverse.asDiagonal() * normal * inverse.asDiagonal();
  constexpr double least = 1e-9; // of rounding there is 1e-14
  return Eigen::SelfAdjointEigenSolver<Matrix>(unit, Eigen::EigenvaluesOnly).eigenvalues()(0) >
         least;
}

tl::unexpected<Error> indistinct() {
  return fail(ErrorCode::BadInput, "the series does not tell brightness and polarization apart; "
                                   "fewer harmonics or more analyser angles are needed");
}

} // namespace

Result<SequenceFit> fit_sequence(std::span<const TimedDatum> data, double period_s, int harmonics,
                                 std::size_t parameters) {
  const auto n = static_cast<Eigen::Index>(data.size());
  const Eigen::Index terms = 1 + 2 * harmonics;
  const auto fractions = static_cast<Eigen::Index>(parameters) - 1;
  if (n <= terms + fractions)
    return fail(ErrorCode::BadInput,
                fmt::format("{} counts for {} unknowns; a longer series, or fewer harmonics than "
                            "{}, is needed",
                            n, terms + fractions, harmonics));
  double scale = 0, light = 0;
  Matrix basis(n, terms);
  Vector counts(n), fixed(n), excess(n), sky(n);
  for (Eigen::Index r = 0; r < n; ++r) {
    const TimedDatum &one = data[static_cast<std::size_t>(r)];
    const double phase = 2 * pi * one.time_s / period_s;
    basis.row(r) = basis_at(phase, harmonics).transpose();
    counts(r) = one.datum.counts;
    fixed(r) = one.datum.fixed_variance;
    excess(r) = one.datum.excess2;
    scale += one.datum.row[0] / static_cast<double>(n);
    light += (one.datum.counts - one.datum.sky) / static_cast<double>(n);
  }
  State state{Vector::Zero(terms), Vector::Zero(fractions)};
  state.series(0) = light;
  Matrix covariance;
  SequenceFit out;
  constexpr int rounds = 15;
  for (int k = 0; k < rounds; ++k) {
    const Linearised now = linearise(data, basis, state, scale);
    const Vector weight = (now.mean.cwiseMax(1).cwiseProduct(excess) + fixed).cwiseInverse();
    const Matrix weighted = now.jacobian.transpose() * weight.asDiagonal();
    const Eigen::LDLT<Matrix> factor(weighted * now.jacobian);
    if (!tells_apart(weighted * now.jacobian))
      return indistinct();
    const Vector residual = counts - now.mean, step = factor.solve(weighted * residual);
    if (factor.info() != Eigen::Success || !step.allFinite())
      return indistinct();
    state.series += step.head(terms);
    state.fractions += step.tail(fractions);
    covariance = factor.solve(Matrix::Identity(terms + fractions, terms + fractions));
    out.chi2 = residual.dot(weight.cwiseProduct(residual));
  }
  out.dof = static_cast<int>(n - terms - fractions);
  out.mean_variance = covariance(0, 0) / (scale * scale);
  for (Eigen::Index k = 0; k < terms; ++k)
    out.series.push_back(state.series(k) / scale);
  for (Eigen::Index a = 0; a < fractions; ++a) {
    out.fractions.value[static_cast<std::size_t>(a)] = state.fractions(a);
    for (Eigen::Index b = 0; b < fractions; ++b)
      out.fractions.covariance[static_cast<std::size_t>(a)][static_cast<std::size_t>(b)] =
          covariance(terms + a, terms + b);
  }
  return out;
}

} // namespace umov
