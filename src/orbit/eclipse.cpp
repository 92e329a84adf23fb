#include <umov/orbit/ephemeris.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <umov/core/constants.h>
#include <umov/orbit/moon.h>

namespace umov {
namespace {

/// Visible part of a disk of angular radius a whose centre is c from the centre of another disk of
/// radius b: two circles overlapping in a plane (Montenbruck & Gill 2000, section 3.4.2).
double visible_of_two_disks(double a, double b, double c) {
  if (c >= a + b)
    return 1;
  if (c <= b - a)
    return 0;
  if (c <= a - b) // a ring is left
    return 1 - b * b / (a * a);
  const double x = (c * c + a * a - b * b) / (2 * c);
  const double y = std::sqrt(std::max(0.0, a * a - x * x));
  const double overlap = a * a * std::acos(std::clamp(x / a, -1.0, 1.0)) +
                         b * b * std::acos(std::clamp((c - x) / b, -1.0, 1.0)) - c * y;
  return std::clamp(1 - overlap / (pi * a * a), 0.0, 1.0);
}

/// A line of sight d0 + x e from the object, in coordinates that make the Earth a unit sphere:
/// it meets the Earth where (r.d)^2 - d.d (r.r - 1) >= 0 ahead (r.d < 0), a quadratic in x.
struct Chord {
  double a, b, c; ///< of the quadratic
  double ahead0, ahead1;

  [[nodiscard]] bool is_hidden(double x) const {
    return (a * x + b) * x + c >= 0 && ahead0 + x * ahead1 < 0;
  }
  /// Visible length of the chord from -h to h.
  [[nodiscard]] double visible_length(double h) const {
    double first = h, second = h;
    const double root = b * b - 4 * a * c;
    if (root > 0) { // the stable pair of roots
      const double q = -0.5 * (b + std::copysign(std::sqrt(root), b));
      first = std::clamp(a != 0 ? q / a : h, -h, h);
      second = std::clamp(q != 0 ? c / q : h, -h, h);
    }
    const std::array<double, 4> cuts{-h, std::min(first, second), std::max(first, second), h};
    double visible = 0;
    for (std::size_t i = 0; i < 3; ++i)
      if (!is_hidden(0.5 * (cuts[i] + cuts[i + 1])))
        visible += cuts[i + 1] - cuts[i];
    return visible;
  }
};

/// Axes scaled so that the WGS 84 ellipsoid becomes a unit sphere; lines stay lines.
Vec3<Itrs> scaled(Vec3<Itrs> v) {
  return {v.x / constants::wgs84_a_km, v.y / constants::wgs84_a_km,
          v.z / (constants::wgs84_a_km * (1 - constants::wgs84_f))};
}

double visible_over_ellipsoid(Vec3<Itrs> object_km, Vec3<Itrs> sun_unit, double disk) {
  const Vec3<Itrs> r = scaled(object_km);
  const double k = dot(r, r) - 1;
  // Chords run towards the Earth's centre, so that each crosses the limb once and its visible share
  // varies smoothly from chord to chord.
  const Vec3<Itrs> down = -1 * normalized(object_km);
  Vec3<Itrs> e1 = down - dot(down, sun_unit) * sun_unit;
  e1 = norm(e1) > 1e-12 ? normalized(e1) : any_perpendicular(sun_unit);
  const Vec3<Itrs> e2 = cross(sun_unit, e1);
  const double radius = std::tan(disk);
  const Vec3<Itrs> e = scaled(e1);
  // Gauss-Chebyshev of the second kind over the offset of the chord: the weight is its half length.
  constexpr int chords = 96;
  double sum = 0;
  for (int i = 1; i <= chords; ++i) {
    const double angle = pi * i / (chords + 1);
    const double half = radius * std::sin(angle);
    const Vec3<Itrs> d0 = scaled(sun_unit + radius * std::cos(angle) * e2);
    const double re = dot(r, e), rd = dot(r, d0);
    const Chord chord{re * re - k * dot(e, e), 2 * (rd * re - k * dot(d0, e)),
                      rd * rd - k * dot(d0, d0), rd, re};
    sum += std::sin(angle) * std::sin(angle) * chord.visible_length(half) / (2 * half);
  }
  return std::clamp(2 * sum / (chords + 1), 0.0, 1.0);
}

} // namespace

double sunlit_fraction(Vec3<Itrs> object_km, Vec3<Itrs> sun_km, ShadowModel shadow) {
  const Vec3<Itrs> to_sun = sun_km - object_km;
  const double r = norm(object_km), distance = norm(to_sun);
  const double disk = std::asin(std::min(1.0, constants::sun_radius_km / distance));
  const double apart = angle_between(to_sun, -1 * object_km);
  const double equator = std::asin(std::min(1.0, constants::wgs84_a_km / r));
  if (shadow == ShadowModel::Sphere)
    return visible_of_two_disks(disk, equator, apart);
  // The ellipsoid lies between the spheres of its two semi-axes: most epochs need no more.
  const double pole =
      std::asin(std::min(1.0, constants::wgs84_a_km * (1 - constants::wgs84_f) / r));
  if (apart >= disk + equator)
    return 1;
  if (apart <= pole - disk)
    return 0;
  return visible_over_ellipsoid(object_km, to_sun / distance, disk);
}

double sunlit_beside_moon(Epoch<Utc> time, Vec3<Gcrs> object_km, Vec3<Gcrs> sun_km) {
  // Mean elongation of the Moon (Meeus 1998, chapter 47): the true one differs by less than 8 deg,
  // the parallax of an object out to 100,000 km by less than 16.
  const double days = mjd(time) - 51544.5;
  const double elongation = std::remainder(297.8502 + 12.19074912 * days, 360.0);
  if (std::abs(elongation) > 26)
    return 1;
  constexpr double moon_radius_km = 1737.4; // IAU 2015 working group (Archinal et al. 2018)
  const Vec3<Gcrs> to_sun = sun_km - object_km, to_moon = moon_km(time) - object_km;
  const double disk = std::asin(std::min(1.0, constants::sun_radius_km / norm(to_sun)));
  const double moon = std::asin(std::min(1.0, moon_radius_km / norm(to_moon)));
  return visible_of_two_disks(disk, moon, angle_between(to_sun, to_moon));
}

} // namespace umov
