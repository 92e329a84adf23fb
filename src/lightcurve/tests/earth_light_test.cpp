// Earthshine on simple bodies against integrals of its own.

#include <umov/lightcurve/earth_light.h>

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

std::vector<Stokes<SkyNorth>> light_of(const Scene &scene, const ObservingGeometry &g,
                                       const Rotation<Body, Gcrs> &body, std::size_t patches,
                                       Vec3<Gcrs> north = {0, 0, 1}) {
  const Engine engine(scene, EngineOptions{});
  return earth_light(g, body, north, {0.3, patches}, scene.bands.size(),
                     [&](const std::vector<Pose> &poses) {
                       StokesTable table;
                       engine.evaluate(poses, table);
                       std::vector<std::vector<BandResult>> out(poses.size());
                       for (std::size_t k = 0; k < poses.size(); ++k)
                         for (std::size_t b = 0; b < table.bands; ++b)
                           out[k].push_back(table.at(k, b));
                       return out;
                     });
}

/// Body z towards the Earth.
const Rotation<Body, Gcrs> nadir(Vec3<Gcrs>{0, 1, 0}, Vec3<Gcrs>{0, 0, -1}, Vec3<Gcrs>{-1, 0, 0});

TEST(EarthLight, LambertPlateOverTheSubsolarPoint) {
  // physics page, section 8: albedo .3, 500 km above the subsolar point the facet gets .256499, 60
  // deg from it .128249; GEO .0050747. A white Lambert plate of 1 m2 sends that over pi per sr.
  const Scene plate = scene_of(make_plate(1, 1, false), NormalMode::Flat, {white_lambert()});
  const struct {
    double height, zenith, expected;
  } rows[] = {{500, 0, .256499}, {500, 60, .128249}, {35786, 0, .0050747}};
  for (const auto &row : rows) {
    const double cosine = std::cos(0.4);
    const auto g = geometry(row.height, row.zenith, {-cosine, std::sin(0.4), 0});
    const auto light = light_of(plate, g, nadir, 4000);
    // 4,000 patches: the terminator and the limb cut some of them, 1e-3.
    EXPECT_NEAR(light[1].i / (row.expected * cosine / pi), 1, 1e-3) << row.height;
  }
}

TEST(EarthLight, TwoHundredPatchesAreEnough) {
  // A sphere of the paper's aluminium: the default against twenty times as many.
  const Scene sphere =
      scene_of(make_sphere(1, 2000), NormalMode::Smooth, {builtin_material("paper_al").value()});
  for (const double zenith : {0.0, 70.0, 95.0}) {
    const auto g = geometry(600, zenith, {-0.3, 0.8, 0.4});
    const auto few = light_of(sphere, g, nadir, 200), many = light_of(sphere, g, nadir, 4000);
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
  const Vec3<Gcrs> across{0, 0, 1}; // the normal of that plane
  const auto straight = light_of(sphere, g, nadir, 2000, across)[1];
  EXPECT_GT(straight.q / straight.i, 0.005); // a metal: across the plane of reflection
  EXPECT_LT(std::abs(straight.u / straight.i), 1e-3);
  const double turn = 0.3;
  const Vec3<Gcrs> other = across * std::cos(turn) + cross(v, across) * std::sin(turn);
  const auto turned = light_of(sphere, g, nadir, 2000, other)[1];
  EXPECT_NEAR(turned.q, straight.q * std::cos(2 * turn) + straight.u * std::sin(2 * turn), 1e-12);
  EXPECT_NEAR(turned.u, straight.u * std::cos(2 * turn) - straight.q * std::sin(2 * turn), 1e-12);
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
  EXPECT_NEAR(light[1].i / (moon_irradiance(g, moon) / pi), 1, 1e-3);
  EXPECT_GT(moon_irradiance(g, moon), 2e-6);
}

TEST(EarthLight, NothingOverTheNightSide) {
  const Scene plate = scene_of(make_plate(1, 1, false), NormalMode::Flat, {white_lambert()});
  EXPECT_EQ(light_of(plate, geometry(500, 150, {-1, 0.1, 0}), nadir, 200)[1].i, 0);
}

} // namespace
} // namespace umov
