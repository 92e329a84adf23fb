#pragma once
// Private: small changes of a turning, as fits and samples make them.

#include <Eigen/Core>
#include <umov/inverse/curve_model.h>
#include <vector>

namespace umov::inverse {

/// A step in the unknowns. Of an attitude: its rotation vector in body axes [rad]. Of a spin, in
/// body axes, u its axis: first a vector that tilts the spin axis among the stars (across u) and
/// turns the body about it (along u) [rad]; then one that tilts the body against the spin, so that
/// another axis of it is the spin's (across u) [rad], and changes the rate (along u), in units that
/// turn the body by one radian more over the span of the epochs.
///
/// What each of these does to the light knows nothing of the others, so that valleys of chi-square
/// are straight in them. A change of the rate vector at a fixed attitude would be a step of a
/// hundred radians for a tilt of a degree after a thousand turns, along a path that bends.
using Step = Eigen::Matrix<double, Eigen::Dynamic, 1>;

/// The same vector.
inline Eigen::Vector3d eigen_of(const Vec3<Body> &v) { return {v.x, v.y, v.z}; }

/// A turning after a step. A body that turns by less than a radian over the span has no axis to
/// speak of: its last three numbers are the change of the rate vector times the span.
Turning stepped(const Turning &from, const Step &step, double span_s);
/// The shortest step, of 3 or 6 numbers, that leads from one to the other: that of `stepped` where
/// its tilts and its turn are less than pi and the rate keeps its sense.
Step step_between(const Turning &from, const Turning &to, Eigen::Index size, double span_s);
/// ln of the volume of attitudes, and of rates in radians per span, that a volume of steps has
/// where a step leads to.
double log_volume(const Turning &from, const Step &step, double span_s);
/// A covariance of steps about a turning as one of its rotation vector [rad] and rate [rad/s] in
/// body axes, row-major; and back.
std::vector<double> out_of_steps(const Eigen::MatrixXd &covariance, const Turning &about,
                                 double span_s);
Eigen::MatrixXd in_steps(const std::vector<double> &covariance, const Turning &about,
                         double span_s);

} // namespace umov::inverse
