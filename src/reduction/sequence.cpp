#include <umov/reduction/sequence.h>

#include "algebra/dense.h"
#include "reduction/count_covariance.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace umov {
namespace {

using Matrix = algebra::MatrixXd;
using Vector = algebra::VectorXd;

/// 1, cos, sin, cos 2, sin 2 ... of the phase.
Vector fourier_at(double phase, Eigen::Index harmonics) {
  Vector out(1 + 2 * harmonics);
  out(0) = 1;
  for (Eigen::Index k = 1; k <= harmonics; ++k) {
    const double turned = static_cast<double>(k) * phase;
    out(2 * k - 1) = std::cos(turned);
    out(2 * k) = std::sin(turned);
  }
  return out;
}

Vector basis_at(const BrightnessBasis &basis, double time_s) {
  if (!(basis.knot_s > 0))
    return fourier_at(2 * pi * time_s / basis.period_s, basis.harmonics);
  Vector out = Vector::Zero(basis.pieces + 3);
  const double x =
      std::clamp((time_s - basis.begin_s) / basis.knot_s, 0., static_cast<double>(basis.pieces));
  const int piece = std::min(static_cast<int>(x), basis.pieces - 1);
  const double u = x - piece, v = 1 - u;
  out.segment<4>(piece) << v * v * v, (3 * u - 6) * u * u + 4, (3 * v - 6) * v * v + 4, u * u * u;
  return out / 6;
}

/// What of the series is its mean over time: of the counts alone it would be that of the times that
/// were not saturated.
Vector mean_of(const BrightnessBasis &basis, Eigen::Index terms) {
  if (!(basis.knot_s > 0))
    return Vector::Unit(terms, 0);
  constexpr int per_piece = 8; // midpoints: a cubic's mean to 1e-3 of its change within a piece
  const int times = per_piece * basis.pieces;
  Vector out = Vector::Zero(terms);
  for (int k = 0; k < times; ++k)
    out += basis_at(basis, basis.begin_s + (k + 0.5) / per_piece * basis.knot_s) / times;
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
  return algebra::symmetric_eigenvalues(unit)(0) > least;
}

tl::unexpected<Error> indistinct() {
  return fail(ErrorCode::BadInput, "the series does not tell brightness and polarization apart; "
                                   "fewer harmonics, knots further apart (and than the gaps "
                                   "between the counts), or more analyser angles are needed");
}

/// The air before a series: neighbours of one exposure share its flicker.
AirOfCounts air_before(std::span<const TimedDatum> data, const CloudPrior &prior) {
  AirOfCounts out;
  std::vector<CountMoment> counts;
  std::vector<double> flicker;
  for (std::size_t k = 0; k < data.size(); ++k) {
    if (k == 0 || data[k].exposure != data[k - 1].exposure)
      flicker.push_back(data[k].flicker);
    out.pupil.push_back(static_cast<Eigen::Index>(flicker.size()) - 1);
    counts.push_back({data[k].time_s, static_cast<std::int64_t>(data[k].exposure)});
  }
  out.flicker = Eigen::Map<const Vector>(flicker.data(), static_cast<Eigen::Index>(flicker.size()));
  out.cloud = CloudChain(counts, prior);
  return out;
}

/// Data as matrices, and what the fit needs of them.
class SequenceSolver {
public:
  SequenceSolver(std::span<const TimedDatum> data, const BrightnessBasis &made_of,
                 const CloudPrior &cloud)
      : data_(data), made_of_(made_of), air_(air_before(data, cloud)) {
    const auto n = static_cast<Eigen::Index>(data.size());
    basis_.resize(n, basis_at(made_of, data.front().time_s).size());
    counts_.resize(n), sky_.resize(n), fixed_.resize(n), excess_.resize(n);
    for (Eigen::Index r = 0; r < n; ++r) {
      const TimedDatum &one = data[static_cast<std::size_t>(r)];
      basis_.row(r) = basis_at(made_of, one.time_s).transpose();
      counts_(r) = one.datum.counts;
      sky_(r) = one.datum.sky;
      fixed_(r) = one.datum.fixed_variance;
      excess_(r) = one.datum.excess2;
      scale_ += one.datum.row[0] / static_cast<double>(n);
      light_ += (one.datum.counts - one.datum.sky) / static_cast<double>(n);
    }
  }

  [[nodiscard]] State flat(Eigen::Index fractions) const {
    State out{Vector::Zero(basis_.cols()), Vector::Zero(fractions)};
    if (made_of_.knot_s > 0)
      out.series.setConstant(light_); // splines add up to one
    else
      out.series(0) = light_;
    return out;
  }
  [[nodiscard]] State from(const SequenceFit &fit) const {
    State out{Vector(basis_.cols()), Vector(fit.parameters - 1)};
    for (Eigen::Index k = 0; k < out.series.size(); ++k)
      out.series(k) = fit.series[static_cast<std::size_t>(k)] * scale_;
    for (Eigen::Index k = 0; k < out.fractions.size(); ++k)
      out.fractions(k) = fit.fractions.value[static_cast<std::size_t>(k)];
    return out;
  }

  /// Gauss-Newton with the variance of the model, and of what is common to several counts.
  Result<SequenceFit> solve(State state, std::span<const CommonError> common) const {
    const CommonEffects effects = effects_of(common, counts_.size());
    Matrix covariance;
    SequenceFit out;
    constexpr int rounds = 15;
    for (int k = 0; k < rounds; ++k) {
      const Linearised now = linearise(data_, basis_, state, scale_);
      const Vector residual = counts_ - now.mean;
      const CountCovariance c(now.mean.cwiseMax(1).cwiseProduct(excess_) + fixed_ + effects.own,
                              now.mean - sky_, &air_, effects.shared);
      const Matrix weighted = c.inverse_times(now.jacobian).transpose();
      const Matrix normal = algebra::product(weighted, now.jacobian);
      if (!tells_apart(normal))
        return indistinct();
      const algebra::SymmetricFactor factor(normal);
      const Vector step = factor.solve(algebra::times(weighted, residual));
      if (!factor.is_solvable() || !step.allFinite())
        return indistinct();
      state.series += step.head(state.series.size());
      state.fractions += step.tail(state.fractions.size());
      covariance = factor.inverse();
      out.chi2 = residual.dot(c.inverse_times(residual).col(0));
    }
    put(state, covariance, out);
    return out;
  }

private:
  void put(const State &state, const Matrix &covariance, SequenceFit &out) const {
    const Eigen::Index terms = state.series.size(), fractions = state.fractions.size();
    out.basis = made_of_;
    out.parameters = static_cast<int>(fractions) + 1;
    out.dof = static_cast<int>(counts_.size() - terms - fractions);
    const Vector mean = mean_of(made_of_, terms);
    out.mean = mean.dot(state.series) / scale_;
    out.mean_variance =
        mean.dot(algebra::times(covariance.topLeftCorner(terms, terms), mean)) / (scale_ * scale_);
    for (Eigen::Index k = 0; k < terms; ++k)
      out.series.push_back(state.series(k) / scale_);
    for (Eigen::Index a = 0; a < fractions; ++a) {
      out.fractions.value[static_cast<std::size_t>(a)] = state.fractions(a);
      for (Eigen::Index b = 0; b < fractions; ++b)
        out.fractions.covariance[static_cast<std::size_t>(a)][static_cast<std::size_t>(b)] =
            covariance(terms + a, terms + b);
    }
  }

  std::span<const TimedDatum> data_;
  BrightnessBasis made_of_;
  AirOfCounts air_;
  double scale_ = 0, light_ = 0;
  Matrix basis_;
  Vector counts_, sky_, fixed_, excess_;
};

} // namespace

namespace {

Result<SequenceFit> fit_basis(std::span<const TimedDatum> data, const BrightnessBasis &basis,
                              Eigen::Index terms, std::size_t parameters, const char *fewer,
                              const CloudPrior &cloud) {
  const auto n = static_cast<Eigen::Index>(data.size());
  const auto fractions = static_cast<Eigen::Index>(parameters) - 1;
  if (n <= terms + fractions)
    return fail(ErrorCode::BadInput,
                fmt::format("{} counts for {} unknowns; a longer series, or {}, is needed", n,
                            terms + fractions, fewer));
  const SequenceSolver solver(data, basis, cloud);
  return solver.solve(solver.flat(fractions), {});
}

} // namespace

Result<SequenceFit> fit_sequence(std::span<const TimedDatum> data, double period_s, int harmonics,
                                 std::size_t parameters, const CloudPrior &cloud) {
  const std::string fewer = fmt::format("fewer harmonics than {}", harmonics);
  return fit_basis(data, {period_s, harmonics, 0, 0, 0}, 1 + 2 * harmonics, parameters,
                   fewer.c_str(), cloud);
}

Result<SequenceFit> fit_spline(std::span<const TimedDatum> data, double knot_s,
                               std::size_t parameters, const CloudPrior &cloud) {
  if (data.empty())
    return fail(ErrorCode::BadInput, "a series without counts");
  const auto [first, last] = std::ranges::minmax(data, {}, &TimedDatum::time_s);
  const double span = std::max(last.time_s - first.time_s, 1e-9);
  const double pieces = std::max(1., std::ceil(span / knot_s - 1e-9));
  if (constexpr double most = 1000; pieces > most)
    return fail(ErrorCode::BadInput,
                fmt::format("{:g} knots {:g} s apart; up to {:g} can be fitted, so that {:.3g} s "
                            "is the least distance",
                            pieces, knot_s, most, span / most));
  const BrightnessBasis basis{0, 0, span / pieces, first.time_s, static_cast<int>(pieces)};
  return fit_basis(data, basis, basis.pieces + 3, parameters, "knots further apart", cloud);
}

Result<SequenceFit> fit_sequence(std::span<const TimedDatum> data, const SequenceFit &without,
                                 std::span<const CommonError> common, const CloudPrior &cloud) {
  const SequenceSolver solver(data, without.basis, cloud);
  return solver.solve(solver.from(without), common);
}

std::array<double, 4> stokes_at(const SequenceFit &fit, double time_s) {
  const Vector basis = basis_at(fit.basis, time_s);
  const double brightness = basis.dot(Eigen::Map<const Vector>(fit.series.data(), basis.size()));
  const auto &f = fit.fractions.value;
  return {brightness, brightness * f[0], brightness * f[1], brightness * f[2]};
}

} // namespace umov
