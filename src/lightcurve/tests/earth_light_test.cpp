// Earthshine on simple bodies against integrals of its own.

#include <umov/lightcurve/earth_light.h>

#include "core/tests/anchors.h"
#include "light/tests/integrator_cases.h"

#include <cmath>
#include <umov/frames/sky.h>
#include <umov/light/engine.h>
#include <umov/orbit/moon.h>
#include <umov/photometry/earthshine.h>

namespace umov {
namespace {

using namespace cases;

/// An object above the equator, the Sun at an angle from its zenith, seen from a direction.
ObservingGeometry geometry(double height_km, double sun_zenith_deg, Vec3<Gcrs> to_observer) {
  ObservingGeometry g;
  const double z = Angle::degrees(sun_zenith_deg).radians();
  g.gcrs_km = {6378.137 + height_km, 0, 0};
  g.sun_gcrs_km = Vec3<Gcrs>{std::cos(z), 0, std::sin(z)} * 1.496e8;
  g.to_sun = normalized(g.sun_gcrs_km - g.gcrs_km);
  g.to_observer = normalized(to_observer);
  return g;
}

LightOfPoses asked_of(const Engine &engine) {
  return [&engine](const std::vector<Pose> &poses) {
    StokesTable table;
    engine.evaluate(poses, table);
    std::vector<std::vector<BandResult>> out(poses.size());
    for (std::size_t k = 0; k < poses.size(); ++k)
      for (std::size_t b = 0; b < table.bands; ++b)
        out[k].push_back(table.at(k, b));
    return out;
  };
}

SourceLight light_of(const Scene &scene, const ObservingGeometry &g,
                     const Rotation<Body, Gcrs> &body, EarthshineOptions options,
                     Vec3<Gcrs> north = {0, 0, 1}) {
  const Engine engine(scene, EngineOptions{});
  options.narrowest_lobe = narrowest_lobe(scene);
  return earth_light(g, body, north, options, scene.bands.size(), asked_of(engine));
}

/// The plain sum of one band's light over very many equal patches, a spiral over the cap.
Stokes<SkyNorth> brute_force(const Scene &scene, const ObservingGeometry &g,
                             const Rotation<Body, Gcrs> &body, std::size_t count, std::size_t band,
                             double albedo, Vec3<Gcrs> north = {0, 0, 1}) {
  const double distance = norm(g.gcrs_km), radius = 6378.137;
  const double cos_limb = std::sqrt(1 - std::pow(radius / distance, 2));
  const Vec3<Gcrs> down = -1 * g.gcrs_km / distance, x = any_perpendicular(down),
                   y = cross(down, x), sun = normalized(g.sun_gcrs_km);
  const double solid = 2 * pi * (1 - cos_limb) / static_cast<double>(count);
  std::vector<Pose> poses;
  std::vector<Vec3<Gcrs>> from;
  std::vector<double> weight;
  for (std::size_t k = 0; k < count; ++k) {
    const double c = 1 -
                     (1 - cos_limb) * (static_cast<double>(k) + 0.5) / static_cast<double>(count),
                 s = std::sqrt(1 - c * c),
                 turn = pi * (3 - std::sqrt(5.0)) * static_cast<double>(k);
    const Vec3<Gcrs> d = down * c + x * (s * std::cos(turn)) + y * (s * std::sin(turn));
    const double along =
        distance * c - std::sqrt(std::max(0.0, std::pow(radius, 2) - std::pow(distance * s, 2)));
    const double lit = dot(normalized(g.gcrs_km + d * along), sun);
    if (lit <= 0)
      continue;
    poses.push_back({normalized(body * d), normalized(body * g.to_observer), 0});
    from.push_back(d);
    weight.push_back(albedo / pi * lit * solid);
  }
  const Engine engine(scene, EngineOptions{});
  const auto results = asked_of(engine)(poses);
  Stokes<SkyNorth> out;
  for (std::size_t k = 0; k < poses.size(); ++k) {
    const Angle axis =
        position_angle(scattering_normal(g.to_observer, from[k]), north, g.to_observer);
    out +=
        rotate_to<SkyNorth>(results[k][band].stokes, Angle::radians(-axis.radians())) * weight[k];
  }
  return out;
}

/// Body z towards the Earth.
const Rotation<Body, Gcrs> nadir(Vec3<Gcrs>{0, 1, 0}, Vec3<Gcrs>{0, 0, -1}, Vec3<Gcrs>{-1, 0, 0});

TEST(EarthLight, LambertPlateOverTheSubsolarPoint) {
  // Albedo .3, 500 km above the subsolar point, 60 deg from it, and GEO. A white Lambert plate of
  // 1 m2 sends the irradiance of the anchors' facet over pi per sr.
  const Scene plate = scene_of(make_plate(1, 1, false), NormalMode::Flat, {white_lambert()});
  for (const AnchorRow &row : Anchors("earthshine")) {
    const double height = row["radius_km"] - 6378.137;
    const double cosine = std::cos(0.4);
    const auto g = geometry(height, row["zenith_deg"], {-cosine, std::sin(0.4), 0});
    const auto light = light_of(plate, g, nadir, {.patches = 4000});
    // 4,000 patches: the terminator and the limb cut some of them, 1e-3.
    EXPECT_NEAR(light.stokes[1].i / (row["facet"] * cosine / pi), 1, 1e-3) << height;
  }
}

TEST(EarthLight, TwoHundredPatchesAreEnough) {
  // A sphere of the paper's aluminium: the default against twenty times as many.
  const Scene sphere =
      scene_of(make_sphere(1, 2000), NormalMode::Smooth, {builtin_material("paper_al").value()});
  for (const double zenith : {0.0, 70.0, 95.0}) {
    const auto g = geometry(600, zenith, {-0.3, 0.8, 0.4});
    const auto few = light_of(sphere, g, nadir, {}).stokes;
    const auto many = light_of(sphere, g, nadir, {.patches = 4000}).stokes;
    // Past the terminator a sliver of the Earth is lit, by a dozen patches, and hardly shines.
    EXPECT_NEAR(few[1].i / many[1].i, 1, zenith > 90 ? 0.05 : 0.01) << zenith;
    EXPECT_NEAR(few[1].q / few[1].i, many[1].q / many[1].i, 2e-3) << zenith;
    EXPECT_NEAR(few[1].u / few[1].i, many[1].u / many[1].i, 2e-3) << zenith;
  }
}

TEST(EarthLight, PolarizationIsThatOfSymmetry) {
  // Sun at the zenith: everything is symmetric about the plane of observer and vertical, so that
  // in its axes there is Q alone; and turning the axes turns Q into U.
  const Scene sphere =
      scene_of(make_sphere(1, 2000), NormalMode::Smooth, {builtin_material("paper_al").value()});
  const Vec3<Gcrs> v = normalized(Vec3<Gcrs>{-0.3, 0.8, 0});
  const auto g = geometry(600, 0, v);
  const EarthshineOptions fine{.patches = 2000};
  const Vec3<Gcrs> across{0, 0, 1}; // the normal of that plane
  const auto straight = light_of(sphere, g, nadir, fine, across).stokes[1];
  EXPECT_GT(straight.q / straight.i, 0.005); // a metal: across the plane of reflection
  EXPECT_LT(std::abs(straight.u / straight.i), 1e-3);
  const double turn = 0.3;
  const Vec3<Gcrs> other = across * std::cos(turn) + cross(v, across) * std::sin(turn);
  const auto turned = light_of(sphere, g, nadir, fine, other).stokes[1];
  EXPECT_NEAR(turned.q, straight.q * std::cos(2 * turn) + straight.u * std::sin(2 * turn), 1e-12);
  EXPECT_NEAR(turned.u, straight.u * std::cos(2 * turn) - straight.q * std::sin(2 * turn), 1e-12);
}

/// Gold with a lobe of its own, nothing else.
Material lobe_of(const char *model, const char *number, double value) {
  Material out = builtin_material("paper_au").value();
  out.distribution = {model, {{number, value}}, {}, {}};
  out.body.reset();
  return out;
}

TEST(EarthLight, NarrowLobesAgreeWithTheBruteSum) {
  // Lobes of 1 to 3 degrees see the Earth's disk as points of 8 degrees if its 200 patches stay
  // whole: the sum was off 3 to 4 times. Expected: 300,000 patches, a quarter of a degree each.
  const struct {
    const char *model, *number;
    double value;
  } lobes[] = {{"blinn_phong", "m", 1000}, {"blinn_phong", "m", 5000}, {"ggx", "alpha", 0.02}};
  const Mesh plate = make_plate(1, 1, false), cube = make_chamfered_cube(1, 0.1);
  std::size_t inside = 0, all = 0;
  for (const auto &lobe : lobes)
    for (const Mesh *mesh : {&plate, &cube})
      for (const double zenith : {20.0, 80.0, 95.0})
        for (const Vec3<Gcrs> to : {Vec3<Gcrs>{-0.7, 0.2, 0.3}, Vec3<Gcrs>{-0.9, -0.4, -0.1}}) {
          const Scene scene =
              scene_of(*mesh, NormalMode::Flat, {lobe_of(lobe.model, lobe.number, lobe.value)});
          const auto g = geometry(600, zenith, to);
          const auto found = light_of(scene, g, nadir, {});
          const auto expected = brute_force(scene, g, nadir, 300'000, 1, 0.3);
          if (expected.i < 1e-6) // a magnitude of 30 at 1,000 km: tails that no one sees
            continue;
          const auto light = found.stokes[1], error = found.half_width[1];
          const std::string what = std::string(lobe.model) + " " + std::to_string(lobe.value) +
                                   " zenith " + std::to_string(zenith) + " sources " +
                                   std::to_string(found.sources);
          EXPECT_NEAR(light.i / expected.i, 1, 0.02) << what;
          EXPECT_NEAR(light.q / light.i, expected.q / expected.i, 0.01) << what;
          EXPECT_NEAR(light.u / light.i, expected.u / expected.i, 0.01) << what;
          EXPECT_LT(error.i, 0.03 * light.i) << what;
          for (const double ratio :
               {std::abs(light.i - expected.i) / error.i, std::abs(light.q - expected.q) / error.q,
                std::abs(light.u - expected.u) / error.u}) {
            ++all;
            inside += ratio <= 1 ? 1u : 0u;
          }
        }
  EXPECT_GE(static_cast<double>(inside), 0.95 * static_cast<double>(all));
}

TEST(EarthLight, AMirrorShowsThePlaceThatItReflects) {
  // The image of the ground has the ground's radiance albedo/pi cos(Sun) times Fresnel's
  // reflectance (Born & Wolf 1999, Eqs. 1.5.20-21): all of it from one point of the disk.
  Material gold = lobe_of("blinn_phong", "m", 200);
  gold.distribution = {"mirror", {}, {}, {}};
  const Scene plate = scene_of(make_plate(1, 1, false), NormalMode::Flat, {gold});
  for (const Vec3<Gcrs> to :
       {Vec3<Gcrs>{-0.9, -0.3, 0.2}, Vec3<Gcrs>{-0.8, 0.1, 0.4}, Vec3<Gcrs>{-0.95, 0.2, -0.1}}) {
    const auto g = geometry(600, 30, to);
    const Vec3<Gcrs> n{-1, 0, 0}, from = 2 * dot(n, g.to_observer) * n - g.to_observer;
    const double distance = norm(g.gcrs_km), c = -dot(from, normalized(g.gcrs_km));
    const double along =
        distance * c - std::sqrt(std::pow(6378.137, 2) - distance * distance * (1 - c * c));
    const double sun = dot(normalized(g.gcrs_km + along * from), normalized(g.sun_gcrs_km));
    const double cosine = dot(n, g.to_observer);
    const double reflectance = plate.front[0].fresnel(1, 2 * cosine * cosine - 1).a;
    const double expected = reflectance * cosine * 0.3 / pi * sun;
    const auto found = light_of(plate, g, nadir, {});
    EXPECT_NEAR(found.stokes[1].i / expected, 1, 0.05) << found.half_width[1].i / expected;
    EXPECT_LT(std::abs(found.stokes[1].i - expected), found.half_width[1].i);
  }
}

TEST(EarthLight, ConvergesWithTheAccuracyAndSaysWhereTheBoundIs) {
  const Scene plate =
      scene_of(make_plate(1, 1, false), NormalMode::Flat, {lobe_of("blinn_phong", "m", 2000)});
  const auto g = geometry(600, 80, {-0.7, 0.2, 0.3});
  const double expected = brute_force(plate, g, nadir, 300'000, 1, 0.3).i;
  std::size_t before = 0;
  for (const double accuracy : {0.1, 0.02, 0.005}) {
    const auto found = light_of(plate, g, nadir, {.accuracy = accuracy});
    EXPECT_NEAR(found.stokes[1].i / expected, 1, accuracy);
    EXPECT_GT(found.sources, before);
    before = found.sources;
  }
  const auto bound = light_of(plate, g, nadir, {.patches = 10, .accuracy = 1e-4});
  EXPECT_LE(bound.sources, 10 * patches_bound);
  EXPECT_GT(bound.half_width[1].i, 1e-4 * bound.stokes[1].i);
  EXPECT_LT(std::abs(bound.stokes[1].i - expected), bound.half_width[1].i);
}

TEST(MoonLight, IsThatOfTheMoonOverhead) {
  // Full Moon: V = -12.73 against -26.74 of the Sun (Krisciunas & Schaefer 1991): 10^(-0.4 14.01);
  // at 90 deg of phase 2.60 mag less.
  auto g = geometry(500, 180, {0, 1, 0});
  const Vec3<Gcrs> above = normalized(g.gcrs_km) * (384400 + norm(g.gcrs_km));
  EXPECT_NEAR(moon_irradiance(g, above) / 2.4889e-6, 1, 2e-3);
  auto half = geometry(500, 90, {0, 1, 0});
  EXPECT_NEAR(moon_irradiance(half, above) / 2.4889e-6, std::pow(10, -0.4 * 2.602), 2e-3);
  EXPECT_EQ(moon_irradiance(g, -1 * above), 0); // behind the Earth
  // A Lambert plate that faces it, seen from its normal: irradiance over pi.
  const Scene plate = scene_of(make_plate(1, 1, false), NormalMode::Flat, {white_lambert()});
  g.time =
      *utc_from_iso("2018-01-31T13:30:00Z"); // a full Moon, eclipsed, which the formula ignores
  const Vec3<Gcrs> moon = moon_km(g.time), to_moon = normalized(moon);
  g.gcrs_km = to_moon * 7000;
  g.sun_gcrs_km = apparent_sun_km(g.time);
  g.to_observer = to_moon;
  const Vec3<Gcrs> x = any_perpendicular(to_moon);
  const Rotation<Body, Gcrs> facing(x, cross(to_moon, x), to_moon);
  const Engine engine(plate, EngineOptions{});
  const auto light = moon_light(g, facing, {0, 0, 1}, 3, [&](const std::vector<Pose> &poses) {
    StokesTable table;
    engine.evaluate(poses, table);
    std::vector<std::vector<BandResult>> out(1);
    for (std::size_t b = 0; b < 3; ++b)
      out[0].push_back(table.at(0, b));
    return out;
  });
  EXPECT_NEAR(light.stokes[1].i / (moon_irradiance(g, moon) / pi), 1, 1e-3);
  EXPECT_GT(moon_irradiance(g, moon), 2e-6);
}

TEST(EarthLight, NothingOverTheNightSide) {
  const Scene plate = scene_of(make_plate(1, 1, false), NormalMode::Flat, {white_lambert()});
  EXPECT_EQ(light_of(plate, geometry(500, 150, {-1, 0.1, 0}), nadir, {}).stokes[1].i, 0);
}

} // namespace
} // namespace umov
