// Turning parts in the fast engine against rays on the posed mesh.

#include "light/tests/engine_cases.h"

#include <umov/core/random.h>
#include <umov/light/articulated_engine.h>

namespace umov {
namespace {

using namespace cases;

struct Turning {
  Scene scene;
  std::vector<Joint> joints;
};

Turning hst_with_wings() {
  return {scene_of(make_hst(), NormalMode::Flat, four_materials()),
          {{"wings", {"array_front", "array_back", "array_frame"}, {1, 0, 0}, {}, {0, 0, 1}, ""}}};
}
Turning box_wing_with_panels() {
  BoxWingOptions options;
  options.facets = 2000;
  return {scene_of(make_box_wing(options), NormalMode::Flat, four_materials()),
          {{"panels", {"panels"}, {0, 1, 0}, {}, {0, 0, 1}, ""},
           {"dish", {"dish"}, {0, 0, 1}, {}, {1, 0, 0}, ""}}};
}

std::vector<double> random_angles(std::size_t count) {
  std::vector<double> out;
  for (std::size_t k = 0; k < count; ++k)
    out.push_back(2 * pi * uniform4(7, 3, k)[0]);
  return out;
}

struct Compared {
  std::vector<double> i, q;
  double covered = 0;
};

Compared compare(const Turning &of, std::size_t count) {
  const auto poses = random_poses(count, solar_radius);
  const auto angles = random_angles(count * of.joints.size());
  EngineOptions options;
  options.masks = fast_masks;
  const ArticulatedEngine engine(of.scene, of.joints, options);
  StokesTable table;
  engine.evaluate(poses, angles, table, 2);
  std::vector<PoseResult> truth(count);
  IntegrationOptions exact;
  exact.accuracy = 1e-3;
  for (std::size_t k = 0; k < count; ++k) {
    Scene turned = of.scene;
    const auto first = angles.begin() + static_cast<std::ptrdiff_t>(k * of.joints.size());
    turned.mesh = posed(of.scene.mesh, of.joints,
                        {first, first + static_cast<std::ptrdiff_t>(of.joints.size())});
    truth[k] = Integrator(turned).evaluate(poses[k], exact);
  }
  std::vector<double> light;
  for (const PoseResult &one : truth)
    light.push_back(one.bands[1].stokes.i);
  const double median = quantile(light, 0.5);
  Compared out;
  std::size_t covered = 0;
  for (std::size_t k = 0; k < count; ++k) {
    const BandResult here = table.at(k, 1), there = truth[k].bands[1];
    covered += std::abs(here.stokes.i - there.stokes.i) <= here.half_width.i + there.half_width.i
                   ? 1u
                   : 0u;
    if (there.stokes.i < 0.01 * median)
      continue;
    out.i.push_back(std::abs(here.stokes.i / there.stokes.i - 1));
    out.q.push_back(std::abs(here.stokes.q / here.stokes.i - there.stokes.q / there.stokes.i));
  }
  out.covered = static_cast<double>(covered) / static_cast<double>(count);
  return out;
}

/// The bounds that the engine keeps for rigid bodies.
void expect_good(const Compared &errors) {
  EXPECT_LT(quantile(errors.i, 0.5), 5e-3);
  EXPECT_LT(quantile(errors.i, 0.95), 2e-2);
  EXPECT_LT(quantile(errors.q, 0.95), 1e-3);
  EXPECT_GT(errors.covered, 0.88); // 90 % asked of many; 100 poses know it to 3 %
}

TEST(ArticulatedEngine, MasksStayRightWhileWingsTurn) {
  expect_good(compare(hst_with_wings(), 100));
}

TEST(ArticulatedEngine, TwoPartsTurnAtOnce) { expect_good(compare(box_wing_with_panels(), 100)); }

TEST(ArticulatedEngine, WithoutTurningItIsTheEngine) {
  const Turning of = box_wing_with_panels();
  const auto poses = random_poses(60);
  EngineOptions options;
  options.masks = fast_masks;
  const ArticulatedEngine turning(of.scene, of.joints, options);
  StokesTable a;
  turning.evaluate(poses, std::vector<double>(poses.size() * of.joints.size(), 0), a, 1);
  IntegrationOptions exact;
  exact.accuracy = 1e-3;
  const auto truth = Integrator(of.scene).evaluate(poses, exact, 2);
  std::vector<double> errors;
  for (std::size_t k = 0; k < poses.size(); ++k)
    errors.push_back(std::abs(a.at(k, 0).stokes.i - truth[k].bands[0].stokes.i) /
                     (truth[k].bands[0].stokes.i + 1e-3));
  EXPECT_LT(quantile(errors, 0.5), 5e-3);
  EXPECT_LT(quantile(errors, 0.95), 2e-2);
}

TEST(ArticulatedEngine, SameBitsForAnyThreads) {
  const Turning of = box_wing_with_panels();
  const auto poses = random_poses(300);
  const auto angles = random_angles(poses.size() * of.joints.size());
  EngineOptions options;
  options.masks = {10'000, 16, 16, 0.03};
  const ArticulatedEngine engine(of.scene, of.joints, options);
  StokesTable one, many;
  engine.evaluate(poses, angles, one, 1);
  engine.evaluate(poses, angles, many, 8);
  EXPECT_EQ(one.i, many.i);
  EXPECT_EQ(one.q, many.q);
  EXPECT_EQ(one.i_err, many.i_err);
  // A part of the poses alone.
  StokesTable part;
  engine.evaluate({poses.data() + 70, 50},
                  {angles.data() + 70 * of.joints.size(), 50 * of.joints.size()}, part, 2);
  for (std::size_t k = 0; k < 50; ++k)
    EXPECT_EQ(part.at(k, 2).stokes.i, one.at(k + 70, 2).stokes.i);
}

} // namespace
} // namespace umov
