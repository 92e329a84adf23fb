// The loops in lanes of float against the reference in double, on a heap of random facets behind
// random masks.

#include "backend/scene_data.h"
#include "kernel/disk_lobe.h"

#include <cmath>
#include <gtest/gtest.h>
#include <random>
#include <vector>

namespace umov::backend {
namespace {

using kernel::LobeAtPose;
using kernel::LobeConstants;

constexpr std::size_t group_count = 150, directions = 9, words = 2;

constexpr std::size_t lobe_count = 5;

/// One slot with five lobes, under a source 11 deg wide (two corrected, three cut into chords), and
/// two products of two profiles.
template <class T> struct Heap {
  std::vector<FacetGroup<T>> groups;
  std::vector<T> cone[4]; ///< GroupCones
  std::vector<Chunk> chunks;
  std::vector<SlotTerms> slots;
  std::vector<LobeConstants<T>> lobes;
  std::vector<Profile<T>> profiles;
  std::vector<Product> products{{0, 0}, {0, 1}};
  std::vector<LobeAtPose<T>> at;
  PoseData<T> pose;
  std::vector<NormalPatch<T>> patches;
  std::vector<PatchRange> patches_of;
  std::vector<T> node[3]; ///< PatchNodes

  /// Every third class takes on normals of two triangles, .06 rad around its own.
  void add_patches() {
    for (const T value : {T(0.25), T(0.5), T(0.125)})
      for (std::size_t k = 0; k < 3; ++k)
        node[k].push_back(k < 2 ? value : T(1) / 3);
    for (std::vector<T> &column : node)
      column.resize(lanes);
    for (std::size_t g = 0; g < group_count; ++g)
      for (std::size_t lane = 0; lane < lanes; ++lane) {
        const std::uint32_t count = (g + lane) % 3 == 0 ? 2 : 0;
        patches_of.push_back({static_cast<std::uint32_t>(patches.size()), count});
        const T n[3] = {groups[g].nx[lane], groups[g].ny[lane], groups[g].nz[lane]};
        for (std::uint32_t p = 0; p < count; ++p) {
          NormalPatch<T> &patch = patches.emplace_back();
          for (std::size_t axis = 0; axis < 3; ++axis) {
            patch.corner[axis] = n[axis];
            patch.first[axis] = T(0.06) * n[(axis + 1 + p) % 3];
            patch.second[axis] = T(-0.06) * n[(axis + 2 - p) % 3];
          }
          patch.share = p == 0 ? T(0.75) : T(0.25);
          patch.node_count = lanes;
        }
      }
    slots[0].patch_spread = 0.0625F;
  }

  Heap() {
    std::mt19937 random(7); // NOLINT: the same heap every time
    std::uniform_real_distribution<float> uniform(-1, 1);
    for (std::size_t g = 0; g < group_count; ++g) {
      FacetGroup<T> &group = groups.emplace_back();
      for (std::size_t lane = 0; lane < lanes; ++lane) {
        const float x = uniform(random), y = uniform(random), z = uniform(random);
        const T length = std::sqrt(T(x) * T(x) + T(y) * T(y) + T(z) * T(z));
        group.nx[lane] = T(x) / length;
        group.ny[lane] = T(y) / length;
        group.nz[lane] = T(z) / length;
        group.area[lane] = T(1.5F + uniform(random)) / 4096;
      }
    }
    for (const FacetGroup<T> &group : groups) {
      const Cone around = cone_of(group);
      for (std::size_t k = 0; k < 3; ++k)
        cone[k].push_back(static_cast<T>(around.axis[k]));
      cone[3].push_back(static_cast<T>(around.least));
    }
    for (std::vector<T> &column : cone)
      column.resize(group_count + lanes);
    for (std::uint32_t g = 0; g < group_count; g += groups_per_chunk)
      chunks.push_back({g, std::min<std::uint32_t>(groups_per_chunk, group_count - g), 0});
    SlotTerms &slot = slots.emplace_back();
    slot.lobe_count = lobe_count;
    slot.profile_count = slot.product_count = 2;
    for (const auto &[kind, joint, shape] :
         {std::tuple(LobeKind::BlinnPhong, Shadowing::Ashikhmin, T(60)),
          std::tuple(LobeKind::Beckmann, Shadowing::Smith, T(0.25)),
          std::tuple(LobeKind::Ggx, Shadowing::Separable, T(0.125)),
          std::tuple(LobeKind::Beckmann, Shadowing::Separable, T(0.0625)),
          std::tuple(LobeKind::BlinnPhong, Shadowing::Smith, T(2000))}) {
      LobeConstants<T> &lobe = lobes.emplace_back();
      lobe.kind = kind;
      lobe.joint = joint;
      lobe.shape = shape;
      lobe.peak = T(9.75);
      lobe.masking[0] = T(1.5);
      lobe.masking[1] = T(-0.25);
    }
    for (const T second : {T(0.5), T(-0.25)}) {
      Profile<T> &profile = profiles.emplace_back();
      profile.c[0] = T(1);
      profile.c[1] = second;
      profile.degree = 1;
    }
    at.resize(lobes.size());
    const T direction[3] = {T(0.6), T(0), T(0.8)};
    for (std::size_t k = 0; k < 3; ++k) {
      pose.facet.sun[k] = direction[k];
      pose.facet.observer[k] = k == 0 ? -direction[k] : direction[k];
    }
    pose.facet.cos_phase = T(0.28);
    pose.facet.along_scale = T(1 / 1.2);
    const kernel::DiskImage disk = kernel::disk_image(0.1, 0.28);
    const double shift = disk.shift(), length = std::sqrt(1 + shift * shift);
    pose.facet.half[0] = T(shift / length);
    pose.facet.half[2] = T(1 / length);
    pose.facet.half_shift = T(shift);
    for (std::size_t k = 0; k < lobes.size(); ++k)
      put_at_pose(lobes[k], disk, at[k]);
    pose.lobes = at;
    pose.small_sun = {{0, 1, 3}, {0.5F, 0.25F, 0.25F}};
    pose.small_observer = {{4, 5, 7}, {0.125F, 0.625F, 0.25F}};
  }
  static void put_at_pose(const LobeConstants<T> &lobe, const kernel::DiskImage &disk,
                          LobeAtPose<T> &out) {
    LobeConstants<double> whole;
    whole.kind = lobe.kind;
    whole.shape = static_cast<double>(lobe.shape);
    whole.peak = static_cast<double>(lobe.peak);
    LobeAtPose<double> exact;
    kernel::put_lobe_at_pose(whole, disk, exact);
    if constexpr (std::is_same_v<T, double>)
      out = exact;
    else
      kernel::round_lobe_at_pose(exact, out);
  }
  [[nodiscard]] SceneData<T> scene() const {
    return {groups,     {cone[0], cone[1], cone[2], cone[3]},
            chunks,     slots,
            lobes,      {},
            profiles,   products,
            {},         patches,
            patches_of, {node[0], node[1], node[2]}};
  }
};

/// Every fourth entry of a direction is free, every other fourth hidden.
struct RandomMasks {
  std::vector<MaskBlock> pool;
  std::vector<std::uint32_t> offset;
  std::vector<GroupMask> groups;
  Masks view;

  RandomMasks() {
    std::mt19937 random(11); // NOLINT
    pool.resize(2 * words);
    for (std::size_t k = words; k < 2 * words; ++k)
      for (std::uint32_t &word : pool[k].word)
        word = ~0u;
    for (std::size_t d = 0; d < directions; ++d) {
      for (std::uint32_t g = 0; g < group_count; ++g) {
        if (g % 4 < 2) {
          offset.push_back(g % 4 == 0 ? words : 0);
          continue;
        }
        offset.push_back(static_cast<std::uint32_t>(pool.size()));
        for (std::size_t k = 0; k < words; ++k)
          for (std::uint32_t &word : pool.emplace_back().word)
            word = static_cast<std::uint32_t>(random()) | static_cast<std::uint32_t>(random());
      }
    }
    offset.resize(offset.size() + lanes);
    for (std::uint32_t g = 0; g < group_count; ++g)
      groups.push_back({g, words, false});
    view.small = {2, group_count, offset};
    view.groups = groups;
    view.pool = pool;
    view.longest = words;
  }
};

struct Summed {
  std::vector<double> room = std::vector<double>(lobe_count * 4 + 2 * 3, 0.0);
  PoseSums sums;
  Summed() {
    double *next = room.data();
    for (auto *column :
         {&sums.specular, &sums.specular_variance, &sums.specular_bias, &sums.specular_linear}) {
      *column = {next, lobe_count};
      next += lobe_count;
    }
    for (auto *column : {&sums.product, &sums.product_variance, &sums.product_linear}) {
      *column = {next, 2};
      next += 2;
    }
  }
};

TEST(FacetLoops, LanesAgreeWithTheReference) {
  const Heap<double> exact;
  const Heap<float> single;
  const RandomMasks masks;
  for (const auto &[hiding, has_doubts] :
       {std::pair(static_cast<const Masks *>(nullptr), false), std::pair(&masks.view, false),
        std::pair(&masks.view, true)}) {
    const MaskErrorModel model{1.5F, 0.25F, has_doubts};
    Summed wanted;
    sum_facets(exact.scene(), hiding, model, exact.pose, wanted.sums);
    EXPECT_TRUE(wanted.sums.is_any_seen);
    for (const double sum : wanted.sums.specular)
      EXPECT_GT(sum, 0);
    EXPECT_EQ(wanted.sums.product_variance[0] > 0, hiding != nullptr);
    for (const auto set : {InstructionSet::Baseline, InstructionSet::Sse4, InstructionSet::Avx2,
                           InstructionSet::Avx512}) {
      if (!choose_instruction_set(set))
        continue; // this machine lacks it
      Summed found;
      sum_facets(single.scene(), hiding, model, single.pose, found.sums);
      for (std::size_t k = 0; k < wanted.room.size(); ++k)
        // Rounded facets on the flanks of lobes; sums of 64 groups in single precision.
        EXPECT_NEAR(found.room[k], wanted.room[k], 2e-5 * std::abs(wanted.room[k]))
            << "number " << k << ", " << instruction_set_name();
    }
    choose_instruction_set(InstructionSet::Best);
  }
}

/// The same of classes whose normals are taken one by one; and what is listed with weights adds up
/// to the sums.
TEST(FacetLoops, LanesAgreeOnCurvedClasses) {
  Heap<double> exact, plain;
  Heap<float> single;
  exact.add_patches();
  single.add_patches();
  const RandomMasks masks;
  const MaskErrorModel model{1.5F, 0.25F};
  Summed flat, wanted;
  sum_facets(plain.scene(), &masks.view, model, plain.pose, flat.sums);
  sum_facets(exact.scene(), &masks.view, model, exact.pose, wanted.sums);
  for (std::size_t k = 0; k < lobe_count; ++k) // the last two are narrow: few classes are near
    EXPECT_GT(std::abs(wanted.sums.specular[k] / flat.sums.specular[k] - 1), k < 3 ? 1e-3 : 1e-10)
        << k;
  EXPECT_EQ(wanted.sums.product[0], flat.sums.product[0]);
  std::vector<SeenFacet> room(group_count * lanes);
  std::vector<double> weights(room.size() * (lobe_count + 2));
  WeighedList list{SeenList(room), weights, lobe_count + 2};
  list_weighed(exact.scene(), &masks.view, model, exact.pose, list);
  for (std::size_t lobe = 0; lobe < lobe_count; ++lobe) {
    double sum = 0;
    for (std::size_t k = 0; k < list.facets.size(); ++k)
      sum += list.facets[k].area * weights.data()[k * list.terms + lobe];
    EXPECT_NEAR(sum, wanted.sums.specular[lobe], 1e-12 * sum);
  }
  for (const auto set : {InstructionSet::Baseline, InstructionSet::Sse4, InstructionSet::Avx2,
                         InstructionSet::Avx512}) {
    if (!choose_instruction_set(set))
      continue; // this machine lacks it
    Summed found;
    sum_facets(single.scene(), &masks.view, model, single.pose, found.sums);
    for (std::size_t k = 0; k < wanted.room.size(); ++k)
      EXPECT_NEAR(found.room[k], wanted.room[k], 2e-5 * std::abs(wanted.room[k]))
          << "number " << k << ", " << instruction_set_name();
  }
  choose_instruction_set(InstructionSet::Best);
}

/// Doubts add one variance to every facet that faces both directions, hidden or free, and no light:
/// with n points 1.5 (1/n)(1 - 1/n) n^-1.5 of its area squared, here n = 64.
TEST(FacetLoops, DoubtsCountFacetsThatMasksCallFreeOrHidden) {
  const Heap<double> heap;
  const RandomMasks masks;
  std::vector<SeenFacet> room(group_count * lanes);
  std::vector<double> weights(room.size() * (lobe_count + 2));
  WeighedList facing{SeenList(room), weights, lobe_count + 2};
  list_weighed(heap.scene(), &masks.view, {1.5F, 0.25F, true}, heap.pose, facing);
  Summed plain, doubtful;
  sum_facets(heap.scene(), &masks.view, {1.5F, 0.25F}, heap.pose, plain.sums);
  sum_facets(heap.scene(), &masks.view, {1.5F, 0.25F, true}, heap.pose, doubtful.sums);
  double variance = plain.sums.product_variance[0], linear = 0;
  std::size_t hidden = 0;
  for (std::size_t k = 0; k < facing.facets.size(); ++k) {
    const SeenFacet &facet = facing.facets[k];
    const double *weight = weights.data() + k * facing.terms;
    const double whole = heap.groups[facet.group].area[facet.lane], n = 64;
    const double doubt = 1.5 * (1 / n) * (1 - 1 / n) / (n * std::sqrt(n)) * whole * whole;
    variance += weight[lobe_count] * weight[lobe_count] * doubt;
    linear += weight[lobe_count] * std::sqrt(facet.variance);
    hidden += facet.area == 0 ? 1u : 0u;
  }
  EXPECT_GT(hidden, 100u);
  EXPECT_NEAR(doubtful.sums.product[0], plain.sums.product[0], 1e-12 * plain.sums.product[0]);
  EXPECT_NEAR(doubtful.sums.product_variance[0], variance, 1e-9 * variance);
  EXPECT_NEAR(doubtful.sums.product_linear[0], linear, 1e-9 * linear);
}

/// What is handed back: the facets of a general slot, in the order of the groups.
TEST(FacetLoops, GeneralSlotsAreHandedBack) {
  Heap<float> heap;
  heap.slots[0].is_general = true;
  std::vector<SeenFacet> room(group_count * lanes);
  Summed out;
  out.sums.seen = SeenList(room);
  sum_facets(heap.scene(), nullptr, {}, heap.pose, out.sums);
  std::size_t facing = 0;
  for (const FacetGroup<float> &g : heap.groups)
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      const float across = 0.6F * g.nx[lane], up = 0.8F * g.nz[lane];
      facing += std::min(up + across, up - across) > 0 ? 1u : 0u;
    }
  EXPECT_EQ(out.sums.seen.size(), facing);
  EXPECT_GT(facing, 100u);
  EXPECT_EQ(out.sums.specular[0], 0);
}

} // namespace
} // namespace umov::backend
