#include <umov/reduction/stokes_fit.h>

#include "algebra/dense.h"
#include "reduction/count_covariance.h"
#include <umov/reduction/open_air.h>

#include <cmath>
#include <fmt/format.h>
#include <map>
#include <umov/instrument/polarimeter.h>

namespace umov {
namespace {

using Matrix = algebra::MatrixXd;
using Vector = algebra::VectorXd;

struct System {
  Matrix w;
  Vector n, sky, fixed, excess;
};

System system_of(std::span<const ChannelDatum> data, std::size_t parameters) {
  const auto rows = static_cast<Eigen::Index>(data.size());
  System out{Matrix(rows, static_cast<Eigen::Index>(parameters)), Vector(rows), Vector(rows),
             Vector(rows), Vector(rows)};
  for (Eigen::Index r = 0; r < rows; ++r) {
    const ChannelDatum &one = data[static_cast<std::size_t>(r)];
    for (std::size_t c = 0; c < parameters; ++c)
      out.w(r, static_cast<Eigen::Index>(c)) = one.row[c];
    out.n(r) = one.counts;
    out.sky(r) = one.sky;
    out.fixed(r) = one.fixed_variance;
    out.excess(r) = one.excess2;
  }
  return out;
}

/// Rows are electrons per flux: scaled to a largest of 1, so that nothing under- or overflows.
double scale_of(std::span<const ChannelDatum> data) {
  double out = 0;
  for (const ChannelDatum &one : data)
    out = std::max(out, std::abs(one.row[0]));
  return out;
}

/// Counts of a model; of noise alone no less than a thousandth of an electron.
Vector variance_of(const System &s, const Vector &stokes) {
  const Vector mean = (algebra::times(s.w, stokes) + s.sky).cwiseMax(1e-3);
  return mean.cwiseProduct(s.excess) + s.fixed;
}

struct Solution {
  Vector stokes;
  Matrix covariance;
};

Solution solve(const System &s, const CountCovariance &c) {
  const Matrix weighted = c.inverse_times(s.w);
  Solution out;
  out.covariance = algebra::inverse_of(algebra::transposed_product(weighted, s.w));
  out.stokes = algebra::times(out.covariance, algebra::transposed_times(weighted, s.n - s.sky));
  return out;
}

StokesFit put(const System &s, const Solution &solution, const CountCovariance &c, double scale) {
  StokesFit out;
  const auto k = solution.stokes.size();
  for (Eigen::Index i = 0; i < k; ++i) {
    out.stokes[static_cast<std::size_t>(i)] = solution.stokes(i) / scale;
    for (Eigen::Index j = 0; j < k; ++j)
      out.covariance[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)] =
          solution.covariance(i, j) / scale / scale;
  }
  const Vector residual = s.n - s.sky - algebra::times(s.w, solution.stokes);
  out.chi2 = residual.dot(c.inverse_times(residual).col(0));
  out.dof = static_cast<int>(s.n.size() - k);
  out.minus_2_log_likelihood = out.chi2 + c.log_determinant();
  return out;
}

Result<void> check_rows(std::span<const ChannelDatum> data, std::size_t parameters, double scale) {
  std::vector<StokesRow> rows;
  for (const ChannelDatum &one : data)
    rows.push_back(one.row * (1 / scale));
  const ModulationQuality quality = modulation_quality(rows, parameters);
  if (data.size() >= parameters && std::isfinite(quality.weighted_variance))
    return {};
  return fail(ErrorCode::BadInput,
              fmt::format("{} channels of a set cannot tell {} (condition number {:.3g}); a "
                          "sequence of at least {} different states is needed",
                          data.size(), quality.missing.empty() ? "I, Q, U" : quality.missing,
                          quality.condition, parameters));
}

} // namespace

namespace {

/// `light`: of each count, on which an air that is not known acts.
Result<StokesFit> fit_under(std::span<const ChannelDatum> data, std::size_t parameters,
                            std::span<const CommonError> common, const AirOfCounts *air,
                            const Vector &light) {
  const double scale = scale_of(data);
  UMOV_TRY(check_rows(data, parameters, scale));
  System s = system_of(data, parameters);
  s.w /= scale;
  Vector variance = s.n.cwiseMax(1).cwiseProduct(s.excess) + s.fixed;
  const auto plain = [&] { return CountCovariance(variance, light, nullptr, {}); };
  Solution solution;
  constexpr int rounds = 8; // each gains two digits or more
  for (int k = 0; k < rounds; ++k) {
    solution = solve(s, plain());
    variance = variance_of(s, solution.stokes);
  }
  if (common.empty() && air == nullptr)
    return put(s, solution, plain(), scale);
  const CommonEffects effects = effects_of(common, s.n.size());
  const CountCovariance c(variance + effects.own, light, air, effects.shared);
  return put(s, solve(s, c), c, scale);
}

} // namespace

Result<StokesFit> fit_stokes(std::span<const ChannelDatum> data, std::size_t parameters) {
  return fit_stokes(data, parameters, {});
}

Result<StokesFit> fit_stokes(std::span<const ChannelDatum> data, std::size_t parameters,
                             std::span<const CommonError> common) {
  return fit_under(data, parameters, common, nullptr, {});
}

Result<StokesFit> fit_stokes(std::span<const ChannelDatum> data, std::size_t parameters,
                             std::span<const CommonError> common, const OpenAir &air,
                             const std::array<double, 4> &stokes) {
  const auto &[i, q, u, v] = stokes;
  Vector light(static_cast<Eigen::Index>(data.size()));
  for (std::size_t k = 0; k < data.size(); ++k)
    light(static_cast<Eigen::Index>(k)) = respond(data[k].row, Stokes<InstrumentAxes>{i, q, u, v});
  if (air.is_known())
    return fit_under(data, parameters, common, nullptr, light);
  const AirOfCounts before = air_of(air);
  return fit_under(data, parameters, common, &before, light);
}

namespace {

/// What a channel answers to more retardance, per radian, before the polarimeter or of its plate:
/// retarders of one axis add up, whatever stands behind them. `angle_rad`: of that axis, from the
/// instrument's x.
double retardance_effect(const ModelledDatum &m, double angle_rad) {
  const double axis = m.axis_rad + angle_rad;
  const StokesRow row = row_on_sky(m.datum.row, Angle::radians(-axis));
  const double u = m.stokes[2] * std::cos(2 * axis) - m.stokes[1] * std::sin(2 * axis);
  return row[3] * u - row[2] * m.stokes[3];
}

/// The same of a plate that is turned a little further, per radian.
double plate_effect(const ModelledDatum &m) {
  const Angle retardance = Angle::radians(m.retardance_rad);
  const StokesRow own = row_on_sky(m.datum.row, Angle::radians(-m.axis_rad));
  const StokesRow analyser =
      own * retarder(Angle::radians(-m.retardance_rad), Angle::radians(m.plate_rad));
  constexpr double step = 1e-4; // its square is left out
  const auto turned = [&](double by) {
    const StokesRow row = analyser * retarder(retardance, Angle::radians(m.plate_rad + by));
    const auto &[i, q, u, v] = m.stokes;
    return respond(row_on_sky(row, Angle::radians(m.axis_rad)), Stokes<InstrumentAxes>{i, q, u, v});
  };
  return (turned(step) - turned(-step)) / (2 * step);
}

} // namespace

std::vector<CommonError> common_errors(const ErrorPriors &priors,
                                       std::span<const ModelledDatum> data) {
  std::vector<CommonError> out;
  const auto add = [&](double sd, auto effect) {
    if (sd <= 0)
      return;
    CommonError one{{}, sd};
    for (const ModelledDatum &m : data)
      one.effect.push_back(effect(m));
    out.push_back(std::move(one));
  };
  const auto star = [](const ModelledDatum &m) {
    const auto &[i, q, u, v] = m.stokes;
    return respond(m.datum.row, Stokes<InstrumentAxes>{i, q, u, v});
  };
  const auto own_axes = [](const ModelledDatum &m) {
    return row_on_sky(m.datum.row, Angle::radians(-m.axis_rad));
  };
  add(priors.instrumental, [&](const auto &m) { return own_axes(m)[1] * m.stokes[0]; });
  add(priors.instrumental, [&](const auto &m) { return own_axes(m)[2] * m.stokes[0]; });
  std::map<std::size_t, std::vector<std::size_t>> channels;
  if (priors.gain > 0)
    for (std::size_t k = 0; k < data.size(); ++k)
      channels[data[k].channel].push_back(k);
  for (const auto &[channel, rows] : channels) {
    const std::size_t first = rows.front();
    CommonError one{std::vector<double>(rows.back() - first + 1, 0), priors.gain, first};
    for (const std::size_t k : rows)
      one.effect[k - first] = star(data[k]);
    out.push_back(std::move(one));
  }
  add(priors.transparency, star);
  const auto turn = [](const ModelledDatum &m) { // of the x axis, per radian
    return 2 * (m.datum.row[2] * m.stokes[1] - m.datum.row[1] * m.stokes[2]);
  };
  add(priors.angle_rad, turn);
  add(priors.efficiency, [](const ModelledDatum &m) {
    return m.datum.row[1] * m.stokes[1] + m.datum.row[2] * m.stokes[2];
  });
  add(priors.sky, [](const ModelledDatum &m) { return m.datum.sky; });
  add(priors.sky_p, [](const ModelledDatum &m) { // sunlit skies are polarized along it
    const StokesRow &row = m.datum.row;
    return m.datum.sky / row[0] *
           (row[1] * std::cos(2 * m.scatter_rad) + row[2] * std::sin(2 * m.scatter_rad));
  });
  add(priors.crosstalk, [](const ModelledDatum &m) { return retardance_effect(m, 0); });
  add(priors.crosstalk, [](const ModelledDatum &m) { return retardance_effect(m, pi / 4); });
  add(priors.plate_rad, plate_effect);
  add(priors.retardance_rad,
      [](const ModelledDatum &m) { return retardance_effect(m, m.plate_rad); });
  add(priors.time_s, [&](const ModelledDatum &m) { return m.turn_rad_s * turn(m); });
  return out;
}

std::vector<CommonError> common_errors(const ErrorPriors &priors,
                                       std::span<const ChannelDatum> data, const StokesFit &fit,
                                       double axis_rad) {
  std::vector<ModelledDatum> modelled;
  for (const ChannelDatum &datum : data)
    modelled.push_back({datum, fit.stokes, axis_rad, modelled.size()});
  return common_errors(priors, modelled);
}

StokesFractions fractions_of(const StokesFit &fit) {
  StokesFractions out;
  const double i = fit.stokes[0];
  double jacobian[3][4]{};
  for (std::size_t k = 0; k < 3; ++k) {
    out.value[k] = fit.stokes[k + 1] / i;
    jacobian[k][0] = -fit.stokes[k + 1] / (i * i);
    jacobian[k][k + 1] = 1 / i;
  }
  for (std::size_t a = 0; a < 3; ++a)
    for (std::size_t b = 0; b < 3; ++b)
      for (std::size_t c = 0; c < 4; ++c)
        for (std::size_t d = 0; d < 4; ++d)
          out.covariance[a][b] += jacobian[a][c] * fit.covariance[c][d] * jacobian[b][d];
  return out;
}

} // namespace umov
