#include <umov/reduction/calibration.h>

#include <Eigen/Dense>
#include <cmath>
#include <fmt/format.h>

namespace umov {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;
using Complex = std::complex<double>;

/// A square matrix that can be inverted to some digits.
bool is_regular(const Matrix &m) {
  const Eigen::JacobiSVD<Matrix> svd(m);
  const auto &s = svd.singularValues();
  return s(s.size() - 1) > 1e-10 * s(0);
}

} // namespace

Result<PolarimeterCalibration> calibrate_polarimeter(std::span<const StandardMeasurement> data) {
  const auto n = static_cast<Eigen::Index>(data.size());
  bool has_polarized = false;
  for (const StandardMeasurement &one : data)
    has_polarized = has_polarized || std::abs(one.truth) > 0;
  if (n < 2 || !has_polarized)
    return fail(ErrorCode::BadInput,
                fmt::format("{} measurements of standards, {} polarized one among them; at least "
                            "two with a polarized standard were expected",
                            n, has_polarized ? "a" : "no"));
  Eigen::MatrixXcd g(n, 2);
  Eigen::VectorXcd z(n);
  for (Eigen::Index k = 0; k < n; ++k) {
    const StandardMeasurement &one = data[static_cast<std::size_t>(k)];
    const double weight = one.sd > 0 ? 1 / one.sd : 1;
    g(k, 0) = one.truth * std::polar(1.0, -2 * one.axis_rad) * weight;
    g(k, 1) = weight;
    z(k) = one.measured * weight;
  }
  const Eigen::Matrix2cd normal = g.adjoint() * g;
  if (std::abs(normal.determinant()) < 1e-12 * std::abs(normal(0, 0) * normal(1, 1)))
    return fail(ErrorCode::BadInput,
                "all standards stand at one instrument angle: the angle of the instrument and its "
                "own polarization cannot be told apart. Turn it, or take an unpolarized star too");
  const Eigen::Matrix2cd inverse = normal.inverse();
  const Eigen::Vector2cd found = inverse * (g.adjoint() * z);
  PolarimeterCalibration out;
  out.factor = found(0);
  out.offset = found(1);
  out.factor_sd = std::sqrt(inverse(0, 0).real());
  out.offset_sd = std::sqrt(inverse(1, 1).real());
  out.chi2 = (z - g * found).squaredNorm();
  out.dof = static_cast<int>(2 * n - 4);
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
  Matrix s(n, 3);
  Vector c(n);
  for (Eigen::Index k = 0; k < n; ++k) {
    const double angle = angles_rad[static_cast<std::size_t>(k)];
    s.row(k) << 1, std::cos(2 * angle), std::sin(2 * angle);
    c(k) = counts[static_cast<std::size_t>(k)];
  }
  const Matrix normal = s.transpose() * s;
  if (n < 3 || !is_regular(normal))
    return fail(ErrorCode::BadInput,
                fmt::format("{} angles of the polarizer do not tell I, Q and U; three different "
                            "ones within 180 deg were expected",
                            n));
  const Matrix inverse = normal.inverse();
  const Vector row = inverse * (s.transpose() * c);
  ChannelCalibration out;
  for (Eigen::Index k = 0; k < 3; ++k) {
    out.row[static_cast<std::size_t>(k)] = row(k);
    out.sd[static_cast<std::size_t>(k)] = std::sqrt(variance * inverse(k, k));
  }
  return out;
}

Result<PhotometricCalibration> calibrate_photometry(std::span<const PhotometricStandard> stars) {
  const auto n = static_cast<Eigen::Index>(stars.size());
  Matrix m(n, 3);
  Vector y(n);
  for (Eigen::Index k = 0; k < n; ++k) {
    const PhotometricStandard &one = stars[static_cast<std::size_t>(k)];
    m.row(k) << 1, -one.airmass, -one.colour;
    y(k) = one.catalogue_mag - one.instrumental_mag;
  }
  const Matrix normal = m.transpose() * m;
  if (n < 4 || !is_regular(normal))
    return fail(ErrorCode::BadInput,
                fmt::format("{} standards do not tell zero point, extinction and colour term; at "
                            "least four with different air masses and colours were expected",
                            n));
  const Matrix inverse = normal.inverse();
  const Vector found = inverse * (m.transpose() * y);
  PhotometricCalibration out{found(0), found(1), found(2), {}, 0};
  out.residual_sd = std::sqrt((y - m * found).squaredNorm() / static_cast<double>(n - 3));
  for (Eigen::Index a = 0; a < 3; ++a)
    for (Eigen::Index b = 0; b < 3; ++b)
      out.covariance[static_cast<std::size_t>(a)][static_cast<std::size_t>(b)] =
          out.residual_sd * out.residual_sd * inverse(a, b);
  return out;
}

} // namespace umov
