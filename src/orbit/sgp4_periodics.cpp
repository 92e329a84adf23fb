// SDP4: periodic perturbations by Sun and Moon (H section 7, DPPER; V).

#include "sgp4_model.h"

#include <cmath>

namespace umov::sgp4 {

namespace {

struct Periodics {
  double eccentricity = 0, inclination = 0, longitude = 0, perigee = 0, node = 0;
};

/// Adds one body's terms; `perigee` and `node` are still multiplied by sin i.
void add_body(const ThirdBodyPeriodics &b, double minutes, Periodics &sum) {
  const double mean = b.anomaly0 + b.rate * minutes;
  const double anomaly = mean + 2 * b.eccentricity * std::sin(mean);
  const double s = std::sin(anomaly);
  const double f2 = 0.5 * s * s - 0.25;
  const double f3 = -0.5 * s * std::cos(anomaly);
  sum.eccentricity += b.e2 * f2 + b.e3 * f3;
  sum.inclination += b.i2 * f2 + b.i3 * f3;
  sum.longitude += b.l2 * f2 + b.l3 * f3 + b.l4 * s;
  sum.perigee += b.gh2 * f2 + b.gh3 * f3 + b.gh4 * s;
  sum.node += b.h2 * f2 + b.h3 * f3;
}

/// Lyddane's form for small inclinations: node and inclination as a vector.
void apply_lyddane(const Periodics &p, MeanElements &m) {
  const double si = std::sin(m.inclination), ci = std::cos(m.inclination);
  const double sn = std::sin(m.node), cn = std::cos(m.node);
  const double x = si * sn + p.node * cn + p.inclination * ci * sn;
  const double y = si * cn - p.node * sn + p.inclination * ci * cn;
  const double old_node = std::fmod(m.node, two_pi);
  const double longitude = m.anomaly + m.perigee + ci * old_node + p.longitude + p.perigee -
                           p.inclination * old_node * si;
  m.node = std::atan2(x, y);
  if (std::abs(old_node - m.node) > two_pi / 2)
    m.node += m.node < old_node ? two_pi : -two_pi;
  m.anomaly += p.longitude;
  m.perigee = longitude - m.anomaly - ci * m.node;
}

} // namespace

void deep_space_periodics(const DeepSpace &deep, double minutes, MeanElements &m) {
  Periodics p;
  add_body(deep.sun, minutes, p);
  add_body(deep.moon, minutes, p);
  m.inclination += p.inclination;
  m.eccentricity += p.eccentricity;
  if (m.inclination >= 0.2) {
    const double node = p.node / std::sin(m.inclination);
    m.perigee += p.perigee - std::cos(m.inclination) * node;
    m.node += node;
    m.anomaly += p.longitude;
  } else {
    apply_lyddane(p, m);
  }
  if (m.inclination < 0) { // the same plane, written with a positive inclination
    m.inclination = -m.inclination;
    m.node += two_pi / 2;
    m.perigee -= two_pi / 2;
  }
}

} // namespace umov::sgp4
