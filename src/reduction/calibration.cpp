#include <umov/reduction/calibration.h>

#include "algebra/dense.h"
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <map>
#include <umov/core/text.h>

namespace umov {
namespace {

using algebra::MatrixXd;
using algebra::VectorXd;
using Complex = std::complex<double>;

/// A square matrix that can be inverted to some digits.
bool is_regular(const MatrixXd &m) {
  const VectorXd s = algebra::singular_values(m);
  return s(s.size() - 1) > 1e-10 * s(0);
}

bool is_uncertain(const StandardMeasurement &one) { return one.degree_sd > 0 || one.angle_sd > 0; }

/// The truth of a star in steps of one standard deviation of its degree and of its angle; an
/// unpolarized one has no angle, and its q and u are as uncertain as its degree.
std::array<Complex, 2> truth_steps(const StandardMeasurement &one) {
  const double p = std::abs(one.truth);
  const Complex along = p > 0 ? one.truth / p : Complex(1);
  return {along * one.degree_sd, along * Complex(0, p > 0 ? 2 * p * one.angle_sd : one.degree_sd)};
}

/// Normal equations of factor, offset and, with a prior of one each, the steps of every star's
/// truth about a first `factor`.
class StarsOfTheirOwn {
public:
  StarsOfTheirOwn(std::span<const StandardMeasurement> data, Complex factor)
      : data_(data), factor_(factor) {
    for (const StandardMeasurement &one : data)
      if (is_uncertain(one))
        places_.try_emplace(one.star, 4 + 2 * static_cast<Eigen::Index>(places_.size()));
    const auto n = 4 + 2 * static_cast<Eigen::Index>(places_.size());
    normal_ = MatrixXd::Zero(n, n);
    right_ = VectorXd::Zero(n);
    normal_.diagonal().tail(n - 4).setOnes();
    for (const StandardMeasurement &one : data)
      add(one);
  }
  /// Takes a solution over, with its errors.
  void solve(PolarimeterCalibration &out) const {
    const MatrixXd covariance = algebra::inverse_of(normal_);
    const VectorXd x = algebra::times(covariance, right_);
    out.chi2 = x.tail(x.size() - 4).squaredNorm();
    for (const StandardMeasurement &one : data_)
      out.chi2 += std::norm(left(one, x));
    out.factor = {x(0), x(1)};
    out.offset = {x(2), x(3)};
    out.factor_sd = std::sqrt((covariance(0, 0) + covariance(1, 1)) / 2);
    out.offset_sd = std::sqrt((covariance(2, 2) + covariance(3, 3)) / 2);
  }

private:
  /// What each unknown does to a measurement, over its noise.
  [[nodiscard]] std::vector<std::pair<Eigen::Index, Complex>>
  effects(const StandardMeasurement &one) const {
    const double w = one.sd > 0 ? 1 / one.sd : 1;
    const Complex turned = std::polar(w, -2 * one.axis_rad), g = one.truth * turned;
    std::vector<std::pair<Eigen::Index, Complex>> out{
        {0, g}, {1, g * Complex(0, 1)}, {2, w}, {3, Complex(0, w)}};
    if (is_uncertain(one))
      for (std::size_t k = 0; k < 2; ++k)
        out.emplace_back(places_.at(one.star) + static_cast<Eigen::Index>(k),
                         factor_ * truth_steps(one)[k] * turned);
    return out;
  }
  void add(const StandardMeasurement &one) {
    const Complex z = one.measured / (one.sd > 0 ? one.sd : 1);
    const auto all = effects(one);
    for (const auto &[row, a] : all) {
      right_(row) += (std::conj(a) * z).real();
      for (const auto &[column, b] : all)
        normal_(row, column) += (std::conj(a) * b).real();
    }
  }
  [[nodiscard]] Complex left(const StandardMeasurement &one, const VectorXd &x) const {
    Complex out = one.measured / (one.sd > 0 ? one.sd : 1);
    for (const auto &[row, a] : effects(one))
      out -= a * x(row);
    return out;
  }

  std::span<const StandardMeasurement> data_;
  Complex factor_;
  std::map<std::size_t, Eigen::Index> places_;
  MatrixXd normal_;
  VectorXd right_;
};

} // namespace

Result<PolarimeterCalibration> calibrate_polarimeter(std::span<const StandardMeasurement> data) {
  const std::size_t n = data.size();
  bool has_polarized = false;
  for (const StandardMeasurement &one : data)
    has_polarized = has_polarized || std::abs(one.truth) > 0;
  if (n < 2 || !has_polarized)
    return fail(ErrorCode::BadInput,
                fmt::format("{} measurements of standards, {} polarized one among them; at least "
                            "two with a polarized standard were expected",
                            n, has_polarized ? "a" : "no"));
  // Normal equations of z = factor g + offset w, weighted: [[gg, gw], [conj(gw), ww]].
  double gg = 0, ww = 0;
  Complex gw, gz, wz;
  const auto weighted = [](const StandardMeasurement &one) {
    const double w = one.sd > 0 ? 1 / one.sd : 1;
    return std::tuple(one.truth * std::polar(1.0, -2 * one.axis_rad) * w, w, one.measured * w);
  };
  for (const StandardMeasurement &one : data) {
    const auto [g, w, z] = weighted(one);
    gg += std::norm(g);
    ww += w * w;
    gw += std::conj(g) * w;
    gz += std::conj(g) * z;
    wz += w * z;
  }
  const double determinant = gg * ww - std::norm(gw);
  constexpr double alike = 1e-6; // a twentieth of a degree between two angles
  if (std::abs(determinant) < alike * gg * ww)
    return fail(ErrorCode::BadInput,
                "all standards stand at one instrument angle: the angle of the instrument and its "
                "own polarization cannot be told apart. Turn it, or take an unpolarized star too");
  PolarimeterCalibration out;
  out.factor = (ww * gz - gw * wz) / determinant;
  out.offset = (gg * wz - std::conj(gw) * gz) / determinant;
  out.factor_sd = std::sqrt(ww / determinant);
  out.offset_sd = std::sqrt(gg / determinant);
  for (const StandardMeasurement &one : data) {
    const auto [g, w, z] = weighted(one);
    out.chi2 += std::norm(z - g * out.factor - w * out.offset);
  }
  out.dof = 2 * static_cast<int>(n) - 4;
  if (std::ranges::any_of(data, is_uncertain))
    for (int pass = 0; pass < 3; ++pass) // the steps of a truth count by the factor that is sought
      StarsOfTheirOwn(data, out.factor).solve(out);
  return out;
}

StokesRow calibrated_row(const PolarimeterCalibration &c, const StokesRow &row, double axis_rad) {
  // (Q + iU) of the instrument = factor (Q + iU) e^(-2i axis) + offset I, and the row answers to
  // it.
  const StokesRow own = row_on_sky(row, Angle::radians(-axis_rad));
  const Complex turned = c.factor * std::polar(1.0, -2 * axis_rad);
  return {own[0] + own[1] * c.offset.real() + own[2] * c.offset.imag(),
          own[1] * turned.real() + own[2] * turned.imag(),
          own[2] * turned.real() - own[1] * turned.imag(), own[3]};
}

double common_variance(const PolarimeterCalibration &c, Complex own) {
  return (c.offset_sd * c.offset_sd + std::norm(own) * c.factor_sd * c.factor_sd) /
         std::norm(c.factor);
}

CalibratedTarget apply(const PolarimeterCalibration &c, Complex measured, double axis_rad,
                       double variance) {
  CalibratedTarget out;
  const Complex own = (measured - c.offset) / c.factor;
  out.value = own * std::polar(1.0, 2 * axis_rad);
  out.variance = variance / std::norm(c.factor);
  out.common_variance = common_variance(c, own);
  return out;
}

Result<ChannelCalibration> calibrate_channel(std::span<const double> angles_rad,
                                             std::span<const double> counts, double variance) {
  const auto n = static_cast<Eigen::Index>(angles_rad.size());
  MatrixXd s(n, 3);
  VectorXd c(n);
  for (Eigen::Index k = 0; k < n; ++k) {
    const double angle = angles_rad[static_cast<std::size_t>(k)];
    s.row(k) << 1, std::cos(2 * angle), std::sin(2 * angle);
    c(k) = counts[static_cast<std::size_t>(k)];
  }
  const MatrixXd normal = algebra::gram(s);
  if (n < 3 || !is_regular(normal))
    return fail(ErrorCode::BadInput,
                fmt::format("{} of the polarizer: I, Q and U are not told; three different ones "
                            "within 180 deg were expected",
                            counted(static_cast<std::size_t>(n), "angle")));
  const MatrixXd inverse = algebra::inverse_of(normal);
  const VectorXd row = algebra::times(inverse, algebra::transposed_times(s, c));
  ChannelCalibration out;
  for (Eigen::Index k = 0; k < 3; ++k) {
    out.row[static_cast<std::size_t>(k)] = row(k);
    out.sd[static_cast<std::size_t>(k)] = std::sqrt(variance * inverse(k, k));
    for (Eigen::Index l = 0; l < 3; ++l)
      out.covariance[static_cast<std::size_t>(k)][static_cast<std::size_t>(l)] =
          variance * inverse(k, l);
  }
  return out;
}

ChannelAnalyser analyser_of(const ChannelCalibration &channel) {
  const double whole = channel.row[0], part = std::hypot(channel.row[1], channel.row[2]);
  const double c = channel.row[1] / part, s = channel.row[2] / part;
  ChannelAnalyser out;
  out.efficiency = part / whole;
  out.angle_rad = std::atan2(s, c) / 2;
  if (out.angle_rad < 0)
    out.angle_rad += pi;
  const auto sd_along = [&](const std::array<double, 3> &effect) {
    double variance = 0;
    for (std::size_t k = 0; k < 3; ++k)
      for (std::size_t l = 0; l < 3; ++l)
        variance += effect[k] * effect[l] * channel.covariance[k][l];
    return std::sqrt(variance);
  };
  out.efficiency_sd = sd_along({-out.efficiency / whole, c / whole, s / whole});
  out.angle_sd = sd_along({0, -s / (2 * part), c / (2 * part)});
  return out;
}

namespace {

/// What zero point, extinction, colour term and k'' do to m - m_inst.
std::array<double, 4> photometric_effects(double airmass, double colour) {
  return {1, -airmass, -colour, colour * airmass};
}

} // namespace

Result<PhotometricCalibration> calibrate_photometry(std::span<const PhotometricStandard> stars,
                                                    std::size_t terms) {
  const auto n = static_cast<Eigen::Index>(stars.size()),
             columns = static_cast<Eigen::Index>(terms);
  MatrixXd m(n, columns);
  VectorXd y(n);
  for (Eigen::Index k = 0; k < n; ++k) {
    const PhotometricStandard &one = stars[static_cast<std::size_t>(k)];
    const auto effects = photometric_effects(one.airmass, one.colour);
    for (Eigen::Index c = 0; c < columns; ++c)
      m(k, c) = effects[static_cast<std::size_t>(c)];
    y(k) = one.catalogue_mag - one.instrumental_mag;
  }
  const MatrixXd normal = algebra::gram(m);
  if (n <= columns || !is_regular(normal)) {
    constexpr std::array words{"zero point and extinction",
                               "zero point, extinction and colour term",
                               "zero point, extinction, colour term and k''"};
    return fail(
        ErrorCode::BadInput,
        fmt::format("{} measurements of standards do not tell {}; at least {} with different "
                    "air masses{} were expected",
                    n, words[terms - 2], terms + 1, terms > 2 ? " and colours" : ""));
  }
  const MatrixXd inverse = algebra::inverse_of(normal);
  const VectorXd found = algebra::times(inverse, algebra::transposed_times(m, y));
  PhotometricCalibration out;
  const std::array targets{&out.zero_point, &out.extinction, &out.colour_term, &out.second_order};
  out.residual_sd =
      std::sqrt((y - algebra::times(m, found)).squaredNorm() / static_cast<double>(n - columns));
  for (Eigen::Index a = 0; a < columns; ++a) {
    *targets[static_cast<std::size_t>(a)] = found(a);
    for (Eigen::Index b = 0; b < columns; ++b)
      out.covariance[static_cast<std::size_t>(a)][static_cast<std::size_t>(b)] =
          out.residual_sd * out.residual_sd * (inverse(a, b) + inverse(b, a)) / 2;
  }
  return out;
}

PhotometricOffset offset_of(const PhotometricCalibration &c, double airmass, double colour) {
  const auto effects = photometric_effects(airmass, colour);
  const std::array values{c.zero_point, c.extinction, c.colour_term, c.second_order};
  PhotometricOffset out;
  for (std::size_t a = 0; a < 4; ++a) {
    out.mag += effects[a] * values[a];
    for (std::size_t b = 0; b < 4; ++b)
      out.variance += effects[a] * c.covariance[a][b] * effects[b];
  }
  return out;
}

} // namespace umov
