// SDP4: resonance of half-day and one-day orbits with the Earth's tesseral harmonics
// (H section 7; V). The angle is integrated from the epoch on every call, so that a state never
// depends on what was asked before.

#include "kernel/sgp4.inl.h"
#include "orbit/sgp4_model.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>

namespace umov::sgp4 {

namespace {

constexpr double earth_rate = 4.37526908801129966e-3; // sidereal [rad/min] (V)

// Amplitudes of the harmonics (H section 7).
constexpr double q22 = 1.7891679e-6, q31 = 2.1460748e-6, q33 = 2.2123015e-7;
constexpr double root22 = 1.7891679e-6, root32 = 3.7393792e-7, root44 = 7.3636953e-9,
                 root52 = 1.1428639e-7, root54 = 2.1765803e-9;

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

/// In the order of kernel::resonance_harmonic.
void set_amplitudes(std::initializer_list<double> values, Numbers &out) {
  std::copy(values.begin(), values.end(), out.resonance.amplitude);
}

void add_half_day(Constants &c, double inverse_axis) {
  Numbers &n = c.numbers;
  const MeanElements &m = n.epoch;
  const EccentricityFunctions g = eccentricity_functions(m.eccentricity);
  const InclinationFunctions f = inclination_functions(n.inclination.sine, n.inclination.cosine);
  const double degree2 = 3 * m.motion * m.motion * inverse_axis * inverse_axis;
  const double degree3 = degree2 * inverse_axis;
  const double degree4 = degree3 * inverse_axis;
  const double degree5 = degree4 * inverse_axis;
  c.kind.resonance = Resonance::HalfDay;
  set_amplitudes({degree2 * root22 * f.f220 * g.g201, degree2 * root22 * f.f221 * g.g211,
                  degree3 * root32 * f.f321 * g.g310, degree3 * root32 * f.f322 * g.g322,
                  2 * degree4 * root44 * f.f441 * g.g410, 2 * degree4 * root44 * f.f442 * g.g422,
                  degree5 * root52 * f.f522 * g.g520, degree5 * root52 * f.f523 * g.g532,
                  2 * degree5 * root54 * f.f542 * g.g521, 2 * degree5 * root54 * f.f543 * g.g533},
                 n);
  n.resonance.angle0 = std::fmod(m.anomaly + 2 * m.node - 2 * n.greenwich, two_pi);
  n.resonance.rate0 =
      n.rates.anomaly + n.third.anomaly + 2 * (n.rates.node + n.third.node - earth_rate) - m.motion;
}

void add_one_day(Constants &c, double inverse_axis) {
  Numbers &n = c.numbers;
  const MeanElements &m = n.epoch;
  const double e2 = m.eccentricity * m.eccentricity;
  const double s = n.inclination.sine, c1 = 1 + n.inclination.cosine;
  const double g200 = 1 + e2 * (-2.5 + 0.8125 * e2);
  const double g310 = 1 + 2 * e2;
  const double g300 = 1 + e2 * (-6 + 6.60937 * e2);
  const double f220 = 0.75 * c1 * c1;
  const double f311 = 0.9375 * s * s * (1 + 3 * n.inclination.cosine) - 0.75 * c1;
  const double f330 = 1.875 * c1 * c1 * c1;
  const double degree2 = 3 * m.motion * m.motion * inverse_axis * inverse_axis;
  const double degree3 = degree2 * inverse_axis;
  c.kind.resonance = Resonance::OneDay;
  set_amplitudes({degree3 * f311 * g310 * q31, 2 * degree2 * f220 * g200 * q22,
                  3 * degree3 * f330 * g300 * q33},
                 n);
  n.resonance.angle0 = std::fmod(m.anomaly + m.node + m.perigee - n.greenwich, two_pi);
  n.resonance.rate0 = n.rates.anomaly + n.rates.perigee + n.rates.node - earth_rate +
                      n.third.anomaly + n.third.perigee + n.third.node - m.motion;
}

} // namespace

void add_resonance(Constants &c) {
  const MeanElements &m = c.numbers.epoch;
  const double inverse_axis = std::pow(m.motion / gravity_rate, 2.0 / 3.0);
  // Periods of 1200 to 1800 min, and of 680 to 760 min at high eccentricity (H section 7).
  if (m.motion > 0.0034906585 && m.motion < 0.0052359877)
    add_one_day(c, inverse_axis);
  else if (m.motion >= 8.26e-3 && m.motion <= 9.24e-3 && m.eccentricity >= 0.5)
    add_half_day(c, inverse_axis);
}

namespace {

Node first_node(const Constants &c) {
  return {0, c.numbers.resonance.angle0, c.numbers.epoch.motion};
}
Node next_node(const Constants &c, const Node &at, int number, double step) {
  Node next = kernel::resonance_step(c.kind.resonance, c.numbers, at, step);
  next.minutes = number * step; // no sum of roundings
  return next;
}

} // namespace

Node resonance_node(const Constants &c, double minutes) {
  Node at = first_node(c);
  if (c.kind.resonance == Resonance::None)
    return at;
  const int steps = static_cast<int>(std::abs(minutes) / kernel::resonance_step_minutes);
  const double step =
      minutes > 0 ? kernel::resonance_step_minutes : -kernel::resonance_step_minutes;
  for (int i = 1; i <= steps; ++i)
    at = next_node(c, at, i, step);
  return at;
}

std::vector<Node> resonance_nodes(const Constants &c, int count, bool is_forward) {
  const double step = is_forward ? kernel::resonance_step_minutes : -kernel::resonance_step_minutes;
  std::vector<Node> out{first_node(c)};
  for (int i = 1; i <= count; ++i)
    out.push_back(next_node(c, out.back(), i, step));
  return out;
}

} // namespace umov::sgp4
