#pragma once
// Private: what the facet loops read and write, held on the host; the loops take views of it.

#include "backend/scene_data.h"
#include "light/fast/huge_pages.h"

#include <algorithm>
#include <memory>
#include <vector>

namespace umov {

template <class T> using HugePages = std::vector<T, HugePageAllocator<T>>;

/// Of backend::GroupCones.
template <class T> struct ConesStore {
  std::vector<T> x, y, z, least;

  explicit ConesStore(const std::vector<backend::FacetGroup<T>> &groups = {}) {
    for (const auto &group : groups) {
      const backend::Cone cone = backend::cone_of(group);
      x.push_back(static_cast<T>(cone.axis[0]));
      y.push_back(static_cast<T>(cone.axis[1]));
      z.push_back(static_cast<T>(cone.axis[2]));
      least.push_back(static_cast<T>(cone.least));
    }
    for (auto *column : {&x, &y, &z, &least}) // what is read there is not used
      column->resize(column->size() + backend::lanes, T(0));
  }
  [[nodiscard]] backend::GroupCones<T> view() const { return {x, y, z, least}; }
};

/// Of backend::SceneData.
template <class T> struct SceneStore {
  std::vector<backend::FacetGroup<T>> groups;
  ConesStore<T> cones;
  std::vector<backend::Chunk> chunks;
  std::vector<backend::SlotTerms> slots;
  std::vector<kernel::LobeConstants<T>> lobes;
  std::vector<backend::LobeFamily<T>> families;
  std::vector<backend::Profile<T>> profiles;
  std::vector<backend::Product> products;
  std::vector<backend::LaneNumbers<T>> cluster_error;
  std::vector<backend::NormalPatch<T>> patches;
  std::vector<backend::PatchRange> patches_of;
  std::vector<T> node_first, node_second, node_weight;

  [[nodiscard]] backend::SceneData<T> view() const {
    return {groups,        cones.view(), chunks,     slots,
            lobes,         families,     profiles,   products,
            cluster_error, patches,      patches_of, {node_first, node_second, node_weight}};
  }
};

/// Where the blocks of one direction stand in the pool: rows may follow each other in any order.
struct MaskRow {
  std::uint32_t first = 0, count = 0;
};

/// Of backend::MaskTable.
struct MaskTableStore {
  std::size_t cells = 0, entries = 0;
  HugePages<std::uint32_t> offset;
  std::vector<MaskRow> row; ///< per direction

  [[nodiscard]] std::size_t directions() const { return (cells + 1) * (cells + 1); }
  [[nodiscard]] backend::MaskTable view() const { return {cells, entries, offset}; }
};

/// Of backend::Masks.
struct MaskStore {
  MaskTableStore small, large;
  std::vector<backend::GroupMask> groups;
  HugePages<backend::MaskBlock> pool;
  std::uint32_t longest = 0;

  [[nodiscard]] backend::Masks view() const {
    return {small.view(), large.view(), groups, pool, longest};
  }
};

/// Blocks of one entry of a group.
inline std::uint32_t blocks_of(const backend::GroupMask &group) {
  return group.words / (group.is_large ? std::uint32_t{backend::lanes} : 1u);
}

/// A pose with its own room. Moving it leaves the views right, as the room stays where it is.
template <class T> struct PoseStore : backend::PoseData<T> {
  std::vector<kernel::LobeAtPose<T>> lobe_room;

  PoseStore() = default;
  PoseStore(PoseStore &&) noexcept = default;
  PoseStore &operator=(PoseStore &&) noexcept = default;
  void resize(std::size_t count) {
    if (count == lobe_room.size())
      return;
    lobe_room.resize(count);
    this->lobes = lobe_room;
  }
};

/// A list of seen facets with its own room.
class SeenStore : public backend::SeenList {
public:
  /// Empty, with room for so many.
  void reset(std::size_t most) {
    if (most > size_) {
      room_ = std::make_unique_for_overwrite<backend::SeenFacet[]>(most);
      size_ = most;
    }
    backend::SeenList::operator=(backend::SeenList({room_.get(), size_}));
  }

private:
  std::unique_ptr<backend::SeenFacet[]> room_;
  std::size_t size_ = 0;
};

/// Weighed facets with their own room.
struct WeighedStore : backend::WeighedList {
  /// Empty, with room for so many of so many terms.
  void reset(std::size_t most, std::size_t of_terms) {
    facet_room_.reset(most);
    facets = facet_room_;
    weight_room_.resize(std::max(weight_room_.size(), most * of_terms));
    weights = weight_room_;
    terms = of_terms;
  }
  [[nodiscard]] const double *weights_of(std::size_t k) const { return weights.data() + k * terms; }
  /// Leaves those for which keep(facet) is true, in their order.
  template <class Keep> void keep_if(const Keep &keep) {
    std::size_t kept = 0;
    for (std::size_t k = 0; k < facets.size(); ++k)
      if (keep(facets[k])) {
        facets[kept] = facets[k];
        std::copy_n(weights_of(k), terms, weights.data() + kept++ * terms);
      }
    facets.truncate(kept);
  }

private:
  SeenStore facet_room_;
  std::vector<double> weight_room_;
};

/// Sums with their own room.
struct SumsStore : backend::PoseSums {
  SumsStore() = default;
  SumsStore(SumsStore &&) noexcept = default;
  SumsStore &operator=(SumsStore &&) noexcept = default;

  /// Zeros, in one piece of memory: a pose is summed in less than a microsecond.
  template <class T> void reset(const backend::SceneData<T> &scene) {
    if (specular.size() != scene.lobes.size() || product.size() != scene.products.size() ||
        lanes_ != scene.groups.size() * backend::lanes)
      make_room(scene.lobes.size(), scene.products.size(), scene.groups.size() * backend::lanes);
    std::fill(room_.begin(), room_.end(), 0.0);
    seen.clear();
    is_any_seen = false;
  }

private:
  void make_room(std::size_t lobes, std::size_t products, std::size_t lanes) {
    room_.resize(4 * lobes + 3 * products);
    double *next = room_.data();
    const auto take = [&](backend::View<double> &column, std::size_t size) {
      column = {next, size};
      next += size;
    };
    for (auto *column : {&specular, &specular_variance, &specular_bias, &specular_linear})
      take(*column, lobes);
    for (auto *column : {&product, &product_variance, &product_linear})
      take(*column, products);
    lanes_ = lanes;
    seen_room_.reset(lanes);
    seen = seen_room_;
  }
  std::vector<double> room_;
  std::size_t lanes_ = 0;
  SeenStore seen_room_;
};

} // namespace umov
