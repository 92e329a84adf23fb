// SGP4: the state at a time, stage by stage. Sources H, V, S as in sgp4_model.h.

#include "sgp4_model.h"

#include <algorithm>
#include <cmath>

namespace umov {

namespace sgp4 {

namespace {

/// Mean elements at a time with the semi-major axis [Earth radii].
struct Drifted {
  MeanElements mean;
  double axis_factor = 1; ///< by drag, on the square root of the axis
  double eccentricity_loss = 0;
  double longitude_gain = 0; ///< by drag, over the mean motion
};

/// Secular gravity and drag (H section 6, "secular effects").
Drifted near_earth_secular(const Constants &c, double t) {
  const DragTerms &d = c.drag;
  const double t2 = t * t;
  Drifted out;
  MeanElements &m = out.mean;
  m = c.epoch;
  m.anomaly += c.rates.anomaly * t;
  m.perigee += c.rates.perigee * t;
  m.node += c.rates.node * t + d.node_t2 * t2;
  out.axis_factor = 1 - d.c1 * t;
  out.eccentricity_loss = d.bstar * d.c4 * t;
  out.longitude_gain = d.l2 * t2;
  if (d.is_simple)
    return out;
  const double swing = 1 + d.eta * std::cos(m.anomaly);
  const double shift =
      d.perigee_t * t + d.anomaly_factor * (swing * swing * swing - d.anomaly_offset);
  m.anomaly += shift;
  m.perigee -= shift;
  const double t3 = t2 * t, t4 = t3 * t;
  out.axis_factor -= d.d2 * t2 + d.d3 * t3 + d.d4 * t4;
  out.eccentricity_loss += d.bstar * d.c5 * (std::sin(m.anomaly) - d.sine_anomaly0);
  out.longitude_gain += d.l3 * t3 + t4 * (d.l4 + t * d.l5);
  return out;
}

/// Applies drag to the axis and the longitude and brings the angles into one turn.
Sgp4Code apply_drag(const Constants &c, Drifted &drifted, double &axis) {
  MeanElements &m = drifted.mean;
  if (!(m.motion > 0))
    return Sgp4Code::MeanMotion;
  axis = std::pow(gravity_rate() / m.motion, 2.0 / 3.0) * drifted.axis_factor * drifted.axis_factor;
  m.motion = gravity_rate() / std::pow(axis, 1.5);
  m.eccentricity -= drifted.eccentricity_loss;
  if (!(m.eccentricity < 1 && m.eccentricity >= -0.001))
    return Sgp4Code::Eccentricity;
  m.eccentricity = std::max(m.eccentricity, 1e-6);
  m.anomaly += c.epoch.motion * drifted.longitude_gain;
  const double longitude = std::fmod(m.anomaly + m.perigee + m.node, two_pi);
  m.node = std::fmod(m.node, two_pi);
  m.perigee = std::fmod(m.perigee, two_pi);
  m.anomaly = std::fmod(longitude - m.perigee - m.node, two_pi);
  return Sgp4Code::Ok;
}

/// Orbit after the long-period terms, in nonsingular form.
struct Nonsingular {
  double ex = 0, ey = 0; ///< e cos(omega), e sin(omega)
  double longitude = 0;  ///< mean longitude from the node
};

Nonsingular long_period_periodics(const MeanElements &m, double axis, const InclinationTerms &inc) {
  Nonsingular out;
  const double e = m.eccentricity;
  const double inverse_p = 1 / (axis * (1 - e * e));
  out.ex = e * std::cos(m.perigee);
  out.ey = e * std::sin(m.perigee) + inverse_p * inc.long_period_y;
  out.longitude = std::fmod(m.anomaly + m.perigee + inverse_p * inc.long_period_l * out.ex, two_pi);
  return out;
}

struct SineCosine {
  double sine = 0, cosine = 1;
};

/// Kepler's equation for E + omega by Newton's method, its step held to 0.95 rad (V).
SineCosine solve_kepler(const Nonsingular &o) {
  double angle = o.longitude;
  SineCosine out;
  double step = 1;
  for (int i = 0; i < 10 && std::abs(step) >= 1e-12; ++i) {
    out = {std::sin(angle), std::cos(angle)};
    const double slope = 1 - out.cosine * o.ex - out.sine * o.ey;
    step = (o.longitude - o.ey * out.cosine + o.ex * out.sine - angle) / slope;
    if (std::abs(step) >= 0.95)
      step = step > 0 ? 0.95 : -0.95;
    angle += step;
  }
  return out;
}

/// Position in the orbit and the orbit's orientation.
struct Osculating {
  double radius = 0, radius_rate = 0, transverse_rate = 0;
  double latitude_argument = 0, node = 0, inclination = 0;
};

/// Preliminary quantities and short-period J2 terms (H section 6, last blocks).
Sgp4Code short_periodics(const MeanElements &m, double axis, const Nonsingular &o, SineCosine e,
                         const InclinationTerms &inc, Osculating &out) {
  const double e_cos = o.ex * e.cosine + o.ey * e.sine;
  const double e_sin = o.ex * e.sine - o.ey * e.cosine;
  const double e2 = o.ex * o.ex + o.ey * o.ey;
  const double p = axis * (1 - e2);
  if (!(p >= 0))
    return Sgp4Code::SemiLatusRectum;
  const double radius = axis * (1 - e_cos), beta = std::sqrt(1 - e2);
  const double mix = e_sin / (1 + beta);
  const double sin_u = axis / radius * (e.sine - o.ey - o.ex * mix);
  const double cos_u = axis / radius * (e.cosine - o.ex + o.ey * mix);
  const double sin_2u = 2 * cos_u * sin_u, cos_2u = 1 - 2 * sin_u * sin_u;
  const double j2_p = 0.5 * j2 / p, j2_p2 = j2_p / p;
  const double motion = m.motion / gravity_rate();
  out.radius = radius * (1 - 1.5 * j2_p2 * beta * inc.three_cos2_minus_1) +
               0.5 * j2_p * inc.one_minus_cos2 * cos_2u;
  out.latitude_argument = std::atan2(sin_u, cos_u) - 0.25 * j2_p2 * inc.seven_cos2_minus_1 * sin_2u;
  out.node = m.node + 1.5 * j2_p2 * inc.cosine * sin_2u;
  out.inclination = m.inclination + 1.5 * j2_p2 * inc.cosine * inc.sine * cos_2u;
  out.radius_rate = std::sqrt(axis) * e_sin / radius - motion * j2_p * inc.one_minus_cos2 * sin_2u;
  out.transverse_rate =
      std::sqrt(p) / radius +
      motion * j2_p * (inc.one_minus_cos2 * cos_2u + 1.5 * inc.three_cos2_minus_1);
  return Sgp4Code::Ok;
}

TemeState to_state(const Osculating &o) {
  const double su = std::sin(o.latitude_argument), cu = std::cos(o.latitude_argument);
  const double sn = std::sin(o.node), cn = std::cos(o.node);
  const double si = std::sin(o.inclination), ci = std::cos(o.inclination);
  const Vec3<Teme> along{-sn * ci * su + cn * cu, cn * ci * su + sn * cu, si * su};
  const Vec3<Teme> across{-sn * ci * cu - cn * su, cn * ci * cu - sn * su, si * cu};
  const double km_s = earth_radius_km * gravity_rate() / 60;
  return {along * (o.radius * earth_radius_km),
          (along * o.radius_rate + across * o.transverse_rate) * km_s};
}

} // namespace

Sgp4Code state_at(const Constants &c, double minutes, TemeState &state) {
  Drifted drifted = near_earth_secular(c, minutes);
  if (c.deep)
    deep_space_secular(c, minutes, drifted.mean);
  double axis = 0;
  if (const Sgp4Code code = apply_drag(c, drifted, axis); code != Sgp4Code::Ok)
    return code;
  MeanElements &m = drifted.mean;
  InclinationTerms inc = c.inclination;
  if (c.deep) {
    deep_space_periodics(*c.deep, minutes, m);
    if (!(m.eccentricity >= 0 && m.eccentricity <= 1))
      return Sgp4Code::PerturbedEccentricity;
    inc = inclination_terms(m.inclination);
  }
  const Nonsingular orbit = long_period_periodics(m, axis, inc);
  Osculating osculating;
  if (const Sgp4Code code = short_periodics(m, axis, orbit, solve_kepler(orbit), inc, osculating);
      code != Sgp4Code::Ok)
    return code;
  if (!(osculating.radius >= 1))
    return Sgp4Code::Decayed;
  state = to_state(osculating);
  return Sgp4Code::Ok;
}

} // namespace sgp4

struct Sgp4::Model {
  sgp4::Constants constants;
};

const char *to_text(Sgp4Code code) {
  switch (code) {
  case Sgp4Code::Ok:
    return "no error";
  case Sgp4Code::Eccentricity:
    return "the mean eccentricity left the range 0 to 1";
  case Sgp4Code::MeanMotion:
    return "the mean motion is not positive";
  case Sgp4Code::PerturbedEccentricity:
    return "the eccentricity perturbed by Sun and Moon left the range 0 to 1";
  case Sgp4Code::SemiLatusRectum:
    return "the semi-latus rectum is negative";
  case Sgp4Code::SubOrbital:
    return "the elements are sub-orbital";
  case Sgp4Code::Decayed:
    return "the object has decayed: it would be below the Earth's surface";
  case Sgp4Code::OutOfRange:
    return "the time is not a number or more than 190 years from the epoch";
  }
  return "unknown code";
}

Sgp4::Sgp4(const ElementSet &elements) {
  auto model = std::make_shared<Model>();
  model->constants = sgp4::initialise(elements);
  model_ = std::move(model);
}

Sgp4Code Sgp4::init_code() const { return model_->constants.code; }

bool Sgp4::is_deep_space() const { return model_->constants.deep.has_value(); }

Sgp4Code Sgp4::propagate(double minutes, TemeState &state) const {
  state = {};
  if (!model_->constants.is_usable)
    return model_->constants.code;
  constexpr double limit_minutes = 1e8; // bounds the half-day steps of a resonant orbit
  if (!(std::abs(minutes) <= limit_minutes))
    return Sgp4Code::OutOfRange;
  return sgp4::state_at(model_->constants, minutes, state);
}

} // namespace umov
