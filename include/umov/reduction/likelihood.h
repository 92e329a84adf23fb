#pragma once
// How likely single counts are, down to no electrons at all. Fits and inversions take sets of them
// as normal with the variance of their model, and what moves channels together as a matrix of that:
// `fit_stokes`, `CurveLikelihood`.

namespace umov {

/// Logarithm of the likelihood of one sum of electrons from a mean [e].
/// A Poisson number that was read with a normal error of `read_sd` (the exact sum).
double log_poisson_gauss(double counts, double mean, double read_sd);
/// The same as one Poisson number: counts + read^2 around mean + read^2. Good above a mean of some
/// tens, and without the bias that variances taken from data have.
double log_shifted_poisson(double counts, double mean, double variance);
/// A normal number with the variance of the model.
double log_normal_counts(double counts, double mean, double variance, double excess2 = 1);
/// Output of a multiplying register of a gain, in its electrons, at counts > 0 (Basden, Haniff &
/// Mackay 2003, MNRAS 345, 985); of no output at all exp(-mean).
double log_multiplied(double output, double mean, double gain);
/// At least `limit` electrons: a saturated pixel tells no more.
double log_saturated(double limit, double mean, double variance);

} // namespace umov
