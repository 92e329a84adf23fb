// SDP4: resonance of half-day and one-day orbits with the Earth's tesseral harmonics
// (H section 7; V). The angle is integrated from the epoch on every call, so that a state never
// depends on what was asked before.

#include "sgp4_model.h"

#include <cmath>

namespace umov::sgp4 {

namespace {

constexpr double earth_rate = 4.37526908801129966e-3; // sidereal [rad/min] (V)

// Amplitudes of the harmonics (H section 7).
constexpr double q22 = 1.7891679e-6, q31 = 2.1460748e-6, q33 = 2.2123015e-7;
constexpr double root22 = 1.7891679e-6, root32 = 3.7393792e-7, root44 = 7.3636953e-9,
                 root52 = 1.1428639e-7, root54 = 2.1765803e-9;
// Phases.
constexpr double phase_31 = 0.13130908, phase_22 = 2.8843198, phase_33 = 0.37448087;
constexpr double g22 = 5.7686396, g32 = 0.95240898, g44 = 1.8014998, g52 = 1.0508330,
                 g54 = 4.4108898;

/// c0 + c1 e + c2 e^2 + c3 e^3
double cubic(double e, double c0, double c1, double c2, double c3) {
  return c0 + c1 * e + c2 * (e * e) + c3 * (e * (e * e));
}

/// Eccentricity functions of the half-day resonance, fitted in pieces.
struct EccentricityFunctions {
  double g201, g211, g310, g322, g410, g422, g520, g521, g532, g533;
};

double fitted_g520(double e) {
  if (e <= 0.65)
    return cubic(e, -532.114, 3017.977, -5740.032, 3708.2760);
  if (e <= 0.715)
    return cubic(e, 1464.74, -4664.75, 3763.64, 0);
  return cubic(e, -5149.66, 29936.92, -54087.36, 31324.56);
}

EccentricityFunctions eccentricity_functions(double e) {
  EccentricityFunctions g{};
  g.g201 = -0.306 - (e - 0.64) * 0.440;
  if (e <= 0.65) {
    g.g211 = cubic(e, 3.616, -13.2470, 16.2900, 0);
    g.g310 = cubic(e, -19.302, 117.3900, -228.4190, 156.5910);
    g.g322 = cubic(e, -18.9068, 109.7927, -214.6334, 146.5816);
    g.g410 = cubic(e, -41.122, 242.6940, -471.0940, 313.9530);
    g.g422 = cubic(e, -146.407, 841.8800, -1629.014, 1083.4350);
  } else {
    g.g211 = cubic(e, -72.099, 331.819, -508.738, 266.724);
    g.g310 = cubic(e, -346.844, 1582.851, -2415.925, 1246.113);
    g.g322 = cubic(e, -342.585, 1554.908, -2366.899, 1215.972);
    g.g410 = cubic(e, -1052.797, 4758.686, -7193.992, 3651.957);
    g.g422 = cubic(e, -3581.690, 16178.110, -24462.770, 12422.520);
  }
  g.g520 = fitted_g520(e);
  if (e < 0.7) {
    g.g533 = cubic(e, -919.22770, 4988.6100, -9064.7700, 5542.21);
    g.g521 = cubic(e, -822.71072, 4568.6173, -8491.4146, 5337.524);
    g.g532 = cubic(e, -853.66600, 4690.2500, -8624.7700, 5341.4);
  } else {
    g.g533 = cubic(e, -37995.780, 161616.52, -229838.20, 109377.94);
    g.g521 = cubic(e, -51752.104, 218913.95, -309468.16, 146349.42);
    g.g532 = cubic(e, -40023.880, 170470.89, -242699.48, 115605.82);
  }
  return g;
}

/// Inclination functions of the half-day resonance.
struct InclinationFunctions {
  double f220, f221, f321, f322, f441, f442, f522, f523, f542, f543;
};

InclinationFunctions inclination_functions(double s, double c) {
  const double s2 = s * s, c2 = c * c;
  InclinationFunctions f{};
  f.f220 = 0.75 * (1 + 2 * c + c2);
  f.f221 = 1.5 * s2;
  f.f321 = 1.875 * s * (1 - 2 * c - 3 * c2);
  f.f322 = -1.875 * s * (1 + 2 * c - 3 * c2);
  f.f441 = 35 * s2 * f.f220;
  f.f442 = 39.3750 * s2 * s2;
  f.f522 = 9.84375 * s * (s2 * (1 - 2 * c - 5 * c2) + 0.33333333 * (-2 + 4 * c + 6 * c2));
  f.f523 = s * (4.92187512 * s2 * (-2 - 4 * c + 10 * c2) + 6.56250012 * (1 + 2 * c - 3 * c2));
  f.f542 = 29.53125 * s * (2 - 8 * c + c2 * (-12 + 8 * c + 10 * c2));
  f.f543 = 29.53125 * s * (-2 - 8 * c + c2 * (12 + 8 * c - 10 * c2));
  return f;
}

ResonanceModel half_day(const Constants &base, const ThirdBodyRates &third, double inverse_axis) {
  const MeanElements &m = base.epoch;
  const EccentricityFunctions g = eccentricity_functions(m.eccentricity);
  const InclinationFunctions f =
      inclination_functions(base.inclination.sine, base.inclination.cosine);
  const double degree2 = 3 * m.motion * m.motion * inverse_axis * inverse_axis;
  const double degree3 = degree2 * inverse_axis;
  const double degree4 = degree3 * inverse_axis;
  const double degree5 = degree4 * inverse_axis;
  ResonanceModel r;
  r.kind = Resonance::HalfDay;
  r.terms = {{{degree2 * root22 * f.f220 * g.g201, 2, 1, g22},
              {degree2 * root22 * f.f221 * g.g211, 0, 1, g22},
              {degree3 * root32 * f.f321 * g.g310, 1, 1, g32},
              {degree3 * root32 * f.f322 * g.g322, -1, 1, g32},
              {2 * degree4 * root44 * f.f441 * g.g410, 2, 2, g44},
              {2 * degree4 * root44 * f.f442 * g.g422, 0, 2, g44},
              {degree5 * root52 * f.f522 * g.g520, 1, 1, g52},
              {degree5 * root52 * f.f523 * g.g532, -1, 1, g52},
              {2 * degree5 * root54 * f.f542 * g.g521, 1, 2, g54},
              {2 * degree5 * root54 * f.f543 * g.g533, -1, 2, g54}}};
  r.term_count = 10;
  r.angle0 = std::fmod(m.anomaly + 2 * m.node - 2 * base.greenwich, two_pi);
  r.rate0 = base.rates.anomaly + third.anomaly + 2 * (base.rates.node + third.node - earth_rate) -
            m.motion;
  return r;
}

ResonanceModel one_day(const Constants &base, const ThirdBodyRates &third, double inverse_axis) {
  const MeanElements &m = base.epoch;
  const double e2 = m.eccentricity * m.eccentricity;
  const double s = base.inclination.sine, c1 = 1 + base.inclination.cosine;
  const double g200 = 1 + e2 * (-2.5 + 0.8125 * e2);
  const double g310 = 1 + 2 * e2;
  const double g300 = 1 + e2 * (-6 + 6.60937 * e2);
  const double f220 = 0.75 * c1 * c1;
  const double f311 = 0.9375 * s * s * (1 + 3 * base.inclination.cosine) - 0.75 * c1;
  const double f330 = 1.875 * c1 * c1 * c1;
  const double degree2 = 3 * m.motion * m.motion * inverse_axis * inverse_axis;
  const double degree3 = degree2 * inverse_axis;
  ResonanceModel r;
  r.kind = Resonance::OneDay;
  // The angle's multiple acts inside the sine with the phase: k (lambda - phase).
  r.terms[0] = {degree3 * f311 * g310 * q31, 0, 1, phase_31};
  r.terms[1] = {2 * degree2 * f220 * g200 * q22, 0, 2, 2 * phase_22};
  r.terms[2] = {3 * degree3 * f330 * g300 * q33, 0, 3, 3 * phase_33};
  r.term_count = 3;
  r.angle0 = std::fmod(m.anomaly + m.node + m.perigee - base.greenwich, two_pi);
  r.rate0 = base.rates.anomaly + base.rates.perigee + base.rates.node - earth_rate + third.anomaly +
            third.perigee + third.node - m.motion;
  return r;
}

/// Resonance angle and mean motion, and their derivatives.
struct Angle {
  double angle, motion;
};
struct Derivatives {
  double angle_rate, motion_rate, motion_second;
};

Derivatives derivatives(const Constants &c, const ResonanceModel &r, Angle at, double minutes) {
  // One-day terms do not hold the perigee.
  const double perigee = c.epoch.perigee + c.rates.perigee * minutes;
  Derivatives d{at.motion + r.rate0, 0, 0};
  for (int i = 0; i < r.term_count; ++i) {
    const ResonanceTerm &term = r.terms[static_cast<std::size_t>(i)];
    const double argument =
        term.perigee_multiple * perigee + term.angle_multiple * at.angle - term.phase;
    d.motion_rate += term.amplitude * std::sin(argument);
    d.motion_second += term.angle_multiple * term.amplitude * std::cos(argument);
  }
  d.motion_second *= d.angle_rate;
  return d;
}

/// Taylor steps of half a day from the epoch, then the rest (Euler-Maclaurin, H section 7).
Angle integrate(const Constants &c, const ResonanceModel &r, double minutes) {
  const double step = minutes > 0 ? 720 : -720;
  const int steps = static_cast<int>(std::abs(minutes) / 720);
  Angle at{r.angle0, c.epoch.motion};
  for (int i = 0; i < steps; ++i) {
    const Derivatives d = derivatives(c, r, at, i * step);
    at.angle += d.angle_rate * step + d.motion_rate * (step * step / 2);
    at.motion += d.motion_rate * step + d.motion_second * (step * step / 2);
  }
  const Derivatives d = derivatives(c, r, at, steps * step);
  const double rest = minutes - steps * step;
  return {at.angle + d.angle_rate * rest + d.motion_rate * (rest * rest * 0.5),
          at.motion + d.motion_rate * rest + d.motion_second * (rest * rest * 0.5)};
}

} // namespace

ResonanceModel resonance_model(const Constants &base, const ThirdBodyRates &rates) {
  const MeanElements &m = base.epoch;
  const double inverse_axis = std::pow(m.motion / gravity_rate(), 2.0 / 3.0);
  // Periods of 1200 to 1800 min, and of 680 to 760 min at high eccentricity (H section 7).
  if (m.motion > 0.0034906585 && m.motion < 0.0052359877)
    return one_day(base, rates, inverse_axis);
  if (m.motion >= 8.26e-3 && m.motion <= 9.24e-3 && m.eccentricity >= 0.5)
    return half_day(base, rates, inverse_axis);
  return {};
}

void deep_space_secular(const Constants &c, double minutes, MeanElements &mean) {
  const ThirdBodyRates &rates = c.deep->rates;
  const ResonanceModel &r = c.deep->resonance;
  mean.eccentricity += rates.eccentricity * minutes;
  mean.inclination += rates.inclination * minutes;
  mean.perigee += rates.perigee * minutes;
  mean.node += rates.node * minutes;
  mean.anomaly += rates.anomaly * minutes;
  if (r.kind == Resonance::None)
    return;
  const double theta = std::fmod(c.greenwich + minutes * earth_rate, two_pi);
  const Angle at = integrate(c, r, minutes);
  mean.motion = at.motion;
  mean.anomaly = r.kind == Resonance::HalfDay ? at.angle - 2 * mean.node + 2 * theta
                                              : at.angle - mean.node - mean.perigee + theta;
}

} // namespace umov::sgp4
