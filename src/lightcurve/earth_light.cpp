#include <umov/lightcurve/earth_light.h>

#include <algorithm>
#include <cmath>
#include <umov/core/constants.h>
#include <umov/frames/sky.h>
#include <umov/orbit/moon.h>
#include <umov/scene/pose.h>

namespace umov {
namespace {

/// Of a source, for mirrors: as the Sun's, though a patch is larger. Lobes narrower than a patch
/// see the patches one by one.
constexpr double patch_radius_rad = sun_radius_at_1au_rad;

/// A part of the Earth's disk as the object sees it.
struct Patch {
  Vec3<Gcrs> direction;  ///< unit, from the object
  double irradiance = 0; ///< per unit solar irradiance
};

/// Even in solid angle over the cap (a Fibonacci spiral), those in sunlight.
std::vector<Patch> lit_patches(const ObservingGeometry &g, const EarthshineOptions &o) {
  const double distance = norm(g.gcrs_km);
  const double sine = constants::wgs84_a_km / distance;
  if (!(sine < 1))
    return {};
  const double cos_limb = std::sqrt(1 - sine * sine);
  const Vec3<Gcrs> down = -1 * g.gcrs_km / distance, e1 = any_perpendicular(down),
                   e2 = cross(down, e1), sun = normalized(g.sun_gcrs_km);
  const double solid = 2 * pi * (1 - cos_limb) / static_cast<double>(o.patches);
  constexpr double golden_angle = 2.399963229728653;
  std::vector<Patch> out;
  for (std::size_t k = 0; k < o.patches; ++k) {
    const double c =
        1 - (1 - cos_limb) * (static_cast<double>(k) + 0.5) / static_cast<double>(o.patches);
    const double s = std::sqrt(std::max(0.0, 1 - c * c)),
                 azimuth = golden_angle * static_cast<double>(k);
    const Vec3<Gcrs> direction =
        down * c + e1 * (s * std::cos(azimuth)) + e2 * (s * std::sin(azimuth));
    // Where that line meets the sphere: the nearer of the two places.
    const double along =
        distance * c - std::sqrt(std::max(0.0, constants::wgs84_a_km * constants::wgs84_a_km -
                                                   distance * distance * s * s));
    const double cos_sun = dot(normalized(g.gcrs_km + direction * along), sun);
    if (cos_sun > 0)
      out.push_back({direction, o.albedo / pi * cos_sun * solid});
  }
  return out;
}

} // namespace

namespace {

/// The light of all sources, each turned into the sky's axes from its own scattering plane.
std::vector<Stokes<SkyNorth>> light_by(const std::vector<Patch> &patches,
                                       const ObservingGeometry &g,
                                       const Rotation<Body, Gcrs> &body_from_gcrs,
                                       Vec3<Gcrs> sky_north, std::size_t bands,
                                       const LightOfPoses &light) {
  std::vector<Stokes<SkyNorth>> out(bands);
  std::vector<Pose> poses;
  for (const Patch &patch : patches)
    poses.push_back({normalized(body_from_gcrs * patch.direction),
                     normalized(body_from_gcrs * g.to_observer), patch_radius_rad});
  if (poses.empty())
    return out;
  const auto results = light(poses);
  for (std::size_t k = 0; k < patches.size(); ++k) {
    const Angle axis = position_angle(scattering_normal(g.to_observer, patches[k].direction),
                                      sky_north, g.to_observer);
    for (std::size_t b = 0; b < bands; ++b)
      out[b] += rotate_to<SkyNorth>(results[k][b].stokes, Angle::radians(-axis.radians())) *
                patches[k].irradiance;
  }
  return out;
}

} // namespace

std::vector<Stokes<SkyNorth>> earth_light(const ObservingGeometry &g,
                                          const Rotation<Body, Gcrs> &body_from_gcrs,
                                          Vec3<Gcrs> sky_north, const EarthshineOptions &options,
                                          std::size_t bands, const LightOfPoses &light) {
  return light_by(lit_patches(g, options), g, body_from_gcrs, sky_north, bands, light);
}

double moon_irradiance(const ObservingGeometry &g, Vec3<Gcrs> moon) {
  const Vec3<Gcrs> to_moon = moon - g.gcrs_km, down = -1 * g.gcrs_km;
  const double limb = std::asin(std::min(1.0, constants::wgs84_a_km / norm(down)));
  if (angle_between(to_moon, down) < limb)
    return 0;
  const double phase =
      angle_between(g.sun_gcrs_km - moon, g.gcrs_km - moon) * 180 / pi; // at the Moon
  if (phase > 160)
    return 0;
  constexpr double sun_magnitude = -26.74, mean_distance_km = 384400;
  const double magnitude = -12.73 + 0.026 * phase + 4e-9 * std::pow(phase, 4);
  return std::pow(10, -0.4 * (magnitude - sun_magnitude)) *
         std::pow(mean_distance_km / norm(to_moon), 2);
}

std::vector<Stokes<SkyNorth>> moon_light(const ObservingGeometry &g,
                                         const Rotation<Body, Gcrs> &body_from_gcrs,
                                         Vec3<Gcrs> sky_north, std::size_t bands,
                                         const LightOfPoses &light) {
  const Vec3<Gcrs> moon = moon_km(g.time);
  const double irradiance = moon_irradiance(g, moon);
  if (!(irradiance > 0))
    return std::vector<Stokes<SkyNorth>>(bands);
  return light_by({{normalized(moon - g.gcrs_km), irradiance}}, g, body_from_gcrs, sky_north, bands,
                  light);
}

} // namespace umov
