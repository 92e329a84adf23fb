// The numerical half-widths against runs 64 times denser (other random points): a statistical test
// with a stated significance.

#include "light/tests/integrator_cases.h"

#include <algorithm>

namespace umov {
namespace {

using namespace cases;

struct Coverage {
  std::size_t lit = 0, covered = 0;
  double median_difference = 0, median_half_width = 0;
};

double median(std::vector<double> v) {
  std::nth_element(v.begin(), v.begin() + static_cast<std::ptrdiff_t>(v.size() / 2), v.end());
  return v[v.size() / 2];
}

Coverage coverage(NormalMode normals, double accuracy, std::size_t count) {
  std::vector<Material> materials;
  for (const std::string &name : builtin_material_names())
    materials.push_back(*builtin_material(name));
  const Integrator integrator(scene_of(make_hst(), normals, materials));
  std::vector<Pose> poses;
  for (std::size_t i = 0; i < count; ++i)
    poses.push_back(random_pose(i));
  IntegrationOptions usual;
  usual.accuracy = accuracy;
  usual.seed = 1;
  IntegrationOptions dense = usual;
  dense.seed = 2;
  dense.density = 64;
  dense.max_points = std::size_t{1} << 26;
  const auto fast = integrator.evaluate(poses, usual, 0),
             slow = integrator.evaluate(poses, dense, 0);
  Coverage out;
  std::vector<double> differences, half_widths;
  for (std::size_t i = 0; i < count; ++i) {
    if (fast[i].is_dark && slow[i].is_dark)
      continue;
    const double width = fast[i].bands[1].half_width.i;
    const double difference = std::abs(fast[i].bands[1].stokes.i - slow[i].bands[1].stokes.i);
    ++out.lit;
    out.covered += difference <= width ? 1u : 0u;
    differences.push_back(difference);
    half_widths.push_back(width);
  }
  out.median_difference = median(differences);
  out.median_half_width = median(half_widths);
  return out;
}

TEST(IntegratorErrors, HalfWidthsCoverTheTruth) {
  for (const NormalMode normals : {NormalMode::Flat, NormalMode::Smooth}) {
    const Coverage found = coverage(normals, 0.02, 200);
    ASSERT_GT(found.lit, 190u);
    const double share = static_cast<double>(found.covered) / static_cast<double>(found.lit);
    // Wanted: 90 to 99.5 % of 200; a true 95 % leaves that range once in 1,000 such tests.
    EXPECT_GE(share, 0.90);
    EXPECT_LE(share, 0.995);
    // ... and estimates that are not merely large.
    EXPECT_GE(found.median_difference, 0.1 * found.median_half_width);
  }
}

} // namespace
} // namespace umov
