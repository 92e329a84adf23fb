#pragma once
#include <string>
#include <umov/core/quantity.h>
#include <umov/core/result.h>
#include <umov/core/rotation.h>

namespace umov {

/// A place on the WGS 84 ellipsoid.
struct Site {
  std::string name;
  Angle latitude;        ///< geodetic, north positive
  Angle longitude;       ///< east positive
  double altitude_m = 0; ///< above the ellipsoid
};

/// Checks ranges: |latitude| <= 90 deg, |longitude| <= 360 deg, altitude -500 m .. 100 km.
Result<Site> make_site(std::string name, double latitude_deg, double longitude_deg,
                       double altitude_m);
/// Earth-fixed position of a site [km].
Vec3<Itrs> itrs_position_km(const Site &site);
/// Axes east, north and up of the ellipsoid's normal.
Rotation<Enu, Itrs> enu_from_itrs(const Site &site);

} // namespace umov
