#include <umov/orbit/ephemeris.h>

#include "orbit/earth_axes.h"

#include <cmath>
#include <umov/frames/earth.h>
#include <umov/frames/sky.h>

namespace umov {
namespace {

struct Topocentric {
  Angle azimuth, altitude;
};

Topocentric topocentric(Vec3<Enu> v) {
  const double horizontal = std::hypot(v.x, v.y);
  double azimuth = horizontal > 0 ? std::atan2(v.x, v.y) : 0; // undefined at an exact zenith: 0
  if (azimuth < 0)
    azimuth += 2 * pi;
  return {Angle::radians(azimuth), Angle::radians(std::atan2(v.z, horizontal))};
}

/// Fills what is seen from the site: angles, range and their frames.
void add_topocentric(ObservingGeometry &out, const Site &site, Vec3<Itrs> sun_itrs_km,
                     const Rotation<Gcrs, Itrs> &gcrs_from_itrs) {
  const Vec3<Itrs> observer = itrs_position_km(site);
  const auto enu = enu_from_itrs(site);
  const Vec3<Itrs> line = out.itrs_km - observer;
  const Topocentric object = topocentric(enu * line),
                    sun = topocentric(enu * (sun_itrs_km - observer));
  out.azimuth = object.azimuth;
  out.altitude = object.altitude;
  out.sun_azimuth = sun.azimuth;
  out.sun_altitude = sun.altitude;
  out.range_km = norm(line);
  out.range_rate_km_s = dot(line, out.itrs_velocity_km_s) / out.range_km;
  out.observer_gcrs_km = gcrs_from_itrs * observer;
  const SkyDirection sky = sky_direction(gcrs_from_itrs * line);
  out.right_ascension = sky.right_ascension;
  out.declination = sky.declination;
}

} // namespace

Angle topocentric_altitude(const OrbitState &state, Epoch<Utc> time, const Site &site) {
  const Vec3<Itrs> line = itrs_position_km(state, time) - itrs_position_km(site);
  return topocentric(enu_from_itrs(site) * line).altitude;
}

const char *twilight(Angle sun_altitude) {
  const double altitude = sun_altitude.degrees();
  return altitude > -0.833 ? "day" // refraction and the solar radius
         : altitude > -6   ? "civil"
         : altitude > -12  ? "nautical"
         : altitude > -18  ? "astronomical"
                           : "night";
}

ObservingGeometry observe(const OrbitState &state, Epoch<Utc> time, const Site &site,
                          ShadowModel shadow) {
  ObservingGeometry out;
  out.time = time;
  out.state = state;
  const auto gcrs_to_itrs = itrs_from_gcrs(time);
  const auto gcrs_from_itrs = gcrs_to_itrs.inverse();
  const EarthAxes earth = earth_axes(state, time, gcrs_to_itrs);
  out.itrs_km = earth.position_km;
  out.itrs_velocity_km_s = earth.inertial_km_s - carried_km_s(earth.position_km);
  const auto *inertial = std::get_if<GcrsState>(&state);
  out.gcrs_km = inertial ? inertial->position_km : gcrs_from_itrs * earth.position_km;
  out.gcrs_velocity_km_s =
      inertial ? inertial->velocity_km_s : gcrs_from_itrs * earth.inertial_km_s;
  out.sun_gcrs_km = apparent_sun_km(time);
  const Vec3<Itrs> sun_itrs_km = gcrs_to_itrs * out.sun_gcrs_km;
  add_topocentric(out, site, sun_itrs_km, gcrs_from_itrs);
  const Vec3<Gcrs> to_sun = out.sun_gcrs_km - out.gcrs_km;
  out.sun_distance_km = norm(to_sun);
  out.to_sun = to_sun / out.sun_distance_km;
  out.to_observer = normalized(out.observer_gcrs_km - out.gcrs_km);
  out.phase_angle = Angle::radians(angle_between(out.to_sun, out.to_observer));
  // Both at once within one epoch are rare, and then each takes its own part.
  out.sunlit = sunlit_fraction(out.itrs_km, sun_itrs_km, shadow) *
               sunlit_beside_moon(time, out.gcrs_km, out.sun_gcrs_km);
  const Vec3<Gcrs> s = scattering_normal(out.to_observer, out.to_sun);
  out.zenith = gcrs_from_itrs * enu_from_itrs(site).row(2);
  out.pa_scat_equatorial = position_angle(s, {0, 0, 1}, out.to_observer);
  out.pa_scat_altaz = position_angle(s, out.zenith, out.to_observer);
  return out;
}

} // namespace umov
