#pragma once
// Private to the light curve: a scene flattened to what the facet loops read. T is float for the
// vector units and double for the scalar reference.

#include "backend/huge_pages.h"
#include "kernel/facet_constants.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace umov::backend {

/// Facets side by side, whatever the width of the vector unit: sums keep their order.
inline constexpr std::size_t lanes = 16;

/// Classes of equal normal and material; a lane without a class has area 0.
template <class T> struct alignas(64) FacetGroup {
  T nx[lanes]{}, ny[lanes]{}, nz[lanes]{}, area[lanes]{};
};

/// One number for each lane of a group.
template <class T> struct alignas(64) LaneNumbers { T value[lanes]{}; };

/// Groups of one slot that are summed in T before the sum goes to double.
struct Chunk {
  std::uint32_t first = 0, count = 0; ///< groups
  std::uint32_t slot = 0;             ///< into SceneData::slots
};
inline constexpr std::size_t groups_per_chunk = 64;

/// A symmetric product of two profiles of a slot: sum of area (n.l)(n.v) times the mean of
/// p_first(n.l) p_second(n.v) and p_second(n.l) p_first(n.v).
struct Product {
  std::uint32_t first = 0, second = 0; ///< counted from SlotTerms::profile_first
};
inline constexpr std::size_t profiles_max = 4, products_max = 8; ///< of one slot

/// A function of the cosine c as a polynomial in 2 (1 + bend) c / (c + bend) - 1.
template <class T> struct Profile {
  T c[kernel::polynomial_degree + 1]{};
  std::uint32_t degree = 0;
  T bend = 1; ///< the same for all profiles of a slot
};

/// Blinn-Phong lobes of one slot, one per band, that differ in m alone: their G2 is interpolated in
/// log m between a few lobes, and only D is computed for each.
inline constexpr std::size_t family_nodes_max = 6, family_lobes_max = 64;
template <class T> struct LobeFamily {
  std::uint32_t node_count = 0;
  kernel::LobeConstants<T> node[family_nodes_max];
  std::vector<std::array<T, family_nodes_max>> weight; ///< per lobe: Lagrange's, over 4
};

/// What is summed over the facets of one side of a material.
inline constexpr std::uint32_t no_family = ~0u;
struct SlotTerms {
  std::uint32_t lobe_first = 0, lobe_count = 0;
  std::uint32_t family = no_family; ///< of those lobes, if they are one
  std::uint32_t profile_first = 0, profile_count = 0;
  std::uint32_t product_first = 0, product_count = 0;
  bool is_general = false; ///< nothing is summed here: its seen facets are handed back
};

/// Bits of points that are free in a direction, for a grid of directions on the octahedron.
struct MaskTable {
  std::size_t cells = 0;   ///< per edge of the unfolded octahedron
  std::size_t entries = 0; ///< blocks per direction
  /// [direction * entries + entry], in units of 64 bytes
  std::vector<std::uint32_t, HugePageAllocator<std::uint32_t>> offset;
  std::vector<std::uint32_t> row; ///< first block of each direction in the pool, and the end
  [[nodiscard]] std::size_t directions() const { return (cells + 1) * (cells + 1); }
};

/// How the visible share of a group is looked up.
struct GroupMask {
  std::uint32_t entry = 0; ///< first entry of its table
  std::uint16_t words = 0; ///< per lane (32 points each)
  bool is_wide = false;    ///< an entry per lane, whose words are contiguous, in the second table
};

/// 64 bytes.
struct alignas(64) MaskBlock {
  std::uint32_t word[lanes];
};

struct Masks {
  MaskTable narrow, wide;
  std::vector<GroupMask> groups;
  /// Begins with `longest` blocks of zeros and as many of ones.
  std::vector<MaskBlock, HugePageAllocator<MaskBlock>> pool;
  std::uint32_t longest = 0; ///< blocks of the longest entry
  [[nodiscard]] std::uint32_t hidden() const { return 0; }
  [[nodiscard]] std::uint32_t free() const { return longest; }
};

template <class T> struct SceneData {
  std::vector<FacetGroup<T>> groups;
  std::vector<Chunk> chunks;
  std::vector<SlotTerms> slots;
  std::vector<kernel::LobeConstants<T>> lobes;
  std::vector<LobeFamily<T>> families;
  std::vector<Profile<T>> profiles;
  std::vector<Product> products;
  /// Per group and lane: relative error of the area's light from joining unlike normals.
  std::vector<LaneNumbers<T>> cluster_error; ///< empty: none
};

/// Three directions of a grid around one, with their weights.
struct GridLook {
  std::array<std::uint32_t, 3> direction{};
  std::array<float, 3> weight{};
};

/// One pose made ready: constants of the directions and of each lobe.
template <class T> struct PoseData {
  kernel::FacetPose<T> facet;
  std::vector<kernel::LobeAtPose<T>> lobes;
  std::vector<char> is_narrow; ///< per lobe: too narrow for the kernels at this pose
  GridLook narrow_sun, narrow_observer, wide_sun, wide_observer;
};

/// A facet whose light the caller computes.
struct SeenFacet {
  std::uint32_t group = 0, lane = 0, slot = 0;
  double area = 0, variance = 0; ///< seen area [m2] and the variance of that [m4]
};

struct PoseSums {
  std::span<double> specular, specular_variance;     ///< per lobe [m2/sr]
  std::span<double> specular_bias;                   ///< error from joined normals, added up
  std::span<double> product, product_variance;       ///< per product [m2]
  std::span<double> specular_linear, product_linear; ///< standard deviations, added up
  std::vector<SeenFacet> seen;                       ///< of general slots and narrow lobes
  bool is_any_seen = false;

  PoseSums() = default;
  PoseSums(PoseSums &&) = default;
  PoseSums &operator=(PoseSums &&) = default;
  /// Zeros, in one piece of memory: a pose is summed in less than a microsecond.
  void reset(std::size_t lobes, std::size_t products) {
    room_.assign(4 * lobes + 3 * products, 0);
    double *next = room_.data();
    const auto take = [&](std::span<double> &column, std::size_t size) {
      column = {next, size};
      next += size;
    };
    for (auto *column : {&specular, &specular_variance, &specular_bias, &specular_linear})
      take(*column, lobes);
    for (auto *column : {&product, &product_variance, &product_linear})
      take(*column, products);
    seen.clear();
    is_any_seen = false;
  }

private:
  std::vector<double> room_;
};

/// Error of the looked-up shares: sampling `points` of f (1 - f) / n^1.5, and `grid` of the
/// variance among the directions around; `alike` of the square of all standard deviations together
/// stands for what neighbouring classes have in common: the same shadow's edge crosses many
/// (docs/theory/engine.md).
struct MaskErrorModel {
  float points = 1, grid = 1, alike = 0;
};

/// Adds to the variances what the classes' errors have in common.
inline void add_alike(const MaskErrorModel &model, PoseSums &sums) {
  const auto add = [&](std::span<const double> linear, std::span<double> variance) {
    for (std::size_t k = 0; k < linear.size(); ++k)
      variance[k] += static_cast<double>(model.alike) * linear[k] * linear[k];
  };
  add(sums.specular_linear, sums.specular_variance);
  add(sums.product_linear, sums.product_variance);
}

/// Asks the processor for what the masks hold around the directions of a pose that comes soon:
/// random poses would wait for memory most of their time.
void prefetch(const Masks &masks, const GridLook &narrow_sun, const GridLook &narrow_observer,
              const GridLook &wide_sun, const GridLook &wide_observer);

/// Sums over all facets of a pose. `masks` may be null: nothing hides anything.
void sum_facets(const SceneData<double> &scene, const Masks *masks, const MaskErrorModel &model,
                const PoseData<double> &pose, PoseSums &out);
void sum_facets(const SceneData<float> &scene, const Masks *masks, const MaskErrorModel &model,
                const PoseData<float> &pose, PoseSums &out);

/// All facets of a pose that face Sun and observer, with the areas that the masks give and how
/// uncertain these are; `out` is emptied first.
void list_facing(const SceneData<double> &scene, const Masks &masks, const MaskErrorModel &model,
                 const PoseData<double> &pose, std::vector<SeenFacet> &out);

/// Facets of which something is both lit and seen, without variances.
void list_seen(const SceneData<double> &scene, const Masks *masks, const MaskErrorModel &model,
               const PoseData<double> &pose, std::vector<SeenFacet> &out);
/// Light of one facet per unit area without its colour: per lobe of its slot, then per product.
/// `weight` has room for all of them.
void weigh_facet(const SceneData<double> &scene, const PoseData<double> &pose,
                 const SeenFacet &facet, double *weight);

/// Which instruction sets `sum_facets` for float may use.
enum class InstructionSet { Best, Baseline, Sse4, Avx2, Avx512 };
/// Restricts the choice, for tests and benchmarks; false if this machine lacks it.
bool choose_instruction_set(InstructionSet set);
/// Name of the one in use.
const char *instruction_set_name();

} // namespace umov::backend
