#include <umov/frames/site.h>

#include <cmath>
#include <erfa.h>
#include <erfam.h>
#include <fmt/format.h>

namespace umov {

Result<Site> make_site(std::string name, double latitude_deg, double longitude_deg,
                       double altitude_m) {
  if (!(std::abs(latitude_deg) <= 90))
    return fail(ErrorCode::BadInput,
                fmt::format("lat_deg = {}; -90 to 90 was expected (north positive)", latitude_deg));
  if (!(std::abs(longitude_deg) <= 360))
    return fail(ErrorCode::BadInput, fmt::format("lon_deg = {}; -360 to 360 was expected (east "
                                                 "positive)",
                                                 longitude_deg));
  if (!(altitude_m >= -500 && altitude_m <= 100e3))
    return fail(ErrorCode::BadInput,
                fmt::format("alt_m = {}; -500 to 100000 m was expected", altitude_m));
  return Site{std::move(name), Angle::degrees(latitude_deg), Angle::degrees(longitude_deg),
              altitude_m};
}

Vec3<Itrs> itrs_position_km(const Site &site) {
  double xyz[3];
  eraGd2gc(ERFA_WGS84, site.longitude.radians(), site.latitude.radians(), site.altitude_m, xyz);
  return {xyz[0] / 1000, xyz[1] / 1000, xyz[2] / 1000};
}

Rotation<Enu, Itrs> enu_from_itrs(const Site &site) {
  const double sp = std::sin(site.latitude.radians()), cp = std::cos(site.latitude.radians());
  const double sl = std::sin(site.longitude.radians()), cl = std::cos(site.longitude.radians());
  return {Vec3<Itrs>{-sl, cl, 0}, Vec3<Itrs>{-sp * cl, -sp * sl, cp},
          Vec3<Itrs>{cp * cl, cp * sl, sp}};
}

} // namespace umov
