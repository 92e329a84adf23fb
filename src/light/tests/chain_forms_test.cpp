// The light of a chain by each of the texts that compute it, and what chains ask of their ends.

#include "backend/chain_data.h"
#include "light/between/chain_level.h"
#include "light/tests/chain_cases.h"

#include <umov/scene/scene.h>

namespace umov {
namespace {

using namespace cases;

/// What chains are drawn on.
struct Ground {
  Scene scene;
  std::vector<VisibleSides> sides;
  BounceScene bounces;
  Occluder occluder;
  explicit Ground(Scene of)
      : scene(std::move(of)), sides(visible_sides(scene.mesh)), bounces(scene, sides),
        occluder(scene.mesh, Occluder::Rays::Each, nullptr) {}
};

using Light = Stokes<ScatteringPlane>;

Light light_of(const backend::ChainLight &from, std::size_t lane) {
  return {from.i[lane], from.q[lane], from.u[lane], from.v[lane]};
}

/// Drawn chains, one by one. All ends are taken for free.
class OneByOne : public ChainSet {
public:
  OneByOne(const ChainDrawn &drawn, const ChainMaterials &materials)
      : ChainSet(drawn, materials, 1, nullptr),
        free_(drawn.blocks * (chain_mask_cells + 1) * (chain_mask_cells + 1), 0xFFFF) {}

  [[nodiscard]] std::size_t bands() const { return bands_; }
  /// As levels are lit: 16 side by side.
  [[nodiscard]] std::vector<backend::ChainLight>
  side_by_side(std::size_t block, const backend::ChainPose &pose) const {
    std::vector<backend::ChainLight> out(bands_);
    backend::ChainSums sums;
    sums.bands = out;
    const backend::ChainData view{
        drawn_.block, matrix_, surfaces_.fast(), {drawn_.blocks, free_, free_}, bands_, {}};
    const backend::ChainRun &run = run_at(block);
    EXPECT_EQ(is_general_[drawn_.run_of[block]], 0);
    backend::sum_chains(view, run, block - run.first, 1, 0, pose, sums);
    return out;
  }
  /// As those are that rays settle; by the functions of their surfaces if `is_general`.
  [[nodiscard]] std::vector<backend::ChainLight>
  one_by_one(std::size_t block, const backend::ChainPose &pose, bool is_general) {
    std::vector<backend::ChainLight> out(bands_);
    backend::ChainSums sums;
    sums.bands = out;
    is_general_.assign(is_general_.size(), is_general ? 1 : 0);
    for (std::size_t lane = 0; lane < replicates; ++lane)
      for (const bool is_reversed : {false, true})
        add_one({run_at(block), block, lane, is_reversed}, 1, pose, sums);
    is_general_.assign(is_general_.size(), 0);
    return out;
  }

private:
  std::vector<std::uint16_t> free_;
};

/// The largest difference of I, Q, U, V in parts of I.
double apart(const Light &a, const Light &b) {
  return std::max(
             {std::abs(a.i - b.i), std::abs(a.q - b.q), std::abs(a.u - b.u), std::abs(a.v - b.v)}) /
         b.i;
}

// Three texts say what a chain carries: 16 side by side (chains_simd.cpp), one in single precision
// and one by the functions of its surfaces (chain_one.cpp). Metals, paint with polarized body
// light, and a lobe that is left to paths beside body light.
TEST(ChainForms, SideBySideOneByOneAndByTheSurfacesAreTheSameLight) {
  Material glossy = rough("paper_asi", 0.08);
  glossy.body = BodyLobe{{{}, {0.3}}, false};
  const Ground ground(
      scene_of(three_plates(), NormalMode::Flat, {rough("paper_au", 0.2), paint(), glossy}));
  const auto surfaces = std::make_shared<const ChainSurfaces>(ground.scene);
  const ChainDrawing drawing(ground.bounces, ground.occluder,
                             ChainCover({{&ground.scene, surfaces}}, nullptr), 4, 3, nullptr);
  const ChainRays rays(ground.bounces, ground.occluder, drawing.cover(), 4, 3);
  const ChainDrawn drawn = draw_chains(rays, nullptr, {0, 512, 4096}, 1, nullptr);
  OneByOne chains(drawn, {ground.scene, *surfaces, drawing});
  std::size_t count = 0, straight = 0;
  double worst_lanes = 0, worst_general = 0;
  Light sum_lanes, sum_general;
  for (std::uint64_t k = 0; k < 8; ++k) {
    const backend::ChainPose pose = chain_pose(into_corner(k));
    for (std::size_t block = 0; block < drawn.blocks; ++block) {
      const auto lanes = chains.side_by_side(block, pose),
                 one = chains.one_by_one(block, pose, false),
                 general = chains.one_by_one(block, pose, true);
      for (std::size_t b = 0; b < chains.bands(); ++b)
        for (std::size_t lane = 0; lane < replicates; ++lane) {
          const Light x = light_of(lanes[b], lane), y = light_of(one[b], lane),
                      z = light_of(general[b], lane);
          if (!(z.i > 0)) {
            EXPECT_EQ(x.i, 0);
            EXPECT_EQ(y.i, 0);
            continue;
          }
          ++count;
          EXPECT_TRUE(std::isfinite(y.i) && std::isfinite(y.q) && std::isfinite(y.u));
          straight += drawn.runs[drawn.run_of[block]].is_straight ? 1 : 0;
          worst_lanes = std::max(worst_lanes, apart(y, x));
          worst_general = std::max(worst_general, apart(y, z));
          sum_lanes += x;
          sum_general += z;
        }
    }
  }
  EXPECT_GT(straight, count / 4);
  EXPECT_LT(straight, count);
  // Rounding of single precision: a lobe sees that of n.h, 1e-7, times 1/alpha^2 (156), at each end
  // and in both of D and masking.
  EXPECT_LT(worst_lanes, 5e-4);
  // Polynomials are off by up to chain_fit_error of their largest value, at each of two ends, in
  // the lobe and in body light.
  EXPECT_LT(worst_general, 4 * backend::chain_fit_error);
  EXPECT_LT(apart(sum_lanes, sum_general), backend::chain_fit_error);
}

// At the foot of a wide wall half of what a plate scatters by Lambert's law is free, and nothing
// of lobes that look at the wall. All ways count alike, however many there are.
TEST(ChainForms, AnEndAsksOfAllItsWaysWhetherItIsFree) {
  Mesh mesh = corner();
  for (Vec3<Body> &p : mesh.positions)
    p = {p.x, 100 * (p.y - 0.5), 100 * p.z};
  const Ground ground(scene_of(mesh, NormalMode::Flat, {grey(0.5)}));
  const auto surfaces = std::make_shared<const ChainSurfaces>(ground.scene);
  const ChainCover cover({{&ground.scene, surfaces}}, nullptr);
  const ChainRays rays(ground.bounces, ground.occluder, cover, 2, 5);
  ChainEnd end;
  end.point = ground.occluder.to_point({0.1, 0, 1e-3});
  end.face[2] = end.normal[2] = 1;
  put_floats(normalized(Vec3<Body>{1, 0, 1}), end.along); // its mirror image looks at the wall
  Sampler lambert(ground.scene.front[0]);
  lambert.cosine_share = 1;
  Sampler lobe = lambert;
  lobe.cosine_share = 0;
  lobe.normals = {{LobeKind::Ggx, 0.01}};
  for (const std::size_t narrow :
       {std::size_t{0}, std::size_t{1}, std::size_t{2}, std::size_t{4}, std::size_t{12}}) {
    std::vector<Sampler> ways(narrow, lobe);
    ways.resize(narrow + (narrow > 0 ? narrow : 1), lambert);
    const auto count = static_cast<double>(ways.size());
    const double looks = std::min(count * std::ceil(4 / count), 8.0);
    double mean = 0;
    constexpr std::uint64_t streams = 4096;
    for (std::uint64_t k = 0; k < streams; ++k) {
      const double root = rays.freedom(end, ways, k);
      mean += (root * root - 0.25 / looks) / static_cast<double>(streams);
    }
    // Four standard errors of 4096 times 4 or more yeses and noes.
    EXPECT_NEAR(mean, narrow == 0 ? 0.5 : 0.25, 4 * 0.5 / std::sqrt(4 * streams)) << narrow;
  }
}

} // namespace
} // namespace umov
