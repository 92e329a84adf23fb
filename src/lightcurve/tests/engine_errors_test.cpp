// Masks against rays: the size of the errors, and whether the half-widths tell it.

#include "lightcurve/tests/engine_cases.h"

namespace umov::cases {
namespace {

struct Errors {
  std::size_t lit = 0;
  double median = 0, p95 = 0, q_p95 = 0, covered = 0, median_estimate = 0;
};

/// Errors in the middle band over 200 poses, of those with more than a hundredth of the median light;
/// `covered` takes all.
Errors errors_of(const Mesh &mesh, const std::vector<Material> &materials,
                 const MaskQuality &quality) {
  const Scene scene = scene_of(mesh, NormalMode::Flat, materials);
  EngineOptions options;
  options.masks = quality;
  const Engine engine(scene, options);
  const Integrator integrator(scene);
  const auto poses = random_poses(200, solar_radius);
  IntegrationOptions exact;
  exact.accuracy = 5e-4;
  const auto reference = integrator.evaluate(poses, exact, 0);
  const StokesTable table = evaluated(engine, poses);
  std::vector<double> light;
  for (const PoseResult &r : reference)
    light.push_back(r.bands[1].stokes.i);
  const double dim = 0.01 * quantile(light, 0.5);
  Errors out;
  std::vector<double> i, q, estimate;
  std::size_t covered = 0, counted = 0;
  for (std::size_t k = 0; k < poses.size(); ++k) {
    const auto wanted = reference[k].bands[1], found = table.at(k, 1);
    if (reference[k].is_dark && table.is_dark[k] != 0)
      continue;
    ++counted;
    covered += std::abs(found.stokes.i - wanted.stokes.i) <=
                       found.half_width.i + wanted.half_width.i
                   ? 1u
                   : 0u;
    if (!(wanted.stokes.i > dim))
      continue;
    i.push_back(relative(found.stokes.i, wanted.stokes.i));
    q.push_back(std::abs(found.stokes.q / found.stokes.i - wanted.stokes.q / wanted.stokes.i));
    estimate.push_back(found.half_width.i / wanted.stokes.i);
  }
  out.lit = i.size();
  out.covered = static_cast<double>(covered) / static_cast<double>(counted);
  out.median = quantile(i, 0.5);
  out.p95 = quantile(i, 0.95);
  out.q_p95 = quantile(q, 0.95);
  out.median_estimate = quantile(estimate, 0.5);
  return out;
}

void expect_fast(const Errors &found, const char *name) {
  // The bounds for the fast masks; 90 to 99.5 % of 200 leaves one pose in reserve.
  EXPECT_GT(found.lit, 150u) << name;
  EXPECT_LE(found.median, 5e-3) << name;
  EXPECT_LE(found.p95, 2e-2) << name;
  EXPECT_LE(found.q_p95, 1e-3) << name;
  EXPECT_GE(found.covered, 0.90) << name;
  EXPECT_GE(found.median, 0.1 * found.median_estimate) << name;
}

TEST(EngineErrors, BoxWing) {
  expect_fast(errors_of(make_box_wing(), four_materials(), {60'000, 64, 64, 0}), "box-wing");
}

TEST(EngineErrors, HstAndAgenaWithRaysWhereMasksAreUncertain) {
  std::vector<Material> materials;
  for (const std::string &name : builtin_material_names())
    materials.push_back(builtin_material(name).value());
  expect_fast(errors_of(make_hst(), materials, fast_masks), "hst");
  expect_fast(errors_of(make_agena(), materials, fast_masks), "agena");
}

} // namespace
} // namespace umov::cases
