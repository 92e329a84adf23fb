// Brightness along a pass, against closed forms.

#include <umov/lightcurve/pass_light.h>

#include "light/tests/integrator_cases.h"
#include "observation/tests/straight_line.h"

#include <umov/photometry/radiometry.h>
#include <umov/shape/primitives.h>

namespace umov {
namespace {

using namespace cases;

const StraightLine overhead("2018-03-20T06:30:00.5Z");

const std::vector<Band> bands{three_bands()[1]};

/// Made once: it is lit at 361 phase angles.
const PassLight &white_sphere() {
  static const PassLight sphere = PassLight::of_sphere(2, white_lambert(), bands).value();
  return sphere;
}

std::vector<ObservingGeometry> samples() {
  const Track track = Track::make(overhead.request()).value();
  std::vector<ObservingGeometry> out;
  for (double s = 0; s <= 600; s += 10)
    out.push_back(track.observe(plus_seconds(overhead.start, s)).value());
  return out;
}

PassBrightness described(const PassLight &light, const std::vector<ObservingGeometry> &at) {
  const auto pass =
      light.describe(overhead.trajectory(), origin_site, ShadowModel::Ellipsoid, 0, at);
  EXPECT_TRUE(pass) << pass.error().text();
  return pass.value_or(PassBrightness());
}

/// A white Lambert sphere: J = 2/(3 pi) r^2 (sin a + (pi - a) cos a) (Russell 1916).
double sphere_magnitude(double radius_m, const ObservingGeometry &g, const Band &band) {
  const double a = g.phase_angle.radians();
  const double intensity =
      2 / (3 * pi) * radius_m * radius_m * (std::sin(a) + (pi - a) * std::cos(a));
  const LightPath path{g.sun_distance_km, g.range_km, g.sunlit};
  return observed_light(intensity, photometric_bands({band}, MagnitudeSystem::AB)->front(), path)
      .magnitude;
}

TEST(PassLight, ALambertSphereFollowsItsPhaseFunction) {
  const auto at = samples();
  double low = 1e9, high = -1e9;
  for (const ObservingGeometry &g : at) {
    low = std::min(low, sphere_magnitude(2, g, bands[0]));
    high = std::max(high, sphere_magnitude(2, g, bands[0]));
  }
  const PassBrightness pass = described(white_sphere(), at);
  // 5000 facets and steps of half a degree: 2 % of I.
  EXPECT_NEAR(pass.magnitude_min, low, 0.02);
  EXPECT_NEAR(pass.magnitude_max, high, 0.02);
  EXPECT_NEAR(pass.p_max, 0, 1e-6); // Lambert's light has no polarization
  EXPECT_TRUE(pass.glints.empty());
}

TEST(PassLight, ABodyThatIsASphereIsLitLikeOne) {
  const auto at = samples();
  Diagnostics diagnostics;
  const auto scene = make_scene(make_sphere(2, 5000), NormalMode::Smooth, bands, {white_lambert()},
                                {white_lambert()}, diagnostics);
  ASSERT_TRUE(scene) << scene.error().text();
  const auto body =
      PassLight::of_body({*scene, {TwoAxisLaw{}}, {}}, pass_light_options(LightMethod::Rays));
  ASSERT_TRUE(body) << body.error().text();
  const PassBrightness a = described(*body, at), b = described(white_sphere(), at);
  EXPECT_NEAR(a.magnitude_min, b.magnitude_min, 0.03);
  EXPECT_NEAR(a.magnitude_max, b.magnitude_max, 0.03);
}

/// A glossy cylinder about +Z that turns end over end in 47 s: its side flashes twice a turn, for
/// some two seconds, and no flat of it does, whose glint would be found by itself.
PassLight turning_cylinder() {
  Diagnostics diagnostics;
  const Mesh mesh = make_cylinder(1, 4, 48);
  const std::vector<Material> metal(mesh.groups.size(), interface_of("paper_al", 60));
  const auto scene = make_scene(mesh, NormalMode::Smooth, bands, metal, metal, diagnostics);
  EXPECT_TRUE(scene) << scene.error().text();
  const SpinLaw spin{InertialLaw{}, {1, 0, 0}, 2 * pi / 47, overhead.start};
  PassBody body{*scene, {spin}, {}};
  return PassLight::of_body(std::move(body), pass_light_options()).value();
}

std::vector<ObservingGeometry> samples_apart(double step_s) {
  const Track track = Track::make(overhead.request()).value();
  std::vector<ObservingGeometry> out;
  for (double s = 200; s <= 400; s += step_s)
    out.push_back(track.observe(plus_seconds(overhead.start, s)).value());
  return out;
}

TEST(PassLight, TheTopBetweenSamplesIsFound) {
  const PassLight light = turning_cylinder();
  const auto coarse = samples_apart(5), fine = samples_apart(0.1);
  // One sample alone has nothing beside it: the brightest of the samples as they are.
  double of_samples = 1e9;
  for (const ObservingGeometry &g : coarse)
    of_samples = std::fmin(of_samples, described(light, {g}).magnitude_min);
  const PassBrightness found = described(light, coarse), truth = described(light, fine);
  EXPECT_GT(of_samples, truth.magnitude_min + 0.1); // else this shows nothing
  // Accuracy .02 of I on both sides, and the top of steps of 1/49 of 5 s.
  EXPECT_NEAR(found.magnitude_min, truth.magnitude_min, 0.05);
}

TEST(PassLight, WhatIsNeverLitHasNoMagnitude) {
  auto at = samples();
  for (ObservingGeometry &g : at)
    g.sunlit = 0;
  const PassBrightness pass = described(white_sphere(), at);
  EXPECT_TRUE(std::isnan(pass.magnitude_min));
  EXPECT_TRUE(std::isnan(pass.p_max));
}

} // namespace
} // namespace umov
