#pragma once
// An orbit from one state, by numerical integration.

#include <umov/orbit/trajectory.h>

namespace umov {

/// One state of an object, to integrate from.
struct StateVector {
  std::string name, object_id;
  int norad_cat_id = 0;
  OrbitFrame frame = OrbitFrame::Gcrs;
  EphemerisState state;
};

/// The orbit from the earlier to the later of the state's own time and the two given, as an
/// ephemeris in GCRS with a state every minute. Forces: the Earth's point mass and J2 to J4 (EGM96
/// values, pole of the state's date), Sun and Moon as point masses; no drag, no radiation
/// pressure, so a low orbit is kilometres off after a day. Steps by Runge-Kutta-Fehlberg 7(8) to
/// 1e-12. BadInput for a state below the surface or a span beyond 30 days; Physics if the orbit
/// meets the surface.
Result<OrbitEphemeris> integrate_orbit(const StateVector &start, Epoch<Utc> first, Epoch<Utc> last);

} // namespace umov
