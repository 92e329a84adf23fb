#include <umov/attitude/tumble.h>

#include <boost/math/special_functions/ellint_1.hpp>
#include <boost/math/special_functions/ellint_3.hpp>
#include <boost/math/special_functions/jacobi_elliptic.hpp>
#include <cmath>
#include <limits>
#include <umov/core/quantity.h>

namespace umov {
namespace {

/// Components in axes turned by `angle` about axis 0 (x) or 2 (z).
Rotation<Body, Body> turned_about(int axis, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  if (axis == 0)
    return {Vec3<Body>{1, 0, 0}, {0, c, s}, {0, -s, c}};
  return {Vec3<Body>{c, s, 0}, {-s, c, 0}, {0, 0, 1}};
}

} // namespace

Result<TorqueFreeMotion> TorqueFreeMotion::make(const Inertia &inertia, Vec3<Body> rate) {
  UMOV_ASSIGN(axes, principal_axes(inertia));
  if (!std::isfinite(norm(rate)))
    return fail(ErrorCode::BadInput, "the angular velocity is not finite");
  TorqueFreeMotion m;
  m.principal_ = {axes.axis[0], axes.axis[1], axes.axis[2]};
  double moment[3] = {axes.moment[0], axes.moment[1], axes.moment[2]};
  Vec3<Body> w = m.principal_ * rate;
  const double energy2 =
      moment[0] * w.x * w.x + moment[1] * w.y * w.y + moment[2] * w.z * w.z; // twice the energy
  const double momentum2 =
      std::pow(moment[0] * w.x, 2) + std::pow(moment[1] * w.y, 2) + std::pow(moment[2] * w.z, 2);
  // The motion goes around the axis of the largest moment, or of the smallest.
  if (momentum2 < energy2 * moment[1]) {
    m.principal_ = {axes.axis[2], axes.axis[1], -axes.axis[0]};
    std::swap(moment[0], moment[2]);
    w = m.principal_ * rate;
  }
  m.i1_ = moment[0];
  m.i2_ = moment[1];
  m.i3_ = moment[2];
  m.momentum_ = std::sqrt(momentum2);
  // A sphere, a body at rest, and a top whose distinguished axis is the other one.
  constexpr double same = 1e-14;
  // About the middle axis alone: an equilibrium, if an unstable one.
  const bool is_middle = std::max(std::abs(w.x), std::abs(w.z)) <= 1e-12 * std::abs(w.y);
  if (!(norm(rate) > 0) || is_middle || std::abs(m.i3_ - m.i2_) <= same * m.i3_ ||
      std::abs(m.i3_ - m.i1_) <= same * m.i3_) {
    m.is_steady_ = true;
    m.steady_rate_ = rate;
    return m;
  }
  // In terms of the start's components, which keeps the digits that L^2 - 2 E I would lose.
  const double d12 = m.i1_ * (m.i3_ - m.i1_), d22 = m.i2_ * (m.i3_ - m.i2_);
  const double low = d12 * w.x * w.x + d22 * w.y * w.y; // 2 E I3 - L^2
  const double high =
      m.i2_ * (m.i2_ - m.i1_) * w.y * w.y + m.i3_ * (m.i3_ - m.i1_) * w.z * w.z; // L^2 - 2 E I1
  const double side = m.i3_ > m.i2_ ? 1 : -1, sense = w.z < 0 ? -1 : 1;
  m.a1_ = std::sqrt(std::max(0.0, low / d12));
  m.a2_ = sense * side * std::sqrt(std::max(0.0, low / d22));
  m.a3_ = sense * std::sqrt(high / (m.i3_ * (m.i3_ - m.i1_)));
  m.ratio1_ = m.i1_ / std::sqrt(std::abs(d12));
  m.ratio2_ = sense * side * m.i2_ / std::sqrt(std::abs(d22));
  m.frequency_ = std::sqrt((m.i3_ - m.i2_) * high / (m.i1_ * m.i2_ * m.i3_));
  // On the separatrix the period is infinite and no double can say on which side one is.
  m.k_ = std::sqrt(
      std::min(1 - 1e-14, std::max(0.0, (m.i2_ - m.i1_) * low / ((m.i3_ - m.i2_) * high))));
  m.quarter_ = boost::math::ellint_1(m.k_);
  m.third_ = -m.i3_ * (m.i2_ - m.i1_) / (m.i1_ * (m.i3_ - m.i2_));
  m.node_scale_ = m.momentum_ * (m.i3_ - m.i1_) / (m.i1_ * m.i3_ * m.frequency_);
  if (m.a1_ > 0 || m.a2_ != 0)
    m.start_ = boost::math::ellint_1(m.k_, std::atan2(w.y / m.a2_, w.x / m.a1_));
  m.start_from_momentum_ = m.from_momentum(0);
  return m;
}

TorqueFreeMotion::Phase TorqueFreeMotion::phase_at(double seconds) const {
  const double u = start_ + frequency_ * seconds;
  const double turns = std::round(u / (4 * quarter_));
  Phase out{};
  out.sn = boost::math::jacobi_elliptic(k_, u - turns * 4 * quarter_, &out.cn, &out.dn);
  out.amplitude = std::atan2(out.sn, out.cn) + 2 * pi * turns;
  return out;
}

// phi' = L/I3 + L (I3 - I1)/(I1 I3) / (1 - n sn^2), n = -I3 (I2 - I1)/(I1 (I3 - I2)): the poles of
// Landau & Lifshitz's form at a steady spin cancel.
double TorqueFreeMotion::node_at(double seconds, const Phase &phase) const {
  return momentum_ / i3_ * seconds +
         node_scale_ * boost::math::ellint_3(k_, third_, phase.amplitude);
}

Rotation<Body, Body> TorqueFreeMotion::from_momentum(double seconds) const {
  const Phase phase = phase_at(seconds);
  const double cosine = std::min(1.0, std::max(-1.0, i3_ * a3_ * phase.dn / momentum_));
  const double sine =
      std::hypot(i1_ * a1_ * phase.cn, i2_ * a2_ * phase.sn) / momentum_; // exact near the pole
  const double psi = std::atan2(ratio1_ * phase.cn, ratio2_ * phase.sn);
  return turned_about(2, psi) * turned_about(0, std::atan2(sine, cosine)) *
         turned_about(2, node_at(seconds, phase));
}

Vec3<Body> TorqueFreeMotion::rate_at(double seconds) const {
  if (is_steady_)
    return steady_rate_;
  const Phase phase = phase_at(seconds);
  return principal_.inverse() * Vec3<Body>{a1_ * phase.cn, a2_ * phase.sn, a3_ * phase.dn};
}

Rotation<Body, Body> TorqueFreeMotion::turned(double seconds) const {
  if (is_steady_) {
    const double rate = norm(steady_rate_);
    if (!(rate > 0))
      return {};
    const double turns = rate * seconds / (2 * pi), angle = pi * (turns - std::round(turns));
    const Vec3<Body> axis = steady_rate_ / rate * std::sin(angle);
    return rotation_from<Body, Body>({std::cos(angle), axis.x, axis.y, axis.z});
  }
  return principal_.inverse() *
         (from_momentum(seconds) * (start_from_momentum_.inverse() * principal_));
}

double TorqueFreeMotion::body_period_s() const {
  return is_steady_ || a1_ == 0 ? std::numeric_limits<double>::infinity()
                                : 4 * quarter_ / frequency_;
}

double TorqueFreeMotion::rate_bound_rad_s() const {
  return is_steady_ ? norm(steady_rate_) : norm(Vec3<Body>{a1_, a2_, a3_});
}

double TorqueFreeMotion::precession_rate_rad_s() const {
  if (is_steady_)
    return norm(steady_rate_);
  const double quarter_turn = node_scale_ * boost::math::ellint_3(k_, third_);
  return momentum_ / i3_ + quarter_turn / quarter_ * frequency_;
}

} // namespace umov
