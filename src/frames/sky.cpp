#include <umov/frames/sky.h>

#include <cmath>

namespace umov {

SkyDirection sky_direction(Vec3<Gcrs> v) {
  const double ra = std::atan2(v.y, v.x);
  return {Angle::radians(ra < 0 ? ra + 2 * pi : ra),
          Angle::radians(std::atan2(v.z, std::hypot(v.x, v.y)))};
}

Vec3<Gcrs> unit_vector(SkyDirection d) {
  const double cd = std::cos(d.declination.radians());
  return {cd * std::cos(d.right_ascension.radians()), cd * std::sin(d.right_ascension.radians()),
          std::sin(d.declination.radians())};
}

Angle position_angle(Vec3<Gcrs> s, Vec3<Gcrs> north, Vec3<Gcrs> v) {
  Vec3<Gcrs> n = north - dot(north, v) * v;
  n = norm(n) > 1e-12 ? normalized(n) : any_perpendicular(v);
  const Vec3<Gcrs> e = cross(v, n);
  double angle = std::atan2(dot(s, e), dot(s, n));
  if (angle < 0)
    angle += pi;
  return Angle::radians(angle >= pi ? angle - pi : angle);
}

Vec3<Gcrs> scattering_normal(Vec3<Gcrs> v, Vec3<Gcrs> l) {
  const Vec3<Gcrs> s = cross(v, l);
  return norm(s) > 1e-14 ? normalized(s) : any_perpendicular(v);
}

} // namespace umov
