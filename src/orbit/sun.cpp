#include <umov/orbit/ephemeris.h>

#include <array>
#include <erfa.h>
#include <umov/core/constants.h>
#include <umov/time/hourly.h>

namespace umov {

namespace {

/// [km]. TDB - TT stays below 2 ms, in which the Earth moves 60 m: nothing.
std::array<double, 3> apparent_sun(double tt1, double tt2) {
  double heliocentric[2][3], barycentric[2][3];
  eraEpv00(tt1, tt2, heliocentric, barycentric);
  // The Sun where it was when the light left: its barycentric motion is 15 m/s, so 8 minutes are
  // 7 km or 0.01 arcsec. One step is enough.
  constexpr double light_days_per_au = 499.004784 / 86400; // IAU 2009: light time for 1 au [s]
  double distance = 0, unit[3];
  eraPn(heliocentric[0], &distance, unit);
  const double back = distance * light_days_per_au;
  Vec3<Gcrs> sun{};
  double *const out[3] = {&sun.x, &sun.y, &sun.z};
  for (int i = 0; i < 3; ++i)
    *out[i] = -heliocentric[0][i] - back * (barycentric[1][i] - heliocentric[1][i]);
  const double length = norm(sun);
  double natural[3] = {sun.x / length, sun.y / length, sun.z / length};
  // Annual aberration with the Earth's barycentric velocity in units of c.
  double velocity[3];
  double speed_squared = 0;
  for (int i = 0; i < 3; ++i) {
    velocity[i] = barycentric[1][i] * light_days_per_au;
    speed_squared += velocity[i] * velocity[i];
  }
  double proper[3];
  eraAb(natural, velocity, length, 1 - speed_squared / 2, proper);
  const double km = length * constants::au_km;
  return {proper[0] * km, proper[1] * km, proper[2] * km};
}

} // namespace

Vec3<Gcrs> apparent_sun_km(Epoch<Utc> time) {
  thread_local Hourly<3> sun(apparent_sun);
  const auto [x, y, z] = sun(tt_from(time));
  return {x, y, z};
}

} // namespace umov
