#pragma once
// Exposures one after the other of a source that changes meanwhile.

#include <array>
#include <complex>
#include <span>
#include <umov/reduction/stokes_fit.h>
#include <vector>

namespace umov {

/// False polarization q + iu that analysers at these angles, one after the other, make of an
/// unpolarized light whose exposures hold `light`.
std::complex<double> false_polarization(std::span<const double> angles_rad,
                                        std::span<const double> light);

/// A count at its own time.
struct TimedDatum {
  double time_s = 0;
  ChannelDatum datum;
  std::size_t exposure = 0; ///< neighbours of one exposure share its transparency
  double flicker = 0;       ///< relative standard deviation of that
};
/// Thin cloud: a transparency that all counts of a moment (of one exposure, or one time) share and
/// that wanders from moment to moment, by itself or as an Ornstein-Uhlenbeck process.
struct CloudPrior {
  double sd = 0;     ///< relative; 0: none
  double time_s = 0; ///< moments share it as exp(-dt/this); 0: each has its own
};
/// What brightness over time is made of: a Fourier series (mean, then cosine and sine of each
/// harmonic), or cubic B-splines on even knots.
struct BrightnessBasis {
  double period_s = 0;
  int harmonics = 0;
  double knot_s = 0, begin_s = 0; ///< distance of knots, 0: a Fourier series; the first of them
  int pieces = 0;                 ///< between knots
};
/// Brightness over time, with q, u (and v) that stay.
struct SequenceFit {
  std::vector<double> series; ///< coefficients of the basis
  BrightnessBasis basis;
  double mean = 0;          ///< brightness over the period, or from the first count to the last
  int parameters = 3;       ///< that were fitted: I, Q, U or all four
  double mean_variance = 0; ///< of the mean
  StokesFractions fractions;
  double chi2 = 0;
  int dof = 0;
};
/// Fits the raw counts (Gauss-Newton, variance of the model): nothing is differenced, so that a
/// change between two exposures is not taken for polarization. `parameters` 3 or 4.
Result<SequenceFit> fit_sequence(std::span<const TimedDatum> data, double period_s, int harmonics,
                                 std::size_t parameters, const CloudPrior &cloud = {});
/// The same with splines, for light that has no period: knots every `knot_s` or a little less.
Result<SequenceFit> fit_spline(std::span<const TimedDatum> data, double knot_s,
                               std::size_t parameters, const CloudPrior &cloud = {});
/// The same with common errors on top (C = C_n + J Sigma J^T by one small matrix), begun at the
/// fit without them.
Result<SequenceFit> fit_sequence(std::span<const TimedDatum> data, const SequenceFit &without,
                                 std::span<const CommonError> common, const CloudPrior &cloud = {});
/// I, Q, U, V of a fit at a time.
std::array<double, 4> stokes_at(const SequenceFit &fit, double time_s);

} // namespace umov
