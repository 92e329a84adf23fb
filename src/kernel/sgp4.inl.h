// SGP4 and SDP4: the state of an object at a time, stage by stage. Sources H, V, S as in
// sgp4_numbers.h. R is double, double lanes, which give the
// same bits, or a dual number.
#if defined(UMOV_KERNEL_SGP4_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef UMOV_KERNEL_SGP4_INL_H
#undef UMOV_KERNEL_SGP4_INL_H
#else
#define UMOV_KERNEL_SGP4_INL_H
#endif

#include "kernel/angles.inl.h"
#include "kernel/sgp4_numbers.h"

#include "kernel/begin.h"

/// TEME [km, km/s] and the code of the reference implementation, 0 = fine.
template <class R> struct Sgp4State { R x, y, z, vx, vy, vz, code; };

/// The first condition that fails names the code.
template <class R, class M> UMOV_KERNEL void require(M holds, double number, R &code) {
  code = select(holds | (code > R(0.5)), code, R(number));
}

template <class R> UMOV_KERNEL InclinationTerms<R> inclination_terms(R inclination) {
  const SineCosine<R> i = sine_cosine(inclination);
  const R c2 = i.cosine * i.cosine;
  // The J3 term of the longitude is singular at 180 deg; the reference holds the divisor at
  // 1.5e-12 there (V).
  const R plus = R(1) + i.cosine;
  const R divisor = select(abs(plus) > R(1.5e-12), plus, R(1.5e-12));
  return {i.sine,
          i.cosine,
          R(3) * c2 - R(1),
          R(1) - c2,
          R(7) * c2 - R(1),
          R(-0.5 * sgp4_j3_over_j2) * i.sine,
          R(-0.25 * sgp4_j3_over_j2) * i.sine * (R(3) + R(5) * i.cosine) / divisor};
}

// --- resonance with the Earth's tesseral harmonics (H section 7; V) ---------------------------

template <class R> struct ResonanceDerivatives { R angle_rate, motion_rate, motion_second; };

UMOV_KERNEL std::size_t harmonic_count(Resonance kind) {
  return kind == Resonance::OneDay ? 3 : resonance_terms_max;
}
UMOV_KERNEL ResonanceHarmonic resonance_harmonic(Resonance kind, std::size_t i) {
  static constexpr ResonanceHarmonic one_day[] = {
      {0, 1, 0.13130908}, {0, 2, 2 * 2.8843198}, {0, 3, 3 * 0.37448087}};
  static constexpr ResonanceHarmonic half_day[] = {
      {2, 1, 5.7686396}, {0, 1, 5.7686396}, {1, 1, 0.95240898}, {-1, 1, 0.95240898},
      {2, 2, 1.8014998}, {0, 2, 1.8014998}, {1, 1, 1.0508330},  {-1, 1, 1.0508330},
      {1, 2, 4.4108898}, {-1, 2, 4.4108898}};
  return kind == Resonance::OneDay ? one_day[i] : half_day[i];
}

template <class R>
UMOV_KERNEL ResonanceDerivatives<R> resonance_derivatives(Resonance kind, const Sgp4Numbers<R> &c,
                                                          const ResonanceNode<R> &at) {
  // One-day terms do not hold the perigee.
  const R perigee = c.epoch.perigee + c.rates.perigee * at.minutes;
  ResonanceDerivatives<R> d{at.motion + c.resonance.rate0, R(0), R(0)};
  for (std::size_t i = 0; i < harmonic_count(kind); ++i) {
    const ResonanceHarmonic h = resonance_harmonic(kind, i);
    const SineCosine<R> wave =
        sine_cosine(R(h.perigee_multiple) * perigee + R(h.angle_multiple) * at.angle - R(h.phase));
    const R amplitude = c.resonance.amplitude[i];
    d.motion_rate = d.motion_rate + amplitude * wave.sine;
    d.motion_second = d.motion_second + R(h.angle_multiple) * amplitude * wave.cosine;
  }
  d.motion_second = d.motion_second * d.angle_rate;
  return d;
}

/// A Taylor step (Euler-Maclaurin) of the resonance angle and motion.
template <class R>
UMOV_KERNEL ResonanceNode<R> resonance_step(Resonance kind, const Sgp4Numbers<R> &c,
                                            const ResonanceNode<R> &at, R step) {
  const ResonanceDerivatives<R> d = resonance_derivatives(kind, c, at);
  const R half_square = step * step * R(0.5);
  return {at.minutes + step, at.angle + d.angle_rate * step + d.motion_rate * half_square,
          at.motion + d.motion_rate * step + d.motion_second * half_square};
}

// --- mean elements at a time -------------------------------------------------------------------

/// Mean elements with what drag does to them.
template <class R> struct Drifted {
  MeanElements<R> mean;
  R axis_factor; ///< by drag, on the square root of the axis
  R eccentricity_loss;
  R longitude_gain; ///< by drag, over the mean motion
};

/// Secular gravity and drag (H section 6, "secular effects").
template <class R>
UMOV_KERNEL Drifted<R> secular(const Sgp4Kind &kind, const Sgp4Numbers<R> &c, R t) {
  const DragTerms<R> &d = c.drag;
  const R t2 = t * t;
  Drifted<R> out;
  MeanElements<R> &m = out.mean;
  m = c.epoch;
  m.anomaly = m.anomaly + c.rates.anomaly * t;
  m.perigee = m.perigee + c.rates.perigee * t;
  m.node = m.node + c.rates.node * t + d.node_t2 * t2;
  out.axis_factor = R(1) - d.c1 * t;
  out.eccentricity_loss = d.bstar * d.c4 * t;
  out.longitude_gain = d.l2 * t2;
  if (kind.is_simple)
    return out;
  const R swing = R(1) + d.eta * sine_cosine(m.anomaly).cosine;
  const R shift = d.perigee_t * t + d.anomaly_factor * (swing * swing * swing - d.anomaly_offset);
  m.anomaly = m.anomaly + shift;
  m.perigee = m.perigee - shift;
  const R t3 = t2 * t, t4 = t3 * t;
  out.axis_factor = out.axis_factor - (d.d2 * t2 + d.d3 * t3 + d.d4 * t4);
  out.eccentricity_loss =
      out.eccentricity_loss + d.bstar * d.c5 * (sine_cosine(m.anomaly).sine - d.sine_anomaly0);
  out.longitude_gain = out.longitude_gain + (d.l3 * t3 + t4 * (d.l4 + t * d.l5));
  return out;
}

/// Lunar-solar secular rates, and the resonance from its `node` on.
template <class R>
UMOV_KERNEL void deep_space_secular(const Sgp4Kind &kind, const Sgp4Numbers<R> &c,
                                    const ResonanceNode<R> &node, R t, MeanElements<R> &m) {
  m.eccentricity = m.eccentricity + c.third.eccentricity * t;
  m.inclination = m.inclination + c.third.inclination * t;
  m.perigee = m.perigee + c.third.perigee * t;
  m.node = m.node + c.third.node * t;
  m.anomaly = m.anomaly + c.third.anomaly * t;
  if (kind.resonance == Resonance::None)
    return;
  const R earth_rate = R(4.37526908801129966e-3); // sidereal [rad/min] (V)
  const R theta = within_turn(c.greenwich + t * earth_rate);
  const ResonanceNode<R> at = resonance_step(kind.resonance, c, node, t - node.minutes);
  m.motion = at.motion;
  m.anomaly = kind.resonance == Resonance::HalfDay ? at.angle - R(2) * m.node + R(2) * theta
                                                   : at.angle - m.node - m.perigee + theta;
}

/// x^(2/3) for x > 0, near 1 by nature: Newton's method for the cube root.
template <class R> UMOV_KERNEL R two_thirds_power(R x) {
  R y = R(1) + (x - R(1)) * R(1.0 / 3.0);
  R step = R(1);
  for (int i = 0; i < 60; ++i) {
    const auto is_active = abs(step) > R(1e-14) * abs(y);
    if (!any(is_active))
      break;
    step = select(is_active, (y - x / (y * y)) * R(1.0 / 3.0), step);
    y = select(is_active, y - step, y);
  }
  return y * y;
}

/// Applies drag to the axis [Earth radii] and the longitude and brings the angles into one turn.
template <class R>
UMOV_KERNEL void apply_drag(const Sgp4Kind &kind, const Sgp4Numbers<R> &c, Drifted<R> &drifted,
                            R &axis, R &code) {
  MeanElements<R> &m = drifted.mean;
  require(m.motion > R(0), 2, code);
  R axis0 = c.axis0;
  if (kind.resonance != Resonance::None) {
    const auto is_moving = m.motion > R(0);
    axis0 = axis0 * two_thirds_power(select(is_moving, c.epoch.motion / m.motion, R(1)));
  }
  axis = axis0 * drifted.axis_factor * drifted.axis_factor;
  m.motion = R(sgp4_gravity_rate) / (axis * sqrt(axis));
  m.eccentricity = m.eccentricity - drifted.eccentricity_loss;
  require((m.eccentricity < R(1)) & (m.eccentricity >= R(-0.001)), 1, code);
  m.eccentricity = max(m.eccentricity, R(1e-6));
  m.anomaly = m.anomaly + c.epoch.motion * drifted.longitude_gain;
  const R longitude = within_turn(m.anomaly + m.perigee + m.node);
  m.node = rest_of_turn(m.node); // Lyddane's form depends on the turn it is in
  m.perigee = within_turn(m.perigee);
  m.anomaly = within_turn(longitude - m.perigee - m.node);
}

// --- periodic perturbations by Sun and Moon (H section 7, DPPER; V) ------------------------------

template <class R> struct LunarSolar { R eccentricity, inclination, longitude, perigee, node; };

/// Adds one body's terms; `perigee` and `node` are still multiplied by sin i.
template <class R>
UMOV_KERNEL void add_third_body(const ThirdBodyPeriodics<R> &b, R t, LunarSolar<R> &sum) {
  const R mean = b.anomaly0 + b.rate * t;
  const R anomaly = mean + R(2) * b.eccentricity * sine_cosine(mean).sine;
  const SineCosine<R> a = sine_cosine(anomaly);
  const R f2 = R(0.5) * a.sine * a.sine - R(0.25);
  const R f3 = R(-0.5) * a.sine * a.cosine;
  sum.eccentricity = sum.eccentricity + b.e2 * f2 + b.e3 * f3;
  sum.inclination = sum.inclination + b.i2 * f2 + b.i3 * f3;
  sum.longitude = sum.longitude + b.l2 * f2 + b.l3 * f3 + b.l4 * a.sine;
  sum.perigee = sum.perigee + b.gh2 * f2 + b.gh3 * f3 + b.gh4 * a.sine;
  sum.node = sum.node + b.h2 * f2 + b.h3 * f3;
}

/// Lyddane's form for small inclinations: node and inclination as a vector.
template <class R>
UMOV_KERNEL MeanElements<R> with_lyddane(const LunarSolar<R> &p, MeanElements<R> m) {
  const SineCosine<R> i = sine_cosine(m.inclination), n = sine_cosine(m.node);
  const R x = i.sine * n.sine + p.node * n.cosine + p.inclination * i.cosine * n.sine;
  const R y = i.sine * n.cosine - p.node * n.sine + p.inclination * i.cosine * n.cosine;
  const R old_node = m.node;
  const R longitude = m.anomaly + m.perigee + i.cosine * old_node + p.longitude + p.perigee -
                      p.inclination * old_node * i.sine;
  const R node = arc_tangent(x, y);
  const R turn = select(node < old_node, R(two_pi), R(-two_pi));
  m.node = select(abs(old_node - node) > R(two_pi / 2), node + turn, node);
  m.anomaly = m.anomaly + p.longitude;
  m.perigee = longitude - m.anomaly - i.cosine * m.node;
  return m;
}

template <class R>
UMOV_KERNEL void deep_space_periodics(const Sgp4Numbers<R> &c, R t, MeanElements<R> &m) {
  LunarSolar<R> p{R(0), R(0), R(0), R(0), R(0)};
  add_third_body(c.sun, t, p);
  add_third_body(c.moon, t, p);
  m.inclination = m.inclination + p.inclination;
  m.eccentricity = m.eccentricity + p.eccentricity;
  const auto is_steep = m.inclination >= R(0.2);
  const SineCosine<R> i = sine_cosine(m.inclination);
  const R node = p.node / select(is_steep, i.sine, R(1));
  MeanElements<R> steep = m;
  steep.perigee = m.perigee + (p.perigee - i.cosine * node);
  steep.node = m.node + node;
  steep.anomaly = m.anomaly + p.longitude;
  if (any(m.inclination < R(0.2))) {
    const MeanElements<R> flat = with_lyddane(p, m);
    steep.perigee = select(is_steep, steep.perigee, flat.perigee);
    steep.node = select(is_steep, steep.node, flat.node);
    steep.anomaly = select(is_steep, steep.anomaly, flat.anomaly);
  }
  m = steep;
  // The same plane, written with a positive inclination.
  const auto is_below = m.inclination < R(0);
  m.inclination = abs(m.inclination);
  m.node = select(is_below, m.node + R(two_pi / 2), m.node);
  m.perigee = select(is_below, m.perigee - R(two_pi / 2), m.perigee);
}

// --- from mean elements to a state ---------------------------------------------------------------

/// Orbit after the long-period terms, in nonsingular form.
template <class R> struct Nonsingular {
  R ex, ey;    ///< e cos(omega), e sin(omega)
  R longitude; ///< mean longitude from the node
};

template <class R>
UMOV_KERNEL Nonsingular<R> long_period_periodics(const MeanElements<R> &m, R axis,
                                                 const InclinationTerms<R> &inc) {
  const R e = m.eccentricity;
  const R inverse_p = R(1) / (axis * (R(1) - e * e));
  const SineCosine<R> omega = sine_cosine(m.perigee);
  Nonsingular<R> out;
  out.ex = e * omega.cosine;
  out.ey = e * omega.sine + inverse_p * inc.long_period_y;
  out.longitude = within_turn(m.anomaly + m.perigee + inverse_p * inc.long_period_l * out.ex);
  return out;
}

/// Kepler's equation for E + omega by Newton's method, its step held to 0.95 rad (V). Returns the
/// sine and cosine that the last step was made from.
template <class R> UMOV_KERNEL SineCosine<R> solve_kepler(const Nonsingular<R> &o) {
  R angle = o.longitude, step = R(1);
  SineCosine<R> out{R(0), R(1)};
  for (int i = 0; i < 10; ++i) {
    const auto is_active = abs(step) >= R(1e-12);
    if (!any(is_active))
      break;
    const SineCosine<R> now = sine_cosine(angle);
    const R slope = R(1) - now.cosine * o.ex - now.sine * o.ey;
    const R full = (o.longitude - o.ey * now.cosine + o.ex * now.sine - angle) / slope;
    const R held = min(max(full, R(-0.95)), R(0.95));
    // Lanes that are done keep their values, whatever their neighbours still need.
    out.sine = select(is_active, now.sine, out.sine);
    out.cosine = select(is_active, now.cosine, out.cosine);
    step = select(is_active, held, step);
    angle = select(is_active, angle + held, angle);
  }
  return out;
}

/// Position in the orbit and the orbit's orientation.
template <class R> struct Osculating {
  R radius, radius_rate, transverse_rate;
  SineCosine<R> latitude_argument;
  R node, inclination;
};

/// Preliminary quantities and short-period J2 terms (H section 6, last blocks).
template <class R>
UMOV_KERNEL Osculating<R> short_periodics(const MeanElements<R> &m, R axis, const Nonsingular<R> &o,
                                          const SineCosine<R> &e, const InclinationTerms<R> &inc,
                                          R &code) {
  const R e_cos = o.ex * e.cosine + o.ey * e.sine;
  const R e_sin = o.ex * e.sine - o.ey * e.cosine;
  const R e2 = o.ex * o.ex + o.ey * o.ey;
  const R p = axis * (R(1) - e2);
  require(p >= R(0), 4, code);
  const R radius = axis * (R(1) - e_cos), beta = sqrt(max(R(1) - e2, R(0)));
  const R mix = e_sin / (R(1) + beta), per_radius = R(1) / radius;
  const R scale = axis * per_radius;
  const R sin_u = scale * (e.sine - o.ey - o.ex * mix);
  const R cos_u = scale * (e.cosine - o.ex + o.ey * mix);
  const R sin_2u = R(2) * cos_u * sin_u, cos_2u = R(1) - R(2) * sin_u * sin_u;
  const R per_p = R(1) / p;
  const R j2_p = R(0.5 * sgp4_j2) * per_p, j2_p2 = j2_p * per_p;
  const R motion = m.motion * R(1 / sgp4_gravity_rate);
  Osculating<R> out;
  out.radius = radius * (R(1) - R(1.5) * j2_p2 * beta * inc.three_cos2_minus_1) +
               R(0.5) * j2_p * inc.one_minus_cos2 * cos_2u;
  // The argument of latitude enters through its sine and cosine alone: no arc tangent.
  const SineCosine<R> shift = sine_cosine(R(0.25) * j2_p2 * inc.seven_cos2_minus_1 * sin_2u);
  out.latitude_argument = {sin_u * shift.cosine - cos_u * shift.sine,
                           cos_u * shift.cosine + sin_u * shift.sine};
  out.node = m.node + R(1.5) * j2_p2 * inc.cosine * sin_2u;
  out.inclination = m.inclination + R(1.5) * j2_p2 * inc.cosine * inc.sine * cos_2u;
  out.radius_rate = sqrt(axis) * e_sin * per_radius - motion * j2_p * inc.one_minus_cos2 * sin_2u;
  out.transverse_rate =
      sqrt(max(p, R(0))) * per_radius +
      motion * j2_p * (inc.one_minus_cos2 * cos_2u + R(1.5) * inc.three_cos2_minus_1);
  require(out.radius >= R(1), 6, code);
  return out;
}

template <class R> UMOV_KERNEL Sgp4State<R> to_state(const Osculating<R> &o, R code) {
  const SineCosine<R> u = o.latitude_argument, n = sine_cosine(o.node),
                      i = sine_cosine(o.inclination);
  const R sn_ci = n.sine * i.cosine, cn_ci = n.cosine * i.cosine;
  const R ax = n.cosine * u.cosine - sn_ci * u.sine, ay = cn_ci * u.sine + n.sine * u.cosine,
          az = i.sine * u.sine;
  const R bx = -(sn_ci * u.cosine) - n.cosine * u.sine, by = cn_ci * u.cosine - n.sine * u.sine,
          bz = i.sine * u.cosine;
  const R km = o.radius * R(sgp4_earth_radius_km);
  const R km_s = R(sgp4_earth_radius_km * sgp4_gravity_rate / 60);
  const R in = o.radius_rate * km_s, on = o.transverse_rate * km_s;
  return {ax * km, ay * km, az * km, ax * in + bx * on, ay * in + by * on, az * in + bz * on, code};
}

/// State `t` minutes after the epoch. `node`: of the resonance, a whole number of its steps from
/// the epoch and less than one from `t` (unused without resonance). On failure the numbers mean
/// nothing.
template <class R>
UMOV_KERNEL Sgp4State<R> sgp4_state(const Sgp4Kind &kind, const Sgp4Numbers<R> &c,
                                    const ResonanceNode<R> &node, R t) {
  R code = R(0), axis = R(1);
  Drifted<R> drifted = secular(kind, c, t);
  MeanElements<R> &m = drifted.mean;
  if (kind.is_deep)
    deep_space_secular(kind, c, node, t, m);
  apply_drag(kind, c, drifted, axis, code);
  InclinationTerms<R> inc = c.inclination;
  if (kind.is_deep) {
    deep_space_periodics(c, t, m);
    require((m.eccentricity >= R(0)) & (m.eccentricity <= R(1)), 3, code);
    inc = inclination_terms(m.inclination);
  }
  const Nonsingular<R> orbit = long_period_periodics(m, axis, inc);
  const Osculating<R> o = short_periodics(m, axis, orbit, solve_kepler(orbit), inc, code);
  return to_state(o, code);
}

#include "kernel/end.h"
#endif
