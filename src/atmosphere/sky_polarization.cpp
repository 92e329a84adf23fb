#include <umov/atmosphere/sky_polarization.h>

namespace umov {

Vec3<Enu> horizontal_direction(Angle azimuth, Angle altitude) {
  const double c = std::cos(altitude.radians());
  return {c * std::sin(azimuth.radians()), c * std::cos(azimuth.radians()),
          std::sin(altitude.radians())};
}

SkyPolarization scattered_sky(Vec3<Enu> to_source, Vec3<Enu> to_sky, double dilution) {
  constexpr double rho = 0.0279;
  const double c = dot(to_source, to_sky);
  SkyPolarization out;
  out.degree = dilution * (1 - rho) * (1 - c * c) / (1 + rho + (1 - rho) * c * c);
  // Light comes along v = -to_sky to the observer; north and east as seen from there.
  const Vec3<Enu> v = -to_sky, up{0, 0, 1};
  Vec3<Enu> n = up - v * dot(up, v);
  n = norm(n) > 1e-12 ? normalized(n) : any_perpendicular(v);
  const Vec3<Enu> east = cross(v, n), s = cross(v, to_source);
  double angle = std::atan2(dot(s, east), dot(s, n));
  if (angle < 0)
    angle += pi;
  out.axis = Angle::radians(angle >= pi ? angle - pi : angle);
  return out;
}

} // namespace umov
