// Light between surfaces against closed forms.

#include "light/tests/integrator_cases.h"

#include <complex>
#include <numeric>

namespace umov {
namespace {

using namespace cases;

constexpr double solar_radius_of_test = 0.2665 * pi / 180;

Material black() { // n = 1 and nothing below: all light is gone
  Material out = builtin_material("paper_spectralon").value();
  out.body.reset();
  return out;
}

TEST(Bounces, WhiteCavityThroughItsHole) {
  // Inside a sphere each point sees all others alike: the light of k surfaces comes out with
  // J_k = phi rho^k (1 - f)^(k - 2) A_hole cos v / (pi A), phi what enters, f = A_hole/A, k >= 2.
  const Cavity c = cavity(20'000, 50);
  const double rho = 0.8, f = c.hole_area / c.whole_area;
  const Integrator integrator(scene_of_sides(c.mesh, {black()}, {grey(rho)}));
  const Pose pose{normalized(Vec3<Body>{0.2, 0, 1}), normalized(Vec3<Body>{-0.1, 0.2, 1})};
  IntegrationOptions options;
  options.accuracy = 0.002;
  options.max_points = 1u << 18;
  double expected = 0;
  for (const std::size_t bounces : {2u, 3u, 5u, 12u}) {
    options.bounces = bounces;
    const PoseResult light = integrator.evaluate(pose, options);
    expected = 0;
    for (std::size_t k = 2; k <= bounces; ++k)
      expected +=
          std::pow(rho, static_cast<double>(k)) * std::pow(1 - f, static_cast<double>(k) - 2);
    expected *= dot(c.opening, pose.sun) * dot(c.opening, pose.observer) / (pi * c.whole_area);
    // Chords for arcs: 20,000 facets are 0.1 % short of the sphere, some of it per bounce.
    const double sure = light.bands[1].half_width.i / expected;
    EXPECT_NEAR(light.indirect[1].i / expected, 1, 1.5 * sure + 5e-3) << bounces;
    EXPECT_LT(sure, 0.05);
    EXPECT_LT(std::abs(light.indirect[1].q), 2e-3 * light.indirect[1].i); // Lambert: unpolarized
    EXPECT_LT(std::abs(light.indirect[1].v), 1e-12);
  }
}

TEST(Bounces, AConvexMeshHasDirectLightAlone) {
  const Integrator cube(scene_of(make_chamfered_cube(1, 0.1), NormalMode::Flat,
                                 {builtin_material("paper_al").value()}));
  IntegrationOptions direct, deep;
  deep.bounces = 6;
  for (std::uint64_t i = 0; i < 20; ++i) {
    const auto a = cube.evaluate(random_pose(i), direct), b = cube.evaluate(random_pose(i), deep);
    EXPECT_EQ(a.bands[1].stokes.i, b.bands[1].stokes.i);
    EXPECT_EQ(a.bands[1].stokes.q, b.bands[1].stokes.q);
  }
}

TEST(Bounces, TwoLambertPlatesByTheirFormFactor) {
  // Sun along the wall's plane lights the floor alone, the observer along the floor's plane sees
  // the wall alone; the form factor of two squares with a common edge at a right angle is 0.200044
  // (Siegel & Howell 2002, configuration 16).
  const double rho = 0.6;
  const Integrator plates(scene_of(corner(), NormalMode::Flat, {grey(rho)}));
  const Pose pose{{0, 0, 1}, {1, 0, 0}};
  IntegrationOptions options;
  options.accuracy = 1e-3;
  options.bounces = 2;
  const PoseResult light = plates.evaluate(pose, options);
  const double floor_exitance = rho, wall_flux = floor_exitance * 0.200044;
  EXPECT_NEAR(light.bands[1].stokes.i, rho * wall_flux / pi, 3e-3 * rho * wall_flux / pi);
  EXPECT_EQ(light.indirect[1].i, light.bands[1].stokes.i);
}

TEST(Bounces, ShinyPlatesAgreeFromBothEnds) {
  // Reciprocity: Sun and observer exchanged give the transposed matrix with signs, so the same I, Q
  // and the same V, U with the other sign, within the errors.
  const Material metal = interface_of("paper_au", 60);
  const Integrator plates(scene_of(corner(), NormalMode::Flat, {metal}));
  IntegrationOptions options;
  options.accuracy = 4e-3;
  options.max_points = 1u << 17;
  options.bounces = 3;
  for (std::uint64_t i = 0; i < 8; ++i) {
    const auto u = uniform4(5, 1, i);
    const auto inside = [](double x, double y) {
      return normalized(Vec3<Body>{0.2 + x, 0.6 * (y - 0.5), 0.9 - 0.5 * x});
    };
    const Pose there{inside(u[0], u[1]), inside(u[2], u[3])};
    const Pose back{there.observer, there.sun};
    const auto a = plates.evaluate(there, options).bands[1],
               b = plates.evaluate(back, options).bands[1];
    // Half-widths of both, twice: eight poses.
    EXPECT_NEAR(a.stokes.i, b.stokes.i, 2 * (a.half_width.i + b.half_width.i)) << i;
    EXPECT_GT(a.stokes.i, 0);
    EXPECT_LE(std::hypot(a.stokes.q, a.stokes.u, a.stokes.v), a.stokes.i * (1 + 1e-9));
  }
}

using Complex = std::complex<double>;
using Field = std::array<Complex, 3>; // of a plane wave, body axes

Field along_axis(Vec3<Body> axis, Complex amplitude) {
  return {amplitude * axis.x, amplitude * axis.y, amplitude * axis.z};
}
Complex component(const Field &e, Vec3<Body> axis) {
  return e[0] * axis.x + e[1] * axis.y + e[2] * axis.z;
}

/// A field reflected at a smooth interface (Born & Wolf 1999, section 1.5), in three dimensions.
Field reflected(const Field &e, Vec3<Body> k_in, Vec3<Body> k_out, Complex eta) {
  const Vec3<Body> s = normalized(cross(k_in, k_out)), p_in = cross(k_in, s),
                   p_out = cross(k_out, s);
  const double c = std::cos(angle_between(-k_in, k_out) / 2), sine2 = 1 - c * c;
  const Complex q = std::sqrt(eta * eta - sine2);
  const Complex r_s = (c - q) / (c + q), r_p = (eta * eta * c - q) / (eta * eta * c + q);
  const Field a = along_axis(s, r_s * component(e, s)),
              b = along_axis(p_out, r_p * component(e, p_in));
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}

TEST(Bounces, TwoMirrorsOutOfOnePlaneAgainstFields) {
  // Floor and wall of gold at a right angle; the Sun where both reflections bring it to the
  // observer.
  const Material gold = mirror_of("paper_au");
  const Complex eta = index_at(gold.index, Wavelength::nm(550)).value();
  const Integrator plates(scene_of(corner(), NormalMode::Flat, {gold}));
  IntegrationOptions options;
  options.bounces = 2;
  options.accuracy = 0.05;
  for (int k = 0; k < 10; ++k) {
    const Vec3<Body> v = normalized(Vec3<Body>{0.52 + 0.05 * k, 0.31 - 0.05 * k, 0.7});
    // Reflected at the floor (z) and the wall (x), in either order.
    const Vec3<Body> sun{v.x, -v.y, v.z};
    const Pose pose{sun, v, solar_radius_of_test};
    const BandResult light = plates.evaluate(pose, options).bands[1];
    ASSERT_GT(light.stokes.i, 0) << k;
    // Both orders: floor first, and wall first. Their intensities add, with their areas, which the
    // program finds; by symmetry of the incidence angles each order has the same I per area only if
    // the angles are: compared is the mixture that fits I.
    std::array<Stokes<ScatteringPlane>, 2> order{};
    const Vec3<Body> s = normalized(cross(v, sun)), p_sun = cross(-sun, s), p_v = cross(v, s);
    for (int first = 0; first < 2; ++first) {
      const Vec3<Body> middle =
          first == 0 ? Vec3<Body>{-sun.x, -sun.y, sun.z} : Vec3<Body>{sun.x, -sun.y, -sun.z};
      for (const Vec3<Body> axis : {s, p_sun}) { // unpolarized: two fields at random phase
        const Field e =
            reflected(reflected(along_axis(axis, 1.0), -sun, middle, eta), middle, v, eta);
        const Complex a = component(e, s), b = component(e, p_v);
        order[static_cast<std::size_t>(first)] +=
            Stokes<ScatteringPlane>{std::norm(a) + std::norm(b), std::norm(a) - std::norm(b),
                                    2 * (a * std::conj(b)).real(), 2 * (std::conj(a) * b).imag()};
      }
    }
    // q, u, v are those of one mixture of the two orders: weights from I and Q, checked in U and V.
    const auto &x = order[0], &y = order[1];
    const double q = light.stokes.q / light.stokes.i;
    const double t = std::abs(x.q - q * x.i - (y.q - q * y.i)) < 1e-12
                         ? 0.5
                         : -(y.q - q * y.i) / (x.q - q * x.i - (y.q - q * y.i));
    ASSERT_GT(t, -1e-6);
    ASSERT_LT(t, 1 + 1e-6);
    const double i = t * x.i + (1 - t) * y.i;
    EXPECT_NEAR(light.stokes.u / light.stokes.i, (t * x.u + (1 - t) * y.u) / i, 1e-6) << k;
    EXPECT_NEAR(light.stokes.v / light.stokes.i, (t * x.v + (1 - t) * y.v) / i, 1e-6) << k;
    EXPECT_GT(std::abs(light.stokes.u / light.stokes.i), 1e-4); // the plane has turned
  }
}

TEST(Bounces, ACornerOfMirrorsSendsTheLightBack) {
  // Sun and observer in one direction across the corner's edge: two reflections, all of the light.
  const Material gold = mirror_of("paper_au");
  const Complex eta = index_at(gold.index, Wavelength::nm(550)).value();
  const Integrator plates(scene_of(corner(), NormalMode::Flat, {gold}));
  const Vec3<Body> d = normalized(Vec3<Body>{1, 0, 1});
  IntegrationOptions options;
  options.bounces = 2;
  options.accuracy = 2e-3;
  const double rho = solar_radius_of_test;
  const PoseResult light = plates.evaluate({d, d, rho}, options);
  // Both plates at 45 deg: area seen sqrt(2), all of it by two reflections; spread over the disk.
  const double c = std::sqrt(0.5);
  const Complex q = std::sqrt(eta * eta - 0.5);
  const double r_s = std::norm((c - q) / (c + q)),
               r_p = std::norm((eta * eta * c - q) / (eta * eta * c + q));
  const double expected = std::sqrt(2.0) * (r_s * r_s + r_p * r_p) / 2 / (pi * rho * rho);
  EXPECT_NEAR(light.indirect[1].i / expected, 1, 5e-3);
}

TEST(Bounces, AMirrorsImageOnALambertPlate) {
  // The Sun on the gold floor throws light on the Lambert wall: half of the wall's light by the
  // floor at 45 deg. J = rho/pi F cos45 A (n.v) with the area that the image covers.
  const Material gold = mirror_of("paper_au");
  const Complex eta = index_at(gold.index, Wavelength::nm(550)).value();
  const double rho = 0.5;
  const Integrator plates(scene_of(corner(), NormalMode::Flat, {gold, grey(rho)}));
  const Vec3<Body> sun = normalized(Vec3<Body>{1, 0, 1}), observer{1, 0, 0};
  IntegrationOptions options;
  options.bounces = 2;
  options.accuracy = 2e-3;
  const PoseResult light = plates.evaluate({sun, observer, solar_radius_of_test}, options);
  const double c = std::sqrt(0.5);
  const Complex q = std::sqrt(eta * eta - 0.5);
  const double f =
      (std::norm((c - q) / (c + q)) + std::norm((eta * eta * c - q) / (eta * eta * c + q))) / 2;
  // Everything that the floor sends up meets the wall: flux F cos45 times 1 m2.
  EXPECT_NEAR(light.indirect[1].i / (rho / pi * f * c), 1, 5e-3);
}

/// Agreement of two estimates within twice their half-widths and a part of I.
void expect_same_light(const PoseResult &a, const PoseResult &b, double part) {
  const auto &x = a.bands[1], &y = b.bands[1];
  const double slack = part * y.stokes.i;
  EXPECT_NEAR(x.stokes.i, y.stokes.i, 2 * (x.half_width.i + y.half_width.i) + slack);
  EXPECT_NEAR(x.stokes.q, y.stokes.q, 2 * (x.half_width.q + y.half_width.q) + slack);
  EXPECT_NEAR(x.stokes.u, y.stokes.u, 2 * (x.half_width.u + y.half_width.u) + slack);
  EXPECT_NEAR(x.stokes.v, y.stokes.v, 2 * (x.half_width.v + y.half_width.v) + slack);
}

TEST(Bounces, MirrorsWithBodyLightAreThoseOfAVeryNarrowLobe) {
  // A lobe of m = 1e6 is 1e-3 rad wide, the Sun 4.7e-3: it throws the same light on the other
  // plate, by paths that know nothing of mirrors. Floor and wall change roles; three surfaces.
  Material mirror = mirror_of("paper_asi");
  mirror.body = BodyLobe{Tabulated{{}, {0.3}}, true};
  Material narrow = mirror;
  narrow.distribution = blinn_phong(1e6);
  const Material rough = interface_of("paper_au", 8);
  IntegrationOptions options;
  options.bounces = 3;
  options.accuracy = 4e-3;
  options.max_points = 1u << 18;
  for (const bool is_floor : {true, false}) {
    const auto plates = [&](const Material &one) {
      return Integrator(scene_of(corner(), NormalMode::Flat,
                                 is_floor ? std::vector<Material>{one, rough}
                                          : std::vector<Material>{rough, one}));
    };
    const Pose pose{normalized(Vec3<Body>{1, 0.3, 1.2}), normalized(Vec3<Body>{1, -0.5, 0.9}),
                    solar_radius_of_test};
    const auto a = plates(mirror).evaluate(pose, options),
               b = plates(narrow).evaluate(pose, options);
    EXPECT_GT(b.indirect[1].i, 0.01 * b.bands[1].stokes.i);
    expect_same_light(a, b, 2e-3);
  }
}

TEST(Bounces, PolishedSurfacesLieBetweenMirrorAndLobe) {
  // exp(-g) of the light as from a mirror, the rest by the lobe (lobes.md, Eq. 11): no height
  // is a mirror, much of it the lobe alone; in between one narrow lobe and one wide one, weighted.
  Material polished = interface_of("paper_al", 30);
  const auto of_height = [&](double nm) {
    Material out = polished;
    if (nm >= 0)
      out.apparent_roughness = ApparentRoughness{{}, 550, nm};
    return Integrator(scene_of(corner(), NormalMode::Flat, {out, grey(0.5)}));
  };
  IntegrationOptions options;
  options.bounces = 2;
  options.accuracy = 2e-3;
  options.max_points = 1u << 19;
  // Sun in the plane of incidence x z at 50 deg on the floor; the wall is Lambert.
  const double sine = std::sin(50 * pi / 180), cosine = std::cos(50 * pi / 180);
  const Pose pose{{sine, 0, cosine}, normalized(Vec3<Body>{1, 0.2, 0.1}), solar_radius_of_test};
  const auto mirror = of_height(0).evaluate(pose, options);
  const auto lobe = of_height(-1).evaluate(pose, options);
  const auto rough = of_height(2000).evaluate(pose, options);
  expect_same_light(rough, lobe, 1e-3);
  const auto half = of_height(40).evaluate(pose, options);
  EXPECT_GT(half.indirect[1].i, std::min(mirror.indirect[1].i, lobe.indirect[1].i) * 0.98);
  EXPECT_LT(half.indirect[1].i, std::max(mirror.indirect[1].i, lobe.indirect[1].i) * 1.02);
  EXPECT_GT(std::abs(mirror.indirect[1].i / lobe.indirect[1].i - 1), 0.05); // they do differ
}

/// Poses of a body that turns by `step_deg` from one to the next.
std::vector<Pose> turning(std::size_t count, double step_deg) {
  const Vec3<Body> axis = normalized(Vec3<Body>{0.3, 0.5, 0.8}),
                   sun = normalized(Vec3<Body>{1, 0.2, -0.3}), across = any_perpendicular(sun);
  std::vector<Pose> out;
  for (std::size_t k = 0; k < count; ++k) {
    const double angle = Angle::degrees(step_deg).radians() * static_cast<double>(k);
    const auto turned = [&](Vec3<Body> v) {
      return normalized(v * std::cos(angle) + cross(axis, v) * std::sin(angle) +
                        axis * (dot(axis, v) * (1 - std::cos(angle))));
    };
    const double phase = 1.05 + 0.7 * std::sin(0.3 * angle);
    out.push_back({turned(sun), turned(sun * std::cos(phase) + across * std::sin(phase))});
  }
  return out;
}

TEST(Bounces, PosesOfASeriesShareTheirPaths) {
  // Oracle: the same poses one by one with another seed, to a third of the accuracy.
  Material rough = builtin_material("paper_al").value();
  rough.distribution = {"ggx", {{"alpha", 0.2}}, {}, {}};
  const Integrator hst(scene_of(make_hst(), NormalMode::Flat, {rough}));
  IntegrationOptions options;
  options.bounces = 3;
  options.accuracy = 0.01;
  options.max_points = 1u << 19;
  const std::vector<Pose> poses = turning(128, 0.25);
  const auto series = hst.evaluate(poses, options, 2);
  std::uint64_t rays = 0, rays_alone = 0;
  int inside[4] = {}, far = 0, compared = 0;
  for (std::size_t k = 0; k < poses.size(); k += 4) {
    IntegrationOptions finer = options;
    finer.seed = 1000 + k;
    rays += series[k].rays;
    rays_alone += hst.evaluate(poses[k], finer).rays;
    finer.accuracy = options.accuracy / 3;
    const BandResult a = series[k].bands[0], b = hst.evaluate(poses[k], finer).bands[0];
    const auto held = [&](double Stokes<ScatteringPlane>::*part, int which) {
      const double off = std::abs(a.stokes.*part - b.stokes.*part),
                   allowed = std::hypot(a.half_width.*part, b.half_width.*part);
      inside[which] += off <= allowed ? 1 : 0;
      far += off > 2 * allowed ? 1 : 0;
    };
    held(&Stokes<ScatteringPlane>::i, 0);
    held(&Stokes<ScatteringPlane>::q, 1);
    held(&Stokes<ScatteringPlane>::u, 2);
    held(&Stokes<ScatteringPlane>::v, 3);
    // The direct part and the other, each to the accuracy.
    EXPECT_LE(a.half_width.i, options.accuracy * a.stokes.i * std::sqrt(2.001));
    const Stokes<ScatteringPlane> &more = series[k].indirect[0];
    EXPECT_GE(more.i, 0);
    EXPECT_LE(std::hypot(more.q, more.u, more.v), more.i * (1 + 1e-6));
    ++compared;
  }
  ASSERT_EQ(compared, 32);
  // Half-widths of 95 %: of 32, neighbours not independent, 26 are passed in all but one of 300.
  for (const int n : inside)
    EXPECT_GE(n, 26);
  EXPECT_LE(far, 3);
  EXPECT_LT(3 * rays, rays_alone); // 4.5 when this was written
}

TEST(Bounces, EqualPosesShareTheirPathsToo) {
  Material rough = builtin_material("paper_al").value();
  rough.distribution = {"ggx", {{"alpha", 0.2}}, {}, {}};
  const Integrator hst(scene_of(make_hst(), NormalMode::Flat, {rough}));
  IntegrationOptions options;
  options.bounces = 2;
  options.accuracy = 0.01;
  const Pose pose = turning(1, 0).front();
  const PoseResult alone = hst.evaluate(pose, options);
  std::uint64_t rays = 0;
  for (const PoseResult &one : hst.evaluate(std::vector<Pose>(20, pose), options, 2)) {
    const BandResult &a = one.bands[0], &b = alone.bands[0];
    EXPECT_NEAR(a.stokes.i, b.stokes.i, 2 * (a.half_width.i + b.half_width.i));
    rays += one.rays;
  }
  EXPECT_LT(rays, 20 * alone.rays);
}

TEST(Bounces, WithoutAPlaneThereIsNoQOrU) {
  const Integrator hst(scene_of(make_hst(), NormalMode::Flat, {interface_of("paper_al", 30)}));
  IntegrationOptions options;
  options.bounces = 3;
  options.accuracy = 0.02;
  const Vec3<Body> v = normalized(Vec3<Body>{1, 2, -1});
  for (const Pose &pose : {Pose{v, v}, Pose{v, -v}}) {
    const BandResult light = hst.evaluate(pose, options).bands[0];
    EXPECT_EQ(light.stokes.q, 0);
    EXPECT_EQ(light.stokes.u, 0);
  }
}

TEST(Bounces, ASeriesStopsWhenAsked) {
  const Integrator hst(
      scene_of(make_hst(), NormalMode::Flat, {builtin_material("paper_al").value()}));
  IntegrationOptions options;
  options.bounces = 3;
  const std::atomic<bool> cancel = true;
  EXPECT_TRUE(hst.evaluate(turning(40, 0.5), options, 2, &cancel).empty());
}

TEST(Bounces, SameBytesForAnyThreads) {
  const Integrator hst(
      scene_of(make_hst(), NormalMode::Flat,
               {builtin_material("paper_al").value(), builtin_material("paper_asi").value()}));
  IntegrationOptions options;
  options.bounces = 3;
  options.accuracy = 0.05;
  std::vector<Pose> poses;
  for (std::uint64_t i = 0; i < 8; ++i)
    poses.push_back(random_pose(i));
  for (const Pose &pose : turning(40, 0.5))
    poses.push_back(pose);
  const auto one = hst.evaluate(poses, options, 1), many = hst.evaluate(poses, options, 8);
  for (std::size_t k = 0; k < poses.size(); ++k) {
    EXPECT_EQ(one[k].bands[0].stokes.i, many[k].bands[0].stokes.i);
    EXPECT_EQ(one[k].bands[0].stokes.v, many[k].bands[0].stokes.v);
    EXPECT_GE(one[k].indirect[0].i, 0);
  }
}

} // namespace
} // namespace umov
