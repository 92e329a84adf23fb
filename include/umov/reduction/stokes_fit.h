#pragma once
// Counts of several channels to Stokes parameters with their covariance.

#include <array>
#include <span>
#include <umov/core/quantity.h>
#include <umov/core/result.h>
#include <umov/instrument/mueller.h>
#include <vector>

namespace umov {

/// One channel of a set.
struct ChannelDatum {
  double counts = 0;         ///< electrons, sky included
  double sky = 0;            ///< of them
  double fixed_variance = 0; ///< [e2]: reading, rounding, and the error of the sky
  double excess2 = 1;        ///< of a multiplying register
  StokesRow row{};           ///< counts - sky = row . S
};

/// Something that is not known and moves several channels together.
struct CommonError {
  /// On each channel from `first` on [e] per unit; on the others it has none. That of one channel
  /// by itself costs a fit no more than the channel does.
  std::vector<double> effect;
  double sd = 0; ///< of its prior
  std::size_t first = 0;
};

/// Stokes parameters of a set.
struct StokesFit {
  std::array<double, 4> stokes{}; ///< I, Q, U, V in the units that the rows take
  std::array<std::array<double, 4>, 4> covariance{};
  double chi2 = 0;
  int dof = 0;
  double minus_2_log_likelihood = 0; ///< normal, without n ln 2 pi
};

/// Least squares with the variance that the model itself implies, iterated: a variance from the
/// data draws means down. `parameters`: 1 (I), 3 (I, Q, U) or 4. BadInput where the rows cannot
/// tell one of them.
Result<StokesFit> fit_stokes(std::span<const ChannelDatum> data, std::size_t parameters);
/// The same with common errors on top (C = C_n + J Sigma J^T), at the model of the fit without
/// them.
Result<StokesFit> fit_stokes(std::span<const ChannelDatum> data, std::size_t parameters,
                             std::span<const CommonError> common);

/// What common errors of an instrument may be, as standard deviations; 0: known.
struct ErrorPriors {
  double instrumental = 0; ///< of q0 and of u0
  double gain = 0;         ///< of each channel
  double transparency = 0; ///< of a set: scintillation, cloud
  double angle_rad = 0;    ///< of the instrument's x axis
  double efficiency = 0;   ///< of q, u
  double sky = 0;          ///< of the whole sky, relative
  double sky_p = 0;        ///< of the sky's polarization along the normal of the scattering plane
  /// Of two retardances before the polarimeter, along its x axis and at 45 deg to it [rad]: what
  /// mirrors make of U, and of Q, in V and back.
  double crosstalk = 0;
  double plate_rad = 0;      ///< of the zero of the plate's angle
  double retardance_rad = 0; ///< of the plate
  double time_s = 0;         ///< of the clock: where the instrument's axes turn in the sky
};
/// A channel of an exposure, and what is known of it.
struct ModelledDatum {
  ChannelDatum datum;
  std::array<double, 4> stokes{}; ///< of the model at its time
  double axis_rad = 0;            ///< of the instrument's x axis in the frame of the rows
  std::size_t channel = 0;        ///< those of one number share a gain
  double plate_rad = 0;           ///< angle of a plate behind the telescope, from that x axis
  double retardance_rad = pi;     ///< of the plate
  double turn_rad_s = 0;          ///< of the x axis
  double scatter_rad = 0;         ///< position angle of the normal of the scattering plane
};
/// Effects of the priors on channels of one exposure or of many.
std::vector<CommonError> common_errors(const ErrorPriors &priors,
                                       std::span<const ModelledDatum> data);
/// The same for the channels of one exposure, each with a gain of its own; `fit`: of the same data.
std::vector<CommonError> common_errors(const ErrorPriors &priors,
                                       std::span<const ChannelDatum> data, const StokesFit &fit,
                                       double axis_rad);

/// q, u, v and their covariance.
struct StokesFractions {
  std::array<double, 3> value{};
  std::array<std::array<double, 3>, 3> covariance{};
};
/// Of a fit, to first order in the errors.
StokesFractions fractions_of(const StokesFit &fit);

} // namespace umov
