#pragma once
// Degree and angle of polarization from q and u with their errors.

#include <array>

namespace umov {

/// Covariance of q and u.
using LinearCovariance = std::array<std::array<double, 2>, 2>;

/// Point values.
struct PolarizationEstimate {
  double p = 0;            ///< biased: never below 0
  double debiased = 0;     ///< "modified asymptotic" of Plaszczynski et al. 2014, MNRAS 439, 4048
  double sd = 0;           ///< of p, along (q, u)
  double across = 0;       ///< standard deviation across (q, u)
  double angle_rad = 0;    ///< of the axis, [0, pi)
  double angle_sd_rad = 0; ///< 68.27 % half width
};
/// Of q and u.
PolarizationEstimate polarization_of(double q, double u, const LinearCovariance &covariance);

/// 68.27 % half width of the angle [rad] for p in units of its error (Naghizadeh-Khouei & Clarke
/// 1993, A&A 274, 968).
double angle_half_width(double p_over_sd);

/// p over its error below which the angle is not known at all.
constexpr double angle_unknown_below = 1.28;
/// Half width of an interval of the angle [rad] that holds the true one in 66 to 70 % of
/// observations whatever the true p, if that is not 0: angle_half_width from `angle_unknown_below`
/// on, a quarter turn, all angles, below. The density alone takes the p that was found for the true
/// one and covers 65 % at a true p of 2 sd, 54 % at 1 sd, 43 % at .5 sd; the limit makes up for it
/// (Neyman's construction, 1937, Phil. Trans. A 236, 333: coverage is integrated over q and u in
/// tools/anchors/observing_reduction.py).
double angle_reach(double p_over_sd);

/// A confidence interval.
struct PolarizationInterval {
  double low = 0, high = 0;
};
/// Of the true degree, for `x` found, both in units of the error of q and u (Feldman & Cousins
/// 1998, Phys. Rev. D 57, 3873, on the Rice distribution): never empty, an upper limit by itself
/// where x is small. Beyond x = 8 the normal interval about the debiased value.
PolarizationInterval degree_interval(double x, double level = 0.95);

/// The error of q and u that `degree_interval` is made with: the root of the mean variance, or of
/// the larger one where, along their axes, they differ by more than a factor of two. The
/// construction takes both as known alike. Orderings on the whole covariance depend on the true
/// angle; with the one that was found in its place 95 % intervals hold the truth in as few as 89 %
/// (variances 1:4) or 86 % (1:9), with the larger error in 94 to 100 % (bench/interval).
double interval_sd(const LinearCovariance &covariance);

} // namespace umov
