// Wide surfaces lit by narrow lobes and seen in narrow lobes.

#include "light/between/sun_images.h"
#include "light/tests/integrator_cases.h"

#include <complex>

namespace umov {
namespace {

using namespace cases;

/// A square about a normal, one side of it.
Mesh plate(double side, Vec3<Body> centre, Vec3<Body> normal, const std::string &group) {
  const double h = side / 2;
  const Vec3<Body> x = any_perpendicular(normal), y = cross(normal, x);
  return moved(sheet(-h, h, -h, h, 0, group),
               [&](Vec3<Body> p) { return centre + x * p.x + y * p.y; });
}

/// Reflectance for unpolarized light (Born & Wolf 1999, section 1.5).
double reflectance(std::complex<double> eta, double cosine) {
  const std::complex<double> q = std::sqrt(eta * eta - (1 - cosine * cosine));
  return (std::norm((cosine - q) / (cosine + q)) +
          std::norm((eta * eta * cosine - q) / (eta * eta * cosine + q))) /
         2;
}

/// The Sun on a gold plate, from there straight down on a grey floor, which another gold plate
/// shows to the observer, who stands below the floor. A black roof keeps the Sun itself off it.
struct LampInTwoMirrors {
  static constexpr double rho = 0.5, lamp_side = 1, floor_z = 0;
  Vec3<Body> sun = normalized(Vec3<Body>{0.64, 0, 0.77}), down{0, 0, -1};
  Vec3<Body> lamp{-3, 0, 4}, window{8, 0, 3}, observer = normalized(Vec3<Body>{-0.2, 0, -0.98});
  Vec3<Body> seen = normalized(Vec3<Body>{-3, 0, floor_z} - window);
  Vec3<Body> lamp_normal = normalized(sun + down), window_normal = normalized(observer + seen);
  Material gold = interface_of("paper_au", 20'000);

  [[nodiscard]] Mesh mesh() const {
    const Mesh both = joined(plate(lamp_side, lamp, lamp_normal, "lamp"),
                             plate(4, window, window_normal, "window"));
    const Mesh more =
        joined(sheet(-4, -2, -1, 1, floor_z, "floor"), sheet(-1.2, 1, -1.1, 1.1, 3.5, "roof"));
    return joined(both, more);
  }
  [[nodiscard]] Scene of_sides() const {
    const Material black = interface_of("paper_spectralon", 10); // n = 1: all light is gone
    return scene_of_sides(mesh(), {gold, gold, grey(rho), black}, {black, black, black, black});
  }
  [[nodiscard]] Integrator scene() const { return Integrator(of_sides()); }
  /// Light of three surfaces: the floor's patch of radiance rho/pi R_lamp, as the window shows it.
  [[nodiscard]] double intensity() const {
    const std::complex<double> eta = index_at(gold.index, Wavelength::nm(550)).value();
    const double on_lamp = dot(sun, lamp_normal), on_window = dot(observer, window_normal);
    const double patch_m2 = lamp_side * lamp_side * on_lamp; // the beam's, which meets it upright
    return rho / pi * reflectance(eta, on_lamp) * reflectance(eta, on_window) * patch_m2 * -seen.z;
  }
};

double of_three_surfaces(const LampInTwoMirrors &lamp, const Pose &pose, double &half_width) {
  const Integrator scene = lamp.scene();
  IntegrationOptions options;
  options.accuracy = 1e-3;
  options.max_points = 1u << 18;
  options.bounces = 3;
  const PoseResult three = scene.evaluate(pose, options);
  options.bounces = 2;
  const PoseResult two = scene.evaluate(pose, options);
  half_width = std::hypot(three.bands[1].half_width.i, two.bands[1].half_width.i);
  return three.bands[1].stokes.i - two.bands[1].stokes.i;
}

TEST(SunImages, AFloorLitByOneMirrorAndSeenInAnother) {
  const LampInTwoMirrors lamp;
  double half_width = 0;
  const double found = of_three_surfaces(lamp, {lamp.sun, lamp.observer, 0}, half_width);
  // Lobes of m = 20,000 stray by .014 rad: the patch's radiance is even, its edge is not; .5 %.
  EXPECT_NEAR(found, lamp.intensity(), half_width + 5e-3 * lamp.intensity());
  // Where paths met the lamp by chance it was 28 %, and 270 % from the other end.
  EXPECT_LT(half_width, 0.06 * lamp.intensity());
}

TEST(SunImages, TheSameSeenFromTheSunsPlace) {
  const LampInTwoMirrors lamp;
  double half_width = 0;
  const double found = of_three_surfaces(lamp, {lamp.observer, lamp.sun, 0}, half_width);
  EXPECT_NEAR(found, lamp.intensity(), half_width + 5e-3 * lamp.intensity());
  EXPECT_LT(half_width, 0.06 * lamp.intensity());
}

TEST(SunImages, DirectionsAreDrawnAsOftenAsTheirDensitySays) {
  // The mean of 1/density over what is drawn into a cone is the cone's solid angle.
  const LampInTwoMirrors lamp;
  const Scene scene = lamp.of_sides();
  const std::vector<VisibleSides> sides(scene.mesh.triangles.size(), VisibleSides{true, true});
  const BounceScene between(scene, sides);
  const SunImages images(between.mirrors(), lamp.sun);
  SunImages::Choice from;
  images.look_from({-3.1, 0.2, 1e-6}, from);
  ASSERT_FALSE(from.is_empty());
  const Vec3<Body> middle = -lamp.down;
  constexpr std::size_t draws = 200'000;
  const double cone = 0.01;
  double sum = 0, squares = 0;
  for (std::size_t i = 0; i < draws; ++i) {
    const auto u = uniform4(3, 7, i);
    const SunImages::Drawn drawn = images.draw(from, u[0], u[1], u[2]);
    if (!(angle_between(drawn.to, middle) < cone))
      continue;
    EXPECT_NEAR(drawn.density, images.density(from, drawn.part, drawn.to), 1e-12 * drawn.density);
    sum += 1 / drawn.density;
    squares += 1 / (drawn.density * drawn.density);
  }
  const double mean = sum / draws, sd = std::sqrt(squares / draws - mean * mean) / std::sqrt(draws);
  EXPECT_NEAR(mean, 2 * pi * (1 - std::cos(cone)), 4 * sd);
  EXPECT_LT(sd, 0.01 * mean);
}

TEST(SunImages, WhatAPointCannotSeeInThemIsLeftOut) {
  const LampInTwoMirrors lamp;
  const Scene scene = lamp.of_sides();
  const std::vector<VisibleSides> sides(scene.mesh.triangles.size(), VisibleSides{true, true});
  const BounceScene between(scene, sides);
  const SunImages images(between.mirrors(), lamp.sun);
  SunImages::Choice from;
  images.look_from({-3, 0, 5}, from); // above the lamp
  EXPECT_TRUE(from.is_empty());
  images.look_from({-1, 0, 1e-6}, from); // beside its beam
  EXPECT_TRUE(from.is_empty());
}

} // namespace
} // namespace umov
