#pragma once
// Private to src/light: a scene flattened to what the facet loops read, as views; src/light/fast
// holds the numbers (stores.h). T is float for the vector units and double for the scalar
// reference.

#include "backend/view.h"
#include "kernel/facet_constants.h"

#include <cstddef>
#include <cstdint>

namespace umov::backend {

/// Facets side by side, whatever the width of the vector unit: sums keep their order.
inline constexpr std::size_t lanes = 16;

/// Classes of equal normal and material; a lane without a class has area 0.
template <class T> struct alignas(64) FacetGroup {
  T nx[lanes]{}, ny[lanes]{}, nz[lanes]{}, area[lanes]{};
};

/// A cone around the normals of a group: some of them face a direction only if its cosine to the
/// axis is more than `least`.
struct Cone {
  double axis[3]{};
  double least = 0;
};
/// T is float or double.
template <class T> Cone cone_of(const FacetGroup<T> &group);

/// The cones of all groups, with room for a register beyond the last.
template <class T> struct GroupCones { View<const T> x, y, z, least; };

/// One number for each lane of a group.
template <class T> struct alignas(64) LaneNumbers { T value[lanes]{}; };

/// What the normal of a curved element takes on, evenly over its area: a triangle of unit normals,
/// by a corner and the ways from it to the others.
template <class T> struct NormalPatch {
  T corner[3]{}, first[3]{}, second[3]{};
  T share = 0;                                  ///< of its class's area
  std::uint32_t node_first = 0, node_count = 0; ///< into SceneData::patch_nodes
};
/// Patches of a class, of SceneData::patches.
struct PatchRange {
  std::uint32_t first = 0, count = 0;
};
/// Where the light of a patch is asked: parts of the ways to both other corners, and weights, whose
/// sum is 1. As many as `lanes` or a multiple, the last ones of no weight.
template <class T> struct PatchNodes { View<const T> first, second, weight; };

/// Groups of one slot that are summed in T before the sum goes to double.
struct Chunk {
  std::uint32_t first = 0, count = 0; ///< groups
  std::uint32_t slot = 0;             ///< into SceneData::slots
};
inline constexpr std::size_t groups_per_chunk = 64;

/// What a product of two profiles is a part of.
enum class ProductKind : std::uint8_t {
  Even,   ///< I: the mean of p_first(n.l) p_second(n.v) and p_second(n.l) p_first(n.v)
  Cosine, ///< Q of emission: p_first(n.l) p_second(n.v) (1 - (n.v)^2) cos of twice its plane's
          ///< angle
  Sine    ///< U: with the sine
};
/// A product of two profiles of a slot, summed with area (n.l)(n.v).
struct Product {
  std::uint32_t first = 0, second = 0; ///< counted from SlotTerms::profile_first
  ProductKind kind = ProductKind::Even;
};
inline constexpr std::size_t profiles_max = 6, products_max = 16; ///< of one slot

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
  T weight[family_lobes_max][family_nodes_max]{}; ///< per lobe: Lagrange's, over 4
};

/// What is summed over the facets of one side of a material.
inline constexpr std::uint32_t no_family = ~0u;
struct SlotTerms {
  std::uint32_t lobe_first = 0, lobe_count = 0;
  std::uint32_t family = no_family; ///< of those lobes, if they are one
  std::uint32_t profile_first = 0, profile_count = 0;
  std::uint32_t product_first = 0, product_count = 0;
  bool is_polarized = false; ///< some product is of Q or U
  bool is_general = false;   ///< nothing is summed here: its seen facets are handed back
  /// How far the normals of a class lie from the class's own, where the lobe of a curved part is
  /// narrower than the elements (SceneData::patches); 0: one normal stands for the class.
  float patch_spread = 0;
};

/// Bits of points that are free in a direction, for a grid of directions on the octahedron.
struct MaskTable {
  std::size_t cells = 0;   ///< per edge of the unfolded octahedron
  std::size_t entries = 0; ///< per direction
  /// [direction * entries + entry], in units of 64 bytes; with room for a register beyond the last.
  View<const std::uint32_t> offset;
};

/// How the visible share of a group is looked up. In a chunk the small ones come first, and their
/// entries follow each other.
struct GroupMask {
  std::uint32_t entry = 0; ///< first entry of its table
  std::uint16_t words = 0; ///< per lane (32 points each)
  bool is_large = false;   ///< an entry per lane, whose words are contiguous, in the second table
};

/// 64 bytes.
struct alignas(64) MaskBlock {
  std::uint32_t word[lanes];
};

/// Offsets of entries all of which is hidden, or free, in the pool: it begins with `longest` blocks
/// of zeros and as many of ones.
struct Masks {
  MaskTable small, large; ///< for small classes, 16 together, and for large ones
  View<const GroupMask> groups;
  View<const MaskBlock> pool;
  std::uint32_t longest = 0; ///< blocks of the longest entry
  [[nodiscard]] UMOV_KERNEL std::uint32_t hidden() const { return 0; }
  [[nodiscard]] UMOV_KERNEL std::uint32_t free() const { return longest; }
};

template <class T> struct SceneData {
  View<const FacetGroup<T>> groups;
  GroupCones<T> cones;
  View<const Chunk> chunks;
  View<const SlotTerms> slots;
  View<const kernel::LobeConstants<T>> lobes;
  View<const LobeFamily<T>> families;
  View<const Profile<T>> profiles;
  View<const Product> products;
  /// Per group and lane: relative error of the area's light from joining unlike normals.
  View<const LaneNumbers<T>> cluster_error; ///< empty: none
  View<const NormalPatch<T>> patches;
  View<const PatchRange> patches_of; ///< [group * lanes + lane]; empty: no slot has any
  PatchNodes<T> patch_nodes;
};

/// Three directions of a grid around one, with their weights.
struct GridLook {
  std::uint32_t direction[3]{};
  float weight[3]{};
};

/// One pose made ready: constants of the directions and of each lobe.
template <class T> struct PoseData {
  kernel::FacetPose<T> facet;
  View<const kernel::LobeAtPose<T>> lobes;
  GridLook small_sun, small_observer, large_sun, large_observer; ///< by table of masks
};

/// A facet whose light the caller computes. S is what sums are held in.
template <class S> struct SeenFacetOf {
  std::uint32_t group = 0, lane = 0, slot = 0;
  S area = 0, variance = 0; ///< seen area [m2] and the variance of that [m4]
};
using SeenFacet = SeenFacetOf<double>;

/// Facets in room that is enough for all lanes of a scene.
template <class S> class SeenListOf {
public:
  SeenListOf() = default;
  UMOV_KERNEL explicit SeenListOf(View<SeenFacetOf<S>> room) : room_(room) {}
  UMOV_KERNEL void clear() { size_ = 0; }
  UMOV_KERNEL void push(const SeenFacetOf<S> &facet) { room_[size_++] = facet; }
  UMOV_KERNEL SeenFacetOf<S> &operator[](std::size_t i) const { return room_[i]; }
  [[nodiscard]] UMOV_KERNEL std::size_t size() const { return size_; }
  [[nodiscard]] UMOV_KERNEL bool empty() const { return size_ == 0; }
  [[nodiscard]] UMOV_KERNEL SeenFacetOf<S> *begin() const { return room_.begin(); }
  [[nodiscard]] UMOV_KERNEL SeenFacetOf<S> *end() const { return room_.begin() + size_; }
  /// Leaves the first ones.
  UMOV_KERNEL void truncate(std::size_t size) { size_ = size; }

private:
  View<SeenFacetOf<S>> room_;
  std::size_t size_ = 0;
};
using SeenList = SeenListOf<double>;

template <class S> struct PoseSumsOf {
  View<S> specular, specular_variance;     ///< per lobe [m2/sr]
  View<S> specular_bias;                   ///< error from joined normals, added up
  View<S> product, product_variance;       ///< per product [m2]
  View<S> specular_linear, product_linear; ///< standard deviations, added up
  SeenListOf<S> seen;                      ///< of general slots
  bool is_any_seen = false;
};
using PoseSums = PoseSumsOf<double>;

/// Error of the looked-up shares: sampling `points` of f (1 - f) / n^1.5, and `grid` of the
/// variance among the directions around (docs/theory/engine.md).
struct MaskErrorModel {
  float points = 1, grid = 1;
  bool has_doubts = false; ///< what is looked up as wholly free or hidden is uncertain too
};

/// Asks the processor for where the masks stand around the directions of a pose that comes soon:
/// random poses would wait for memory most of their time.
void prefetch(const Masks &masks, const GridLook &small_sun, const GridLook &small_observer,
              const GridLook &large_sun, const GridLook &large_observer);

/// Adds the sums over all facets of a pose to `out`, which holds zeros. `masks` may be null:
/// nothing hides anything.
void sum_facets(const SceneData<double> &scene, const Masks *masks, const MaskErrorModel &model,
                const PoseData<double> &pose, PoseSums &out);
void sum_facets(const SceneData<float> &scene, const Masks *masks, const MaskErrorModel &model,
                const PoseData<float> &pose, PoseSums &out);

/// Facets with what each weighs in the sums: light per unit area without its colour.
template <class S> struct WeighedListOf {
  SeenListOf<S> facets;
  View<S> weights;       ///< [facet * terms + term]: lobes of its slot, then products
  std::size_t terms = 0; ///< of the slot that has most
};
using WeighedList = WeighedListOf<double>;

/// The facets of a pose that have light, with the areas that the masks give and how uncertain these
/// are; with doubts those too of which the masks hide all. `out` is emptied first; weights of
/// general slots are not set.
void list_weighed(const SceneData<double> &scene, const Masks *masks, const MaskErrorModel &model,
                  const PoseData<double> &pose, WeighedList &out);
void list_weighed(const SceneData<float> &scene, const Masks *masks, const MaskErrorModel &model,
                  const PoseData<float> &pose, WeighedList &out);

/// Facets of which something is both lit and seen, without variances: of all groups, or of those of
/// some chunks.
void list_seen(const SceneData<double> &scene, const Masks *masks, const MaskErrorModel &model,
               const PoseData<double> &pose, SeenList &out);
void list_seen(const SceneData<double> &scene, View<const Chunk> chunks, const Masks *masks,
               const MaskErrorModel &model, const PoseData<double> &pose, SeenList &out);

/// Which instruction sets the loops for float may use.
enum class InstructionSet { Best, Baseline, Sse4, Avx2, Avx512 };
/// Restricts the choice, for tests and benchmarks; false if this machine lacks it.
bool choose_instruction_set(InstructionSet set);
/// Name of the one in use.
const char *instruction_set_name();

} // namespace umov::backend
