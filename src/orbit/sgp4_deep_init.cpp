// SDP4: amplitudes and rates of the perturbations by Sun and Moon (H section 7, DPINIT; V).

#include "orbit/sgp4_model.h"

#include <cmath>

namespace umov::sgp4 {

namespace {

/// Orbit of a third body as the theory sees it: orientation against the equator and strength.
struct ThirdBody {
  double cos_perigee = 1, sin_perigee = 0; ///< argument of perigee
  double cos_inclination = 1, sin_inclination = 0;
  double cos_node = 1, sin_node = 0; ///< of the satellite's node less the body's
  double strength = 0, rate = 0, eccentricity = 0, anomaly0 = 0;
};

/// What the averaged disturbing function of one body comes to for a satellite.
struct BodyTerms {
  double s1 = 0, s2 = 0, s3 = 0, s4 = 0, s5 = 0, s6 = 0, s7 = 0;
  double z1 = 0, z2 = 0, z3 = 0;
  double z11 = 0, z12 = 0, z13 = 0, z21 = 0, z22 = 0, z23 = 0, z31 = 0, z32 = 0, z33 = 0;
};

// Mean orbits at the epoch: constants of H section 7.
ThirdBody sun(double sin_node, double cos_node, double days_1900) {
  ThirdBody b;
  b.cos_perigee = 0.1945905;
  b.sin_perigee = -0.98088458;
  b.cos_inclination = 0.91744867;
  b.sin_inclination = 0.39785416;
  b.cos_node = cos_node;
  b.sin_node = sin_node;
  b.strength = 2.9864797e-6;
  b.rate = 1.19459e-5;
  b.eccentricity = 0.01675;
  b.anomaly0 = std::fmod(6.2565837 + 0.017201977 * days_1900, two_pi);
  return b;
}

ThirdBody moon(double sin_node, double cos_node, double days_1900) {
  const double ascending = std::fmod(4.5236020 - 9.2422029e-4 * days_1900, two_pi);
  const double stem = std::sin(ascending), ctem = std::cos(ascending);
  const double longitude = 5.8351514 + 0.0019443680 * days_1900;
  ThirdBody b;
  b.cos_inclination = 0.91375164 - 0.03568096 * ctem;
  b.sin_inclination = std::sqrt(1 - b.cos_inclination * b.cos_inclination);
  const double sin_h = 0.089683511 * stem / b.sin_inclination;
  const double cos_h = std::sqrt(1 - sin_h * sin_h);
  const double along =
      std::atan2(0.39785416 * stem / b.sin_inclination, cos_h * ctem + 0.91744867 * sin_h * stem);
  const double perigee = longitude + along - ascending;
  b.cos_perigee = std::cos(perigee);
  b.sin_perigee = std::sin(perigee);
  b.cos_node = cos_h * cos_node + sin_h * sin_node;
  b.sin_node = sin_node * cos_h - cos_node * sin_h;
  b.strength = 4.7968065e-7;
  b.rate = 1.5835218e-4;
  b.eccentricity = 0.05490;
  b.anomaly0 = std::fmod(4.7199672 + 0.22997150 * days_1900 - longitude, two_pi);
  return b;
}

/// Direction cosines of the satellite's orbit against the body's: a_i and X_i of H section 7.
struct Cosines {
  double a1, a2, a3, a4, a5, a6;
  double x1, x2, x3, x4, x5, x6, x7, x8;
};

Cosines direction_cosines(const ThirdBody &b, const InclinationTerms &inc, double perigee) {
  const double a7 = -b.cos_perigee * b.sin_node + b.sin_perigee * b.cos_inclination * b.cos_node;
  const double a8 = b.sin_perigee * b.sin_inclination;
  const double a9 = b.sin_perigee * b.sin_node + b.cos_perigee * b.cos_inclination * b.cos_node;
  const double a10 = b.cos_perigee * b.sin_inclination;
  const double s = std::sin(perigee), c = std::cos(perigee);
  Cosines q{};
  q.a1 = b.cos_perigee * b.cos_node + b.sin_perigee * b.cos_inclination * b.sin_node;
  q.a3 = -b.sin_perigee * b.cos_node + b.cos_perigee * b.cos_inclination * b.sin_node;
  q.a2 = inc.cosine * a7 + inc.sine * a8;
  q.a4 = inc.cosine * a9 + inc.sine * a10;
  q.a5 = -inc.sine * a7 + inc.cosine * a8;
  q.a6 = -inc.sine * a9 + inc.cosine * a10;
  q.x1 = q.a1 * c + q.a2 * s;
  q.x2 = q.a3 * c + q.a4 * s;
  q.x3 = -q.a1 * s + q.a2 * c;
  q.x4 = -q.a3 * s + q.a4 * c;
  q.x5 = q.a5 * s;
  q.x6 = q.a6 * s;
  q.x7 = q.a5 * c;
  q.x8 = q.a6 * c;
  return q;
}

BodyTerms body_terms(const ThirdBody &b, const InclinationTerms &inc, const MeanElements &m) {
  const Cosines q = direction_cosines(b, inc, m.perigee);
  const double e2 = m.eccentricity * m.eccentricity, beta2 = 1 - e2;
  BodyTerms t;
  t.z31 = 12 * q.x1 * q.x1 - 3 * q.x3 * q.x3;
  t.z32 = 24 * q.x1 * q.x2 - 6 * q.x3 * q.x4;
  t.z33 = 12 * q.x2 * q.x2 - 3 * q.x4 * q.x4;
  t.z11 = -6 * q.a1 * q.a5 + e2 * (-24 * q.x1 * q.x7 - 6 * q.x3 * q.x5);
  t.z12 = -6 * (q.a1 * q.a6 + q.a3 * q.a5) +
          e2 * (-24 * (q.x2 * q.x7 + q.x1 * q.x8) - 6 * (q.x3 * q.x6 + q.x4 * q.x5));
  t.z13 = -6 * q.a3 * q.a6 + e2 * (-24 * q.x2 * q.x8 - 6 * q.x4 * q.x6);
  t.z21 = 6 * q.a2 * q.a5 + e2 * (24 * q.x1 * q.x5 - 6 * q.x3 * q.x7);
  t.z22 = 6 * (q.a4 * q.a5 + q.a2 * q.a6) +
          e2 * (24 * (q.x2 * q.x5 + q.x1 * q.x6) - 6 * (q.x4 * q.x7 + q.x3 * q.x8));
  t.z23 = 6 * q.a4 * q.a6 + e2 * (24 * q.x2 * q.x6 - 6 * q.x4 * q.x8);
  t.z1 = 2 * (3 * (q.a1 * q.a1 + q.a2 * q.a2) + t.z31 * e2) + beta2 * t.z31;
  t.z2 = 2 * (6 * (q.a1 * q.a3 + q.a2 * q.a4) + t.z32 * e2) + beta2 * t.z32;
  t.z3 = 2 * (3 * (q.a3 * q.a3 + q.a4 * q.a4) + t.z33 * e2) + beta2 * t.z33;
  t.s3 = b.strength / m.motion;
  t.s2 = -0.5 * t.s3 / std::sqrt(beta2);
  t.s4 = t.s3 * std::sqrt(beta2);
  t.s1 = -15 * m.eccentricity * t.s4;
  t.s5 = q.x1 * q.x3 + q.x2 * q.x4;
  t.s6 = q.x2 * q.x3 + q.x1 * q.x4;
  t.s7 = q.x2 * q.x4 - q.x1 * q.x3;
  return t;
}

ThirdBodyPeriodics periodics(const ThirdBody &b, const BodyTerms &t, double eccentricity) {
  const double e2 = eccentricity * eccentricity;
  ThirdBodyPeriodics p{};
  p.e2 = 2 * t.s1 * t.s6;
  p.e3 = 2 * t.s1 * t.s7;
  p.i2 = 2 * t.s2 * t.z12;
  p.i3 = 2 * t.s2 * (t.z13 - t.z11);
  p.l2 = -2 * t.s3 * t.z2;
  p.l3 = -2 * t.s3 * (t.z3 - t.z1);
  p.l4 = -2 * t.s3 * (-21 - 9 * e2) * b.eccentricity;
  p.gh2 = 2 * t.s4 * t.z32;
  p.gh3 = 2 * t.s4 * (t.z33 - t.z31);
  p.gh4 = -18 * t.s4 * b.eccentricity;
  p.h2 = -2 * t.s2 * t.z22;
  p.h3 = -2 * t.s2 * (t.z23 - t.z21);
  p.anomaly0 = b.anomaly0;
  p.rate = b.rate;
  p.eccentricity = b.eccentricity;
  return p;
}

void add_rates(ThirdBodyRates &rates, const ThirdBody &b, const BodyTerms &t, const MeanElements &m,
               const InclinationTerms &inc) {
  const double e2 = m.eccentricity * m.eccentricity;
  rates.eccentricity += t.s1 * b.rate * t.s5;
  rates.inclination += t.s2 * b.rate * (t.z11 + t.z13);
  rates.anomaly -= b.rate * t.s3 * (t.z1 + t.z3 - 14 - 6 * e2);
  rates.perigee += t.s4 * b.rate * (t.z31 + t.z33 - 6);
  // The node's rate divides by sin i: dropped within 3 deg of the equator (V).
  constexpr double three_degrees = 5.2359877e-2;
  if (m.inclination < three_degrees || m.inclination > two_pi / 2 - three_degrees || inc.sine == 0)
    return;
  const double node = -b.rate * t.s2 * (t.z21 + t.z23) / inc.sine;
  rates.node += node;
  rates.perigee -= inc.cosine * node;
}

} // namespace

void add_deep_space(Constants &c, double days_1900) {
  Numbers &n = c.numbers;
  const MeanElements &m = n.epoch;
  const double sin_node = std::sin(m.node), cos_node = std::cos(m.node);
  for (const bool is_sun : {true, false}) {
    const ThirdBody body =
        is_sun ? sun(sin_node, cos_node, days_1900) : moon(sin_node, cos_node, days_1900);
    const BodyTerms terms = body_terms(body, n.inclination, m);
    (is_sun ? n.sun : n.moon) = periodics(body, terms, m.eccentricity);
    add_rates(n.third, body, terms, m, n.inclination);
  }
  add_resonance(c);
}

} // namespace umov::sgp4
