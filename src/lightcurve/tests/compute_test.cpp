// A light curve as a whole, on a track with closed-form altitudes.

#include <umov/lightcurve/compute.h>

#include "light/tests/integrator_cases.h"
#include "observation/tests/straight_line.h"

#include <cstring>
#include <umov/photometry/radiometry.h>

namespace umov {
namespace {

using namespace cases;

/// In the morning, the Sun low in the east: the object is lit from the side.
const StraightLine line("2018-03-20T06:30:00.5Z");
const std::atomic<bool> no_cancel = false;

/// Two plates of 1 m2, white and grey on both sides: side by side in the plane z = 0, or else.
Scene two_plates(Vec3<Body> apart = {2, 0, 0}) {
  Mesh mesh = make_plate(1, 1, false);
  Mesh other = mesh;
  mesh.groups = {"white", "grey"};
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  for (const Vec3<Body> &p : other.positions)
    mesh.positions.push_back(p + apart);
  for (Triangle t : other.triangles) {
    for (std::uint32_t &corner : t.vertex)
      corner += first;
    t.normal = {no_index, no_index, no_index};
    t.front = t.back = 1;
    mesh.triangles.push_back(t);
  }
  for (Triangle &t : mesh.triangles)
    t.normal = {no_index, no_index, no_index};
  mesh.normals.clear();
  return scene_of_sides(mesh, {white_lambert(), grey(0.5)}, {white_lambert(), grey(0.5)});
}

LightCurveRequest request_of(double seconds, double step_s, LightMethod method) {
  LightCurveRequest out;
  out.object = "plates";
  out.track = line.request();
  out.track.has_solar_disk = false;
  out.span = line.span(seconds, step_s);
  out.only.altitude_min = Angle::degrees(20);
  out.light.method = method;
  return out;
}

LightCurveOutcome computed(const LightCurveRequest &request, const Scene &scene) {
  auto outcome = compute_light_curve(request, scene, nullptr, no_cancel);
  EXPECT_TRUE(outcome) << outcome.error().text();
  return std::move(*outcome);
}

TEST(LightCurve, TwoLambertPlatesFollowTheCosines) {
  const Scene scene = two_plates();
  const auto request = request_of(1200, 10, LightMethod::Rays);
  const LightCurve curve = computed(request, scene).curve;
  ASSERT_EQ(curve.bands.size(), 3u);
  ASSERT_EQ(curve.samples.size(), 3 * curve.epochs.size());
  const auto colours = photometric_bands(curve.bands, MagnitudeSystem::AB);
  std::size_t lit = 0;
  for (std::size_t k = 0; k < curve.epochs.size(); ++k) {
    const LightCurveEpoch &epoch = curve.epochs[k];
    const double cosines = epoch.pose.sun.z * epoch.pose.observer.z;
    const double expected = std::max(0.0, 1.5 / pi * cosines);
    EXPECT_EQ(epoch.is_dark, expected == 0);
    lit += expected > 0 ? 1u : 0u;
    for (std::size_t b = 0; b < 3; ++b) {
      const LightCurveSample &sample = curve.samples[3 * k + b];
      EXPECT_NEAR(sample.intensity, expected, 1e-9 + sample.half_width.i);
      EXPECT_EQ(sample.irradiance,
                irradiance_at_observer(sample.intensity, (*colours)[b].solar,
                                       epoch.geometry.sun_distance_km, epoch.geometry.sunlit,
                                       epoch.geometry.range_km));
    }
  }
  EXPECT_GT(lit, 20u);
}

TEST(LightCurve, RowsBelongToThePassesThatAreCounted) {
  const auto outcome = computed(request_of(1200, 10, LightMethod::Rays), two_plates());
  ASSERT_EQ(outcome.passes.size(), 2u);
  EXPECT_EQ(outcome.passes[0].rows + outcome.passes[1].rows, outcome.curve.epochs.size());
  EXPECT_EQ(outcome.curve.epochs.front().pass_id, outcome.passes[0].id);
  EXPECT_EQ(outcome.curve.epochs.back().pass_id, outcome.passes[1].id);
  EXPECT_FALSE(outcome.stopped);
}

TEST(LightCurve, AnyNumberOfThreadsGivesTheSameBits) {
  const Scene scene = scene_of_sides(corner(), {white_lambert(), interface_of("paper_au", 200)},
                                     {white_lambert(), white_lambert()});
  for (const LightMethod method : {LightMethod::Rays, LightMethod::Masks}) {
    LightCurveRequest request = request_of(600, 20, method);
    request.threads = 1;
    const LightCurve one = computed(request, scene).curve;
    request.threads = 3;
    const LightCurve three = computed(request, scene).curve;
    ASSERT_EQ(one.samples.size(), three.samples.size());
    ASSERT_GT(one.samples.size(), 0u);
    for (std::size_t k = 0; k < one.samples.size(); ++k)
      EXPECT_EQ(std::memcmp(&one.samples[k], &three.samples[k], sizeof(LightCurveSample)), 0) << k;
    EXPECT_EQ(one.material_i, three.material_i);
  }
}

TEST(LightCurve, EveryRowSaysHowItWasLit) {
  const Scene scene = two_plates({0.3, 0, 0.5}); // one above the other
  const auto rays = computed(request_of(1200, 20, LightMethod::Rays), scene).curve;
  const auto masks = computed(request_of(1200, 20, LightMethod::Masks), scene).curve;
  ASSERT_EQ(masks.epochs.size(), rays.epochs.size());
  std::size_t lit = 0;
  for (std::size_t k = 0; k < rays.epochs.size(); ++k)
    if (!rays.epochs[k].is_dark) {
      EXPECT_EQ(rays.epochs[k].method, PoseMethod::Rays);
      EXPECT_EQ(masks.epochs[k].method, PoseMethod::Masks);
      ++lit;
    }
  EXPECT_GT(lit, 0u);
}

TEST(LightCurve, WhereTheOrbitEndsTheRowsBeforeStay) {
  LightCurveRequest request = request_of(1300, 10, LightMethod::Rays);
  request.only.altitude_min = Angle::degrees(0);
  const auto outcome = computed(request, two_plates());
  ASSERT_TRUE(outcome.stopped);
  EXPECT_EQ(outcome.stopped->code, ErrorCode::Physics);
  EXPECT_EQ(outcome.curve.epochs.size(), 121u);
  EXPECT_EQ(outcome.curve.samples.size(), 3 * 121u);
}

TEST(LightCurve, AStopKeepsWholeBlocksAndTheirPasses) {
  std::atomic<bool> cancel = false;
  std::size_t reported = 0;
  const auto outcome = compute_light_curve(
      request_of(1200, 5, LightMethod::Rays), two_plates(),
      [&](std::size_t done, std::size_t) {
        reported = done;
        cancel = true;
      },
      cancel);
  ASSERT_TRUE(outcome) << outcome.error().text();
  ASSERT_TRUE(outcome->stopped);
  EXPECT_EQ(outcome->stopped->code, ErrorCode::Interrupted);
  ASSERT_GT(reported, 0u);
  EXPECT_EQ(outcome->curve.epochs.size(), reported);
  EXPECT_EQ(outcome->curve.samples.size(), 3 * reported);
  EXPECT_EQ(outcome->curve.material_i.size(), 3 * reported * outcome->curve.materials.size());
  std::size_t rows = 0;
  for (const Pass &pass : outcome->passes) {
    EXPECT_GT(pass.rows, 0u);
    rows += pass.rows;
  }
  EXPECT_EQ(rows, reported);
}

TEST(LightCurve, AStopBeforeTheFirstRowIsAnError) {
  const std::atomic<bool> cancel = true;
  const auto outcome =
      compute_light_curve(request_of(600, 10, LightMethod::Rays), two_plates(), nullptr, cancel);
  ASSERT_FALSE(outcome);
  EXPECT_EQ(outcome.error().code, ErrorCode::Interrupted);
}

} // namespace
} // namespace umov
