// SGP4: constants of the elements. Sources H, V, S as in sgp4_model.h.

#include "kernel/sgp4.inl.h"
#include "orbit/sgp4_model.h"

#include <cmath>

namespace umov::sgp4 {

namespace {

/// Terms of the atmosphere's power law: s, (q0 - s)^4 and what follows from them.
struct Atmosphere {
  double s = 0, xi = 0, eta = 0, eta2 = 0, e_eta = 0, psi2 = 0, coef = 0, coef1 = 0;
};

double fourth(double x) { return x * x * (x * x); }

// s is 78 km, and lower for a perigee below 156 km (H section 6).
Atmosphere atmosphere(double axis, double eccentricity) {
  const double perigee_km = (axis * (1 - eccentricity) - 1) * earth_radius_km;
  double s_km = 78;
  if (perigee_km < 156)
    s_km = perigee_km < 98 ? 20 : perigee_km - 78;
  Atmosphere a;
  a.s = s_km / earth_radius_km + 1;
  const double density = fourth((120 - s_km) / earth_radius_km);
  a.xi = 1 / (axis - a.s);
  a.eta = axis * eccentricity * a.xi;
  a.eta2 = a.eta * a.eta;
  a.e_eta = eccentricity * a.eta;
  a.psi2 = std::abs(1 - a.eta2);
  a.coef = density * fourth(a.xi);
  a.coef1 = a.coef / std::pow(a.psi2, 3.5);
  return a;
}

SecularRates secular_rates(const MeanElements &m, double axis, double cosine) {
  const double beta2 = 1 - m.eccentricity * m.eccentricity;
  const double beta = std::sqrt(beta2);
  const double p2 = 1 / (axis * beta2 * (axis * beta2));
  const double c2 = cosine * cosine, c4 = c2 * c2;
  const double first = 1.5 * j2 * p2 * m.motion;
  const double second = 0.5 * first * j2 * p2;
  const double fourth_zonal = -0.46875 * j4 * p2 * p2 * m.motion;
  SecularRates r{};
  r.anomaly = m.motion + 0.5 * first * beta * (3 * c2 - 1) +
              0.0625 * second * beta * (13 - 78 * c2 + 137 * c4);
  r.perigee = -0.5 * first * (1 - 5 * c2) + 0.0625 * second * (7 - 114 * c2 + 395 * c4) +
              fourth_zonal * (3 - 36 * c2 + 49 * c4);
  r.node =
      -first * cosine + (0.5 * second * (4 - 19 * c2) + 2 * fourth_zonal * (3 - 7 * c2)) * cosine;
  return r;
}

// C2 .. C5 (H section 6). `inc` are those of the epoch.
struct DragCoefficients {
  double c2 = 0, c3 = 0, c4 = 0, c5 = 0;
};

DragCoefficients drag_coefficients(const MeanElements &m, double axis, const Atmosphere &a,
                                   const InclinationTerms &inc) {
  const double e = m.eccentricity, beta2 = 1 - e * e;
  DragCoefficients c;
  c.c2 = a.coef1 * m.motion *
         (axis * (1 + 1.5 * a.eta2 + a.e_eta * (4 + a.eta2)) +
          0.375 * j2 * a.xi / a.psi2 * inc.three_cos2_minus_1 * (8 + 3 * a.eta2 * (8 + a.eta2)));
  if (e > 1e-4) // below, the term is dropped: it divides by the eccentricity
    c.c3 = -2 * a.coef * a.xi * j3_over_j2 * m.motion * inc.sine / e;
  const double zonal =
      -3 * inc.three_cos2_minus_1 * (1 - 2 * a.e_eta + a.eta2 * (1.5 - 0.5 * a.e_eta)) +
      0.75 * inc.one_minus_cos2 * (2 * a.eta2 - a.e_eta * (1 + a.eta2)) * std::cos(2 * m.perigee);
  c.c4 =
      2 * m.motion * a.coef1 * axis * beta2 *
      (a.eta * (2 + 0.5 * a.eta2) + e * (0.5 + 2 * a.eta2) - j2 * a.xi / (axis * a.psi2) * zonal);
  c.c5 = 2 * a.coef1 * axis * beta2 * (1 + 2.75 * (a.eta2 + a.e_eta) + a.e_eta * a.eta2);
  return c;
}

// D2 .. D4 and the mean longitude's coefficients.
void add_higher_drag(DragTerms &d, double axis, const Atmosphere &a) {
  const double c1_2 = d.c1 * d.c1;
  d.d2 = 4 * axis * a.xi * c1_2;
  const double step = d.d2 * a.xi * d.c1 / 3;
  d.d3 = (17 * axis + a.s) * step;
  d.d4 = 0.5 * step * axis * a.xi * (221 * axis + 31 * a.s) * d.c1;
  d.l3 = d.d2 + 2 * c1_2;
  d.l4 = 0.25 * (3 * d.d3 + d.c1 * (12 * d.d2 + 10 * c1_2));
  d.l5 = 0.2 * (3 * d.d4 + 12 * d.c1 * d.d3 + 6 * d.d2 * d.d2 + 15 * c1_2 * (2 * d.d2 + c1_2));
}

DragTerms drag_terms(const MeanElements &m, const InclinationTerms &inc, double axis, double bstar,
                     bool is_simple) {
  const Atmosphere a = atmosphere(axis, m.eccentricity);
  const DragCoefficients c = drag_coefficients(m, axis, a, inc);
  const double beta2 = 1 - m.eccentricity * m.eccentricity;
  const double p = axis * beta2;
  DragTerms d{};
  d.bstar = bstar;
  d.c1 = bstar * c.c2;
  d.c4 = c.c4;
  d.c5 = c.c5;
  d.l2 = 1.5 * d.c1;
  const double node_rate_j2 = -1.5 * j2 / (p * p) * m.motion * inc.cosine;
  d.node_t2 = 3.5 * beta2 * node_rate_j2 * d.c1;
  d.eta = a.eta;
  d.perigee_t = bstar * c.c3 * std::cos(m.perigee);
  if (m.eccentricity > 1e-4)
    d.anomaly_factor = -2.0 / 3.0 * a.coef * bstar / a.e_eta;
  const double offset = 1 + a.eta * std::cos(m.anomaly);
  d.anomaly_offset = offset * offset * offset;
  d.sine_anomaly0 = std::sin(m.anomaly);
  if (!is_simple)
    add_higher_drag(d, axis, a);
  return d;
}

} // namespace

// Not ERFA's eraGmst82 and eraCal2jd: one double for the date and this order of the sum are what
// the reference program has, whose last digits the tests hold this to
// (src/orbit/tests/sgp4_test.cpp).
double julian_date_of_year_day(int year, int day) {
  // Days of the Gregorian calendar before 1 January of `year`; 1 January 1 is JD 1721425.5.
  const int y = year - 1;
  const int days_before = 365 * y + y / 4 - y / 100 + y / 400;
  return 1721425.5 + days_before + (day - 1);
}

double greenwich_angle_1982(double jd) {
  const double t = (jd - 2451545.0) / 36525;
  const double seconds =
      67310.54841 + t * (876600.0 * 3600 + 8640184.812866 + t * (0.093104 - t * 6.2e-6));
  const double angle = std::fmod(seconds * (two_pi / 86400), two_pi);
  return angle < 0 ? angle + two_pi : angle;
}

double brouwer_mean_motion(double kozai, double eccentricity, double cos_inclination) {
  const double beta2 = 1 - eccentricity * eccentricity;
  const double shift =
      0.75 * j2 * (3 * cos_inclination * cos_inclination - 1) / (std::sqrt(beta2) * beta2);
  const double a1 = std::pow(gravity_rate / kozai, 2.0 / 3.0);
  const double delta1 = shift / (a1 * a1);
  const double a0 = a1 * (1 - delta1 * delta1 - delta1 * (1.0 / 3.0 + 134 * delta1 * delta1 / 81));
  return kozai / (1 + shift / (a0 * a0));
}

Constants initialise(const ElementSet &elements) {
  Constants c;
  Numbers &n = c.numbers;
  MeanElements &m = n.epoch;
  m = {elements.mean_motion, elements.eccentricity,        elements.inclination,
       elements.raan,        elements.argument_of_perigee, elements.mean_anomaly};
  if (!(m.eccentricity >= 0 && m.eccentricity < 1)) {
    c.code = Sgp4Code::Eccentricity;
    return c;
  }
  if (!(m.motion > 0 && std::isfinite(m.motion))) {
    c.code = Sgp4Code::MeanMotion;
    return c;
  }
  if (!(std::abs(elements.epoch_day_of_year) < 1000)) {
    c.code = Sgp4Code::OutOfRange;
    return c;
  }
  n.inclination = kernel::inclination_terms(m.inclination);
  m.motion = brouwer_mean_motion(m.motion, m.eccentricity, n.inclination.cosine);
  if (!(m.motion > 0 && std::isfinite(m.motion))) {
    c.code = Sgp4Code::MeanMotion;
    return c;
  }
  const double axis = n.axis0 = std::pow(gravity_rate / m.motion, 2.0 / 3.0);
  const double day = std::floor(elements.epoch_day_of_year);
  // NOTE: the epoch is rounded to one double (20 us) because the reference does so: the Moon's
  // place at the epoch moves object 23333, at its perigee, by 4e-6 km otherwise.
  const double jd = julian_date_of_year_day(elements.epoch_year, static_cast<int>(day)) +
                    (elements.epoch_day_of_year - day);
  n.greenwich = greenwich_angle_1982(jd);
  n.rates = secular_rates(m, axis, n.inclination.cosine);
  c.kind.is_deep = two_pi / m.motion >= 225; // period [min] from which on Sun and Moon count
  c.kind.is_simple = c.kind.is_deep || axis * (1 - m.eccentricity) < 220 / earth_radius_km + 1;
  n.drag = drag_terms(m, n.inclination, axis, elements.bstar, c.kind.is_simple);
  if (c.kind.is_deep)
    add_deep_space(c, jd - 2415020.0);
  c.is_usable = true;
  TemeState unused;
  c.code = state_at(c, 0, unused);
  return c;
}

} // namespace umov::sgp4
