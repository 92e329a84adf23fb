// Bands with a curve: the seam's sums against the same wavelengths asked for one by one.

#include "light/tests/integrator_cases.h"

#include <fmt/format.h>
#include <umov/light/light_model.h>
#include <umov/light/poses.h>

namespace umov {
namespace {

using namespace cases;

/// 465 to 615 nm: within the tables of the paper.
std::vector<Band> curve_and_wavelength() {
  return {*band_of(gaussian_passband("green", 540, 60)), {"nm:600", Wavelength::nm(600)}};
}

Scene box_wing(const std::vector<Band> &bands) {
  const Mesh mesh = make_box_wing({1000, 0});
  const Material three[] = {interface_of("paper_al", 30), white_lambert(),
                            interface_of("paper_au", 50)};
  std::vector<Material> materials;
  for (std::size_t g = 0; g < mesh.groups.size(); ++g)
    materials.push_back(three[g % 3]);
  Diagnostics diagnostics;
  auto scene = make_scene(mesh, NormalMode::Flat, bands, materials, materials, diagnostics);
  EXPECT_TRUE(scene) << scene.error().text();
  return std::move(*scene);
}

std::vector<Pose> poses_of(std::size_t count) {
  std::vector<Pose> out;
  for (std::size_t k = 0; k < count; ++k) {
    out.push_back(random_pose(3, k, Angle::degrees(40 + 10.0 * static_cast<double>(k % 10))));
    out.back().sun_radius_rad = sun_radius_at_1au_rad;
  }
  return out;
}

StokesTable lit(const Scene &scene, std::span<const Pose> poses, LightMethod method) {
  auto model = make_light(scene, {}, {.method = method});
  EXPECT_TRUE(model) << model.error().text();
  StokesTable out;
  EXPECT_TRUE((*model)->evaluate(poses, out, {true, true, 2, nullptr}));
  return out;
}

TEST(BandsOfLight, AreTheSumsOfTheirWavelengths) {
  const Scene scene = box_wing(curve_and_wavelength());
  std::vector<Band> wavelengths;
  for (const Band &node : scene.grid.nodes())
    wavelengths.push_back({fmt::format("nm:{}", node.wavelength.nm()), node.wavelength});
  const auto poses = poses_of(8);
  for (const LightMethod method : {LightMethod::Rays, LightMethod::Masks}) {
    const auto bands = lit(scene, poses, method);
    const auto nodes = lit(box_wing(wavelengths), poses, method);
    ASSERT_EQ(bands.bands, 2u);
    ASSERT_EQ(bands.band_err.size(), 16u);
    EXPECT_TRUE(nodes.band_err.empty());
    const std::size_t materials = bands.material_i.size() / bands.i.size();
    for (std::size_t k = 0; k < poses.size(); ++k)
      for (std::size_t b = 0; b < 2; ++b) {
        Stokes<ScatteringPlane> sum, error, change;
        double gold = 0;
        for (const BandTerm &term : scene.grid.terms()[b]) {
          const BandResult at = nodes.at(k, term.node);
          sum += at.stokes * term.weight;
          error += at.half_width * term.weight;
          change += at.stokes * (term.weight - term.coarse);
          gold += term.weight *
                  nodes.material_i[(k * materials + materials - 1) * nodes.bands + term.node];
        }
        const BandResult found = bands.at(k, b);
        const double eps = 1e-12; // rounding: sums of tens of terms
        EXPECT_NEAR(found.stokes.i, sum.i, eps);
        EXPECT_NEAR(found.stokes.q, sum.q, eps);
        EXPECT_NEAR(found.half_width.i, error.i, eps);
        EXPECT_NEAR(bands.band_err[k * 2 + b].i, std::abs(change.i), eps);
        EXPECT_NEAR(bands.material_i[(k * materials + materials - 1) * 2 + b], gold, eps);
        if (b == 1) { // one wavelength
          EXPECT_EQ(bands.band_err[k * 2 + b].i, 0);
        }
      }
  }
}

TEST(BandsOfLight, DoNotKnowTheirNeighbours) {
  const Scene scene = box_wing(curve_and_wavelength());
  const auto poses = poses_of(2100); // more than are summed at a time
  const auto all = lit(scene, poses, LightMethod::Masks);
  const auto last = lit(scene, std::span(poses).subspan(2000), LightMethod::Masks);
  ASSERT_EQ(all.i.size(), 2 * poses.size());
  for (std::size_t k = 0; k < last.i.size(); ++k) {
    EXPECT_EQ(last.i[k], all.i[4000 + k]);
    EXPECT_EQ(last.q_err[k], all.q_err[4000 + k]);
    EXPECT_EQ(last.band_err[k].i, all.band_err[4000 + k].i);
  }
  EXPECT_EQ(std::vector<char>(all.is_dark.begin() + 2000, all.is_dark.end()), last.is_dark);
}

TEST(BandsOfLight, NoPoseIsNoLight) {
  const auto none = lit(box_wing(curve_and_wavelength()), {}, LightMethod::Masks);
  EXPECT_EQ(none.poses(), 0u);
  EXPECT_EQ(none.bands, 2u);
}

} // namespace
} // namespace umov
