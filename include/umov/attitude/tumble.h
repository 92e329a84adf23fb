#pragma once
// Torque-free motion of a rigid body in closed form.

#include <umov/core/result.h>
#include <umov/core/rotation.h>
#include <umov/shape/mass.h>

namespace umov {

/// Euler's free top by Jacobi's elliptic functions and the elliptic integral of the third kind
/// (Landau & Lifshitz 1976, section 37), so that energy and angular momentum are kept however long
/// it turns. See docs/theory/attitude.md.
class TorqueFreeMotion {
public:
  /// Angular velocity at time 0 in body axes [rad/s]. BadInput for an inertia that no body has, or
  /// numbers that are not finite.
  static Result<TorqueFreeMotion> make(const Inertia &inertia, Vec3<Body> rate_rad_s);

  /// Angular velocity in body axes [rad/s].
  [[nodiscard]] Vec3<Body> rate_at(double seconds) const;
  /// Components in the body at `seconds` from those in the body at time 0.
  [[nodiscard]] Rotation<Body, Body> turned(double seconds) const;
  /// Period of the angular velocity in the body [s]; infinite where it stands still there.
  [[nodiscard]] double body_period_s() const;
  /// No angular velocity is larger [rad/s].
  [[nodiscard]] double rate_bound_rad_s() const;
  /// Mean rate at which the body goes around its angular momentum [rad/s].
  [[nodiscard]] double precession_rate_rad_s() const;

private:
  struct Phase {
    double sn, cn, dn;
    double amplitude; ///< am(u), continuous
  };
  [[nodiscard]] Phase phase_at(double seconds) const;
  /// Angle of the node line about the angular momentum [rad], up to a constant.
  [[nodiscard]] double node_at(double seconds, const Phase &phase) const;
  /// Principal axes (in the order of the theory) from axes along the angular momentum.
  [[nodiscard]] Rotation<Body, Body> from_momentum(double seconds) const;

  bool is_steady_ = false;           ///< spins about an axis fixed in the body
  Vec3<Body> steady_rate_{};         ///< then
  Rotation<Body, Body> principal_{}; ///< principal from body axes
  double i1_ = 1, i2_ = 1, i3_ = 1, momentum_ = 0;
  double a1_ = 0, a2_ = 0, a3_ = 0; ///< amplitudes of the angular velocity, signed
  double ratio1_ = 1, ratio2_ = 1;  ///< I1 a1 : I2 a2, also where both vanish
  double k_ = 0, quarter_ = 0, frequency_ = 0, start_ = 0, third_ = 0, node_scale_ = 0;
  Rotation<Body, Body> start_from_momentum_{};
};

} // namespace umov
