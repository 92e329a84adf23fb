// Wide surfaces lit by narrow lobes and seen in narrow lobes.

#include "light/between/sun_images.h"
#include "light/tests/integrator_cases.h"

#include <complex>
#include <map>

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

double of_three_surfaces(const LampInTwoMirrors &lamp, const Pose &pose, double &half_width,
                         std::size_t most = 1u << 18) {
  const Integrator scene = lamp.scene();
  IntegrationOptions options;
  options.accuracy = 1e-3;
  options.max_points = most;
  options.bounces = 3;
  const PoseResult three = scene.evaluate(pose, options);
  options.bounces = 2;
  const PoseResult two = scene.evaluate(pose, options);
  half_width = std::hypot(three.bands[1].half_width.i, two.bands[1].half_width.i);
  return three.bands[1].stokes.i - two.bands[1].stokes.i;
}

TEST(SunImages, AFloorLitByOneMirrorAndSeenInAnother) {
  const LampInTwoMirrors lamp;
  for (const Pose &pose : {Pose{lamp.sun, lamp.observer, 0}, Pose{lamp.observer, lamp.sun, 0}}) {
    double half_width = 0;
    const double found = of_three_surfaces(lamp, pose, half_width);
    // Lobes of m = 20,000 stray by .014 rad: the patch's radiance is even, its edge is not; .5 %.
    EXPECT_NEAR(found, lamp.intensity(), half_width + 5e-3 * lamp.intensity());
    // Where paths met the lamp by chance it was 28 %, and 270 % from the other end.
    EXPECT_LT(half_width, 0.06 * lamp.intensity());
  }
}

TEST(SunImages, LobesOfMiddlingWidthAreTheSameFromBothEnds) {
  // m = 800: each of the three ways meets the lamp. Chances that do not add up to one would count
  // some light twice, and not the same from the other end. (Reciprocity, Helmholtz 1867.)
  LampInTwoMirrors lamp;
  lamp.gold = interface_of("paper_au", 800);
  double there = 0, back = 0;
  const double a = of_three_surfaces(lamp, {lamp.sun, lamp.observer, 0}, there, 1u << 20),
               b = of_three_surfaces(lamp, {lamp.observer, lamp.sun, 0}, back, 1u << 20);
  EXPECT_NEAR(a, b, std::hypot(there, back));
  EXPECT_LT(std::hypot(there, back), 0.06 * a);
}

/// A body of one material and its images of the Sun.
struct Images {
  Scene scene;
  std::vector<VisibleSides> sides{scene.mesh.triangles.size(), VisibleSides{true, true}};
  BounceScene between{scene, sides};
  SunImages of_sun;
  Images(const Mesh &mesh, const Material &material, Vec3<Body> sun)
      : scene(scene_of(mesh, NormalMode::Flat, {material})), of_sun(&between.mirrors(), sun) {}
};

TEST(SunImages, DirectionsAreDrawnAsOftenAsTheirDensitySays) {
  // The mean of 1/density over what is drawn into a cone is the cone's solid angle, once for each
  // image that the point sees: two lamps of unlike size side by side, from below their seam.
  const LampInTwoMirrors lamp;
  const Vec3<Body> aside = normalized(cross(lamp.lamp_normal, {0, 1, 0}));
  const Mesh small = plate(0.5, lamp.lamp + 0.75 * Vec3<Body>{0, 1, 0}, lamp.lamp_normal, "small");
  const Mesh far = plate(1, lamp.lamp + 9 * aside, lamp.lamp_normal, "far");
  const Mesh large = plate(1, lamp.lamp, lamp.lamp_normal, "large");
  const Images images(joined(joined(large, small), far), lamp.gold, lamp.sun);
  SunImages::Choice from;
  images.of_sun.look_from({-3, 0.5, 1}, from);
  const Vec3<Body> middle = -lamp.down;
  constexpr std::size_t draws = 400'000;
  const double cone = 0.01;
  std::map<std::uint32_t, std::size_t> drawn_of;
  double sum = 0, squares = 0;
  for (std::size_t i = 0; i < draws; ++i) {
    const auto u = uniform4(3, 7, i);
    const SunImages::Drawn drawn = images.of_sun.draw(from, u[0], u[1], u[2]);
    ASSERT_GT(drawn.density, 0);
    ++drawn_of[drawn.part];
    EXPECT_NEAR(drawn.density, images.of_sun.density(from, drawn.part, drawn.to),
                1e-12 * drawn.density);
    if (!(angle_between(drawn.to, middle) < cone))
      continue;
    sum += 1 / drawn.density;
    squares += 1 / (drawn.density * drawn.density);
  }
  EXPECT_EQ(drawn_of.size(), 2u);
  for (const auto &[part, count] : drawn_of)
    EXPECT_GT(count, draws / 10) << part;
  const double mean = sum / draws, sd = std::sqrt(squares / draws - mean * mean) / std::sqrt(draws);
  EXPECT_NEAR(mean, 2 * 2 * pi * (1 - std::cos(cone)), 4 * sd);
  EXPECT_LT(sd, 0.01 * mean);
}

TEST(SunImages, WhatAPointCannotSeeInThemIsLeftOut) {
  const LampInTwoMirrors lamp;
  const Images images(plate(1, lamp.lamp, lamp.lamp_normal, "lamp"), lamp.gold, lamp.sun);
  SunImages::Choice from;
  images.of_sun.look_from({-3, 0, 1}, from);
  EXPECT_FALSE(from.is_empty());
  images.of_sun.look_from({-3, 0, 5}, from); // above the lamp
  EXPECT_TRUE(from.is_empty());
  images.of_sun.look_from({-1, 0, 1}, from); // beside its beam
  EXPECT_TRUE(from.is_empty());
  images.of_sun.look_from(lamp.lamp + 1e-4 * lamp.lamp_normal, from); // on it
  EXPECT_TRUE(from.is_empty());
}

TEST(SunImages, OfManyPartsTheLargestAreKept) {
  Mesh mesh = sheet(0, 10, 0, 10, 0, "large");
  for (int k = 0; k < 1500; ++k) { // one above the other, none alike to the one before
    const double turn = k % 2 == 0 ? 0.2 : -0.2;
    mesh = joined(mesh, moved(sheet(-0.1, 0.1, -0.1, 0.1, 0, "small"), [&](Vec3<Body> p) {
                    return Vec3<Body>{p.x, p.y, turn * p.x + 1 + k};
                  }));
  }
  const Images images(mesh, interface_of("paper_au", 20'000), {0, 0, 1});
  EXPECT_EQ(images.between.mirrors().parts().size(), 1024u);
  Vertex on_large;
  on_large.triangle = 0;
  EXPECT_NE(images.between.mirrors().part_of(on_large), MirrorParts::none);
}

} // namespace
} // namespace umov
