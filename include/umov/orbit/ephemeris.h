#pragma once
// Where an object and the Sun stand, as seen from a site: one epoch.

#include <umov/core/quantity.h>
#include <umov/core/rotation.h>
#include <umov/frames/site.h>
#include <umov/orbit/state.h>
#include <umov/time/epoch.h>

namespace umov {

/// The Earth that casts the shadow.
enum class ShadowModel { Ellipsoid, Sphere };

/// Models as in the docs: TEME to ITRS by GMST82 and polar motion, geometric topocentric angles (no
/// light time, no refraction), apparent geocentric Sun at its finite distance.
struct ObservingGeometry {
  Epoch<Utc> time;
  OrbitState state;                       ///< as it was given
  Vec3<Itrs> itrs_km, itrs_velocity_km_s; ///< velocity relative to the turning Earth
  Vec3<Gcrs> gcrs_km, gcrs_velocity_km_s; ///< inertial
  Vec3<Gcrs> observer_gcrs_km;
  Vec3<Gcrs> zenith;       ///< unit, of the site's ellipsoid
  Vec3<Gcrs> sun_gcrs_km;  ///< apparent geocentric
  Angle azimuth, altitude; ///< of the object, geometric; azimuth 0 at an exact zenith
  double range_km = 0, range_rate_km_s = 0;
  Angle right_ascension, declination; ///< topocentric, geometric, GCRS axes
  Angle sun_azimuth, sun_altitude;    ///< topocentric apparent, airless
  double sun_distance_km = 0;         ///< Sun to object
  Vec3<Gcrs> to_sun, to_observer;     ///< unit vectors at the object
  Angle phase_angle;                  ///< Sun-object-observer, 0 = full
  double sunlit = 1;                  ///< visible fraction of the solar disk: Earth, and Moon
  Angle pa_scat_equatorial; ///< position angle of +Q_scat from north through east, [0, 180) deg
  Angle pa_scat_altaz;      ///< the same from the local zenith
};

/// `time` need not be near the elements' epoch; nothing is checked here but mathematics.
ObservingGeometry observe(const OrbitState &state, Epoch<Utc> time, const Site &site,
                          ShadowModel shadow);

/// The altitude that `observe` gives, alone: many times faster, for searches.
Angle topocentric_altitude(const OrbitState &state, Epoch<Utc> time, const Site &site);

/// Visible fraction of the Sun's uniform disk over the Earth, 0..1, from positions in one
/// geocentric Earth-fixed frame. No atmosphere.
double sunlit_fraction(Vec3<Itrs> object_km, Vec3<Itrs> sun_km, ShadowModel shadow);

/// Visible fraction of the Sun's uniform disk beside the Moon's, 0..1, from the object, in GCRS;
/// the Moon as a sphere of 1737.4 km. 1 away from new moon without asking where the Moon is.
double sunlit_beside_moon(Epoch<Utc> time, Vec3<Gcrs> object_km, Vec3<Gcrs> sun_km);

/// How dark the sky of a site is, by the Sun's altitude: "day" (above -0.833 deg), "civil" (to -6),
/// "nautical" (to -12), "astronomical" (to -18) or "night".
const char *twilight(Angle sun_altitude);

/// Apparent geocentric Sun (light time and annual aberration) in GCRS [km].
Vec3<Gcrs> apparent_sun_km(Epoch<Utc> time);

} // namespace umov
