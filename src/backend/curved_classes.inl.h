// Classes of curved parts that a lobe is narrower than: its mean over all their normals, where it
// is near. docs/theory/engine.md.
#if defined(UMOV_BACKEND_CURVED_CLASSES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef UMOV_BACKEND_CURVED_CLASSES_INL_H
#undef UMOV_BACKEND_CURVED_CLASSES_INL_H
#else
#define UMOV_BACKEND_CURVED_CLASSES_INL_H
#endif

#include "backend/lit_facets.inl.h"
#include "kernel/facet.inl.h"

#include "kernel/begin.h"

/// Distance of a class's normal from the half vector up to which its normals are taken one by one.
/// Gaussians: where the lobe is 1e-11 of its peak, which eight widths of the mean over the disk
/// reach; its `reach` says 13.4, or those eight where the disk is cut into chords. GGX falls with
/// the fourth power: beyond eight alpha and some elements, middles miss less than 1e-4 of the peak.
template <class T>
UMOV_KERNEL T near_chord(const LobeConstants<T> &lobe, const LobeAtPose<T> &at, T spread) {
  if (lobe.kind == LobeKind::Ggx)
    return T(6) * spread + T(8) * lobe.shape + sqrt(at.across);
  return sqrt(T(2) * at.reach) * (at.uses_chords ? T(1) : T(0.6)) + spread;
}

/// Weights of classes among those that are lit and seen.
template <class Machine> class CurvedClasses {
  using R = typename Machine::R;
  using T = typename Machine::T;
  static constexpr std::size_t lanes = backend::lanes, width = Machine::width;
  static constexpr std::size_t room = (Machine::groups_per_chunk + 1) * lanes;

public:
  UMOV_KERNEL CurvedClasses(const backend::SceneData<T> &scene, const backend::PoseData<T> &pose)
      : scene_(scene), pose_(pose) {}

  /// Of one lobe, for those of `lit` that it is near to; ids were asked for.
  UMOV_KERNEL void weigh(std::size_t lobe, const backend::SlotTerms &slot,
                         const LitFacets<Machine> &lit) {
    const T chord =
        near_chord(scene_.lobes[lobe], pose_.lobes[lobe], static_cast<T>(slot.patch_spread));
    const T least = chord * chord / T(2);
    std::size_t k = 0;
    for (; k < lit.count(); ++k) {
      weight_[k] = T(-1);
      if (!(lit.apart_of(k) < least))
        continue;
      const backend::PatchRange &range = scene_.patches_of[lit.group(k) * lanes + lit.lane(k)];
      if (range.count > 0)
        weight_[k] = mean_weight(lobe, range);
    }
    for (; k % width != 0; ++k) // the last register is read whole
      weight_[k] = T(-1);
  }

  [[nodiscard]] UMOV_KERNEL bool has_one(std::size_t k) const { return !(weight_[k] < T(0)); }
  [[nodiscard]] UMOV_KERNEL T one(std::size_t k) const { return weight_[k]; }
  /// Some facet of a register has light of its own.
  [[nodiscard]] UMOV_KERNEL bool has_any(std::size_t k) const {
    return Machine::any(Machine::load(weight_ + k) > R(T(0)));
  }
  /// `w`, and where a facet has a weight of its own that.
  [[nodiscard]] UMOV_KERNEL R in_place_of(R w, std::size_t k) const {
    const R own = Machine::load(weight_ + k);
    return select(own < R(T(0)), w, own);
  }

private:
  UMOV_KERNEL T mean_weight(std::size_t lobe, const backend::PatchRange &range) const {
    R sum = R(T(0));
    for (std::uint32_t p = range.first; p < range.first + range.count; ++p) {
      const backend::NormalPatch<T> &patch = scene_.patches[p];
      R part = R(T(0));
      for (std::uint32_t k = 0; k < patch.node_count; k += width)
        part = part + weight_at(lobe, patch, patch.node_first + k);
      sum = sum + part * R(patch.share);
    }
    return static_cast<T>(Machine::total(sum));
  }

  /// Of some nodes of a patch.
  UMOV_KERNEL R weight_at(std::size_t lobe, const backend::NormalPatch<T> &patch,
                          std::size_t node) const {
    const R u = Machine::load_any(scene_.patch_nodes.first.data() + node),
            v = Machine::load_any(scene_.patch_nodes.second.data() + node);
    const auto along = [&](std::size_t axis) {
      return R(patch.corner[axis]) + u * R(patch.first[axis]) + v * R(patch.second[axis]);
    };
    R x = along(0), y = along(1), z = along(2);
    const R scale = inverse_sqrt(x * x + y * y + z * z);
    x = x * scale;
    y = y * scale;
    z = z * scale;
    const kernel::FacetPose<T> &pose = pose_.facet;
    const R n_l = x * R(pose.sun[0]) + y * R(pose.sun[1]) + z * R(pose.sun[2]);
    const R n_v = x * R(pose.observer[0]) + y * R(pose.observer[1]) + z * R(pose.observer[2]);
    const R least = R(T(1e-6)); // what faces away counts for nothing, but is computed
    const R w = lobe_weight(scene_.lobes[lobe], pose_.lobes[lobe], pose,
                            apart_from_half(pose, x, y, z), max(n_l, least), max(n_v, least));
    return select(min(n_l, n_v) > R(T(0)), w, R(T(0))) *
           Machine::load_any(scene_.patch_nodes.weight.data() + node);
  }

  const backend::SceneData<T> &scene_;
  const backend::PoseData<T> &pose_;
  alignas(64) T weight_[room]; ///< negative: as its one normal has it
};

/// Of a scene without any: no room, and nothing to ask.
template <class Machine> struct NoCurvedClasses {
  using T = typename Machine::T;
  UMOV_KERNEL NoCurvedClasses(const backend::SceneData<T> &, const backend::PoseData<T> &) {}
  UMOV_KERNEL void weigh(std::size_t, const backend::SlotTerms &, const LitFacets<Machine> &) {}
  [[nodiscard]] UMOV_KERNEL bool has_one(std::size_t) const { return false; }
  [[nodiscard]] UMOV_KERNEL T one(std::size_t) const { return T(0); }
  [[nodiscard]] UMOV_KERNEL bool has_any(std::size_t) const { return false; }
  [[nodiscard]] UMOV_KERNEL typename Machine::R in_place_of(typename Machine::R w,
                                                            std::size_t) const {
    return w;
  }
};

#include "kernel/end.h"
#endif
