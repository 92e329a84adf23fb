// The body's own heat against closed forms.

#include "light/tests/integrator_cases.h"

#include <complex>
#include <umov/light/thermal.h>
#include <umov/surface/rough_emission.h>

namespace umov {
namespace {

using namespace cases;
using Complex = std::complex<double>;

BandResult thermal_light(const Scene &scene, const std::vector<double> &kelvin, const Pose &pose,
                         std::size_t bounces, double accuracy) {
  const auto emission = ThermalEmission::make(scene, kelvin);
  EXPECT_TRUE(emission) << emission.error().text();
  IntegrationOptions options;
  options.bounces = bounces;
  options.accuracy = accuracy;
  return Integrator(scene).thermal({&pose, 1}, *emission, options, 1).front().bands[1];
}

constexpr double kelvin_of_test = 3000; // bright at 550 nm
double planck_of_test() { return planck_radiance(Wavelength::nm(550), kelvin_of_test); }

TEST(Thermal, APlateShinesAsItsSurfaceDoes) {
  // By `rough_emissivity`, which src/surface/tests holds to Kirchhoff's law; its axis n x v is
  // across the pose's plane here.
  const Scene scene =
      scene_of_sides(corner(2), {interface_of("paper_al", 30), grey(0)}, {grey(0), grey(0)});
  const double theta = 60 * pi / 180;
  const Pose pose{{0, 0, 1}, {std::sin(theta), 0, std::cos(theta)}};
  const BandResult light = thermal_light(scene, {kelvin_of_test, 0}, pose, 1, 1e-3);
  const Emissivity e = rough_emissivity(scene.front[0], 1, theta);
  const double scale = planck_of_test() * std::cos(theta); // 1 m2
  EXPECT_NEAR(light.stokes.i / scale, e.i, 3e-3 * e.i);
  EXPECT_NEAR(light.stokes.q / scale, e.q, 3e-3 * std::abs(e.q));
  EXPECT_LT(e.q, 0);
  EXPECT_NEAR(light.stokes.u / scale, 0, 1e-12);
}

TEST(Thermal, AMirrorShowsItsWarmNeighbour) {
  // The black floor, warm, is seen itself and in the cold wall of gold at 45 deg: B A cos45
  // (1 + F), Q of the image alone, across the plane, from Fresnel's formulae.
  const Material gold = mirror_of("paper_au");
  const Scene scene = scene_of_sides(corner(2), {grey(0), gold}, {grey(0), gold});
  const Pose pose{{0, 0, 1}, normalized(Vec3<Body>{1, 0, 1})};
  const BandResult light = thermal_light(scene, {kelvin_of_test, 0}, pose, 2, 2e-3);
  const Complex eta = index_at(gold.index, Wavelength::nm(550)).value();
  const double c = std::sqrt(0.5);
  const Complex t = std::sqrt(eta * eta - 0.5);
  const double r_s = std::norm((c - t) / (c + t)),
               r_p = std::norm((eta * eta * c - t) / (eta * eta * c + t));
  const double scale = planck_of_test() * c;
  EXPECT_NEAR(light.stokes.i / scale, 1 + (r_s + r_p) / 2, 5e-3);
  EXPECT_NEAR(light.stokes.q / scale, (r_s - r_p) / 2, 5e-3 * (r_s - r_p));
}

TEST(Thermal, ACavityOfOneTemperatureComesToBeBlack) {
  // Inside a sphere each point sees all others alike. With n surfaces the hole sends out
  // B e sum_{k<n} (rho (1 - f))^k, e = 1 - rho, f the hole's part; the cold outside nothing.
  const Cavity c = cavity(8000, 30);
  const double rho = 0.6, f = c.hole_area / c.whole_area;
  // Group by group both sides are equally warm: a white outside sends nothing.
  const Scene scene = scene_of_sides(c.mesh, {grey(1)}, {grey(rho)});
  const Pose pose{{0, 0, 1}, normalized(Vec3<Body>{0.1, 0.2, 1})};
  double sum = 0;
  for (std::size_t n = 1; n <= 12; ++n) {
    sum += std::pow(rho * (1 - f), static_cast<double>(n - 1));
    if (n != 1 && n != 3 && n != 12)
      continue;
    const BandResult light = thermal_light(scene, {kelvin_of_test}, pose, n, 5e-3);
    const double expected = planck_of_test() * (1 - rho) * sum * dot(c.opening, pose.observer);
    EXPECT_NEAR(light.stokes.i / expected, 1, 1.2e-2) << n; // twice the half-width, and chords
  }
  EXPECT_GT((1 - rho) * sum, 0.9); // nearly black
}

TEST(Thermal, AWarmSphereIsUnpolarized) {
  const Scene scene =
      scene_of(make_sphere(1, 2000), NormalMode::Smooth, {interface_of("paper_au", 50)});
  const BandResult light = thermal_light(scene, {kelvin_of_test}, random_pose(3), 1, 2e-3);
  EXPECT_GT(light.stokes.i, 0);
  EXPECT_NEAR(light.stokes.q, 0, light.half_width.q + 2e-3 * light.stokes.i);
  EXPECT_NEAR(light.stokes.u, 0, light.half_width.u + 2e-3 * light.stokes.i);
}

TEST(Thermal, RefusesWhatIsNoTemperature) {
  const Scene scene = scene_of(corner(2), NormalMode::Flat, {grey(0.5)});
  for (const std::vector<double> &bad : std::vector<std::vector<double>>{
           {300}, {300, -1}, {300, std::nan("")}, {300, INFINITY}, {}}) {
    const auto made = ThermalEmission::make(scene, bad);
    ASSERT_FALSE(made);
    EXPECT_EQ(made.error().code, ErrorCode::BadInput);
  }
}

TEST(Thermal, MirrorsEmitWhatTheyDoNotReflect) {
  const Scene scene = scene_of(corner(2), NormalMode::Flat, {mirror_of("paper_al")});
  for (const double theta : {0.0, 30.0, 60.0, 80.0}) {
    const Emissivity smooth =
        smooth_emissivity(scene.front[0].interface(1), std::cos(theta * pi / 180));
    const Emissivity e = rough_emissivity(scene.front[0], 1, theta * pi / 180);
    EXPECT_NEAR(e.i, smooth.i, 1e-12);
    EXPECT_NEAR(e.q, smooth.q, 1e-12);
  }
}

} // namespace
} // namespace umov
