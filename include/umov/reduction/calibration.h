#pragma once
// What standards tell of an instrument.

#include <array>
#include <complex>
#include <span>
#include <umov/core/result.h>
#include <umov/instrument/mueller.h>
#include <vector>

namespace umov {

/// A standard star as it was measured: z = q + iu in the instrument's axes.
struct StandardMeasurement {
  std::complex<double> measured;
  std::complex<double> truth; ///< in the sky frame
  double axis_rad = 0;        ///< of the instrument's x axis in that frame
  double sd = 0;              ///< of q and of u
  /// Measurements of one number are of one star, whose truth is wrong by the same in all of them.
  std::size_t star = 0;
  double degree_sd = 0; ///< of the star's degree, as its table has it
  double angle_sd = 0;  ///< of its position angle [rad]
};

/// measured = factor * truth e^(-2i axis) + offset.
struct PolarimeterCalibration {
  std::complex<double> factor{1, 0}; ///< efficiency e^(2i phi0)
  std::complex<double> offset;       ///< q0 + i u0
  /// Of real and imaginary part each; their mean square where a star's degree and angle are not
  /// known equally well.
  double factor_sd = 0, offset_sd = 0;
  double chi2 = 0;
  int dof = 0;
};

/// Complex least squares; where tables tell how well they know a star, its truth is fitted too,
/// with that as a prior: more nights on one star do not help beyond it. BadInput with fewer than
/// two measurements, without a polarized standard, or where one instrument angle alone cannot tell
/// the offset from the star.
Result<PolarimeterCalibration> calibrate_polarimeter(std::span<const StandardMeasurement> data);

/// What a channel makes of light in the sky frame once the instrument's own terms are known: its
/// row as designed, in that frame, behind the factor and the offset. Fitted with such rows, light
/// and covariance come out calibrated, each exposure by its own axis.
StokesRow calibrated_row(const PolarimeterCalibration &calibration, const StokesRow &row,
                         double axis_rad);
/// Variance of q and of u, each, that the errors of the calibration add; the same for a whole run.
/// `own`: the target's q + iu.
double common_variance(const PolarimeterCalibration &calibration, std::complex<double> own);

/// A target with its calibration applied, in the sky frame.
struct CalibratedTarget {
  std::complex<double> value;
  double variance = 0;        ///< of q and of u each, by its own noise
  double common_variance = 0; ///< more of it, the same for the whole run
};
/// Of a measurement in the instrument's axes.
CalibratedTarget apply(const PolarimeterCalibration &calibration, std::complex<double> measured,
                       double axis_rad, double variance);

/// One channel's row for I, Q, U from a polarizer turned before it: angles [rad] and counts.
struct ChannelCalibration {
  StokesRow row{};
  std::array<double, 3> sd{};
  std::array<std::array<double, 3>, 3> covariance{}; ///< of I, Q, U in the row
};
/// Counts are taken to have the variance `variance`.
Result<ChannelCalibration> calibrate_channel(std::span<const double> angles_rad,
                                             std::span<const double> counts, double variance);
/// How well a channel tells polarization apart, and along which angle [rad, 0 to pi].
struct ChannelAnalyser {
  double efficiency = 0, efficiency_sd = 0;
  double angle_rad = 0, angle_sd = 0;
};
/// Of a channel whose row was found, to first order in its errors.
ChannelAnalyser analyser_of(const ChannelCalibration &channel);

/// A standard in the light of one band.
struct PhotometricStandard {
  double catalogue_mag = 0, instrumental_mag = 0, airmass = 1, colour = 0;
};
/// m_std - m_inst = Z - k X - c C + k'' C X.
struct PhotometricCalibration {
  double zero_point = 0, extinction = 0, colour_term = 0, second_order = 0;
  std::array<std::array<double, 4>, 4> covariance{}; ///< in that order; 0: not fitted
  double residual_sd = 0;
};
/// Linear least squares with equal weights of the first `terms` of those: 2 to 4. BadInput with no
/// more stars than terms or where air mass or colour do not change.
Result<PhotometricCalibration> calibrate_photometry(std::span<const PhotometricStandard> stars,
                                                    std::size_t terms = 3);
/// m - m_inst above the air of a source of that colour at an air mass, and its variance.
struct PhotometricOffset {
  double mag = 0, variance = 0;
};
/// Of a calibration.
PhotometricOffset offset_of(const PhotometricCalibration &calibration, double airmass,
                            double colour);

} // namespace umov
