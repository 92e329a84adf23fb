// Which facets of a chunk are lit and seen, and how much of each: listed side by side without gaps,
// so that what shades them neither branches nor computes a lane in vain.
#if defined(UMOV_BACKEND_LIT_FACETS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef UMOV_BACKEND_LIT_FACETS_INL_H
#undef UMOV_BACKEND_LIT_FACETS_INL_H
#else
#define UMOV_BACKEND_LIT_FACETS_INL_H
#endif

#include "backend/mask_look.inl.h"
#include "kernel/facet.inl.h"

#include "kernel/begin.h"

/// What is asked of a chunk.
template <class T> struct GatherTask {
  T reach = T(4);            ///< facets whose 1 - n.h is less
  bool has_aside = false;    ///< n.across too
  bool has_ids = false;      ///< which facet each is
  bool keeps_hidden = false; ///< facets too of which the masks hide all, with area 0
};

/// `Machine` names the lane type R, the scalar T, the mask of lanes, how to load, pack and count.
template <class Machine> class LitFacets {
  using R = typename Machine::R;
  using T = typename Machine::T;
  using Packer = typename Machine::Packer;
  static constexpr std::size_t lanes = backend::lanes, width = Machine::width;
  static constexpr std::size_t room = (backend::groups_per_chunk + 1) * lanes;

public:
  UMOV_KERNEL LitFacets(const backend::SceneData<T> &scene, const backend::Masks *masks,
                        const backend::MaskErrorModel &model, const backend::PoseData<T> &pose)
      : scene_(scene), masks_(masks), model_(model), pose_(pose), to_(pose.facet) {
    if (masks != nullptr)
      for (std::size_t a = 0; a < 3; ++a)
        for (std::size_t b = 0; b < 3; ++b) {
          small_weight_[3 * a + b] = pose.small_sun.weight[a] * pose.small_observer.weight[b];
          large_weight_[3 * a + b] = pose.large_sun.weight[a] * pose.large_observer.weight[b];
        }
  }

  UMOV_KERNEL void gather(const backend::Chunk &chunk, const GatherTask<T> &task) {
    count_ = 0;
    varies_ = false;
    const std::size_t groups = list_facing(chunk);
    for (std::size_t k = 0; k < groups; ++k)
      if (masks_ != nullptr)
        add_masked(facing_[k], task);
      else
        add_free(facing_[k], task);
    fill_register();
  }

  /// So many; what is read of the last register beyond them has no area.
  [[nodiscard]] UMOV_KERNEL std::size_t count() const { return count_; }
  /// Some area is uncertain; else no deviation need be read.
  [[nodiscard]] UMOV_KERNEL bool varies() const { return varies_; }
  [[nodiscard]] UMOV_KERNEL R n_l(std::size_t k) const { return Machine::load(n_l_ + k); }
  [[nodiscard]] UMOV_KERNEL R n_v(std::size_t k) const { return Machine::load(n_v_ + k); }
  [[nodiscard]] UMOV_KERNEL R apart(std::size_t k) const { return Machine::load(apart_ + k); }
  [[nodiscard]] UMOV_KERNEL R area(std::size_t k) const { return Machine::load(area_ + k); }
  [[nodiscard]] UMOV_KERNEL R deviation(std::size_t k) const {
    return Machine::load(deviation_ + k);
  }
  [[nodiscard]] UMOV_KERNEL R aside(std::size_t k) const { return Machine::load(aside_ + k); }
  /// Relative error of the light at the lobe's peak from unlike normals in a class.
  [[nodiscard]] UMOV_KERNEL R cluster_error(std::size_t k) const {
    return Machine::load(cluster_error_ + k);
  }
  /// Of one facet, where ids were asked for.
  [[nodiscard]] UMOV_KERNEL std::uint32_t group(std::size_t k) const {
    return id_[k] / static_cast<std::uint32_t>(lanes);
  }
  [[nodiscard]] UMOV_KERNEL std::uint32_t lane(std::size_t k) const {
    return id_[k] % static_cast<std::uint32_t>(lanes);
  }
  [[nodiscard]] UMOV_KERNEL T area_of(std::size_t k) const { return area_[k]; }
  [[nodiscard]] UMOV_KERNEL T deviation_of(std::size_t k) const {
    return masks_ != nullptr ? deviation_[k] : T(0);
  }

private:
  /// Directions in lanes, loaded once.
  struct Directions {
    R lx, ly, lz, vx, vy, vz;
    UMOV_KERNEL explicit Directions(const kernel::FacetPose<T> &p)
        : lx(R(p.sun[0])), ly(R(p.sun[1])), lz(R(p.sun[2])), vx(R(p.observer[0])),
          vy(R(p.observer[1])), vz(R(p.observer[2])) {}
  };
  /// One register of facets.
  struct Facets {
    R n_l, n_v, apart, area, aside;
  };

  /// Groups whose cone of normals has some that face both directions.
  UMOV_KERNEL std::size_t list_facing(const backend::Chunk &chunk) {
    const std::uint32_t end = chunk.first + chunk.count;
    if (chunk.count == 1) {
      facing_[0] = chunk.first;
      return 1;
    }
    std::size_t count = 0;
    for (std::uint32_t g = chunk.first; g < end; g += width) {
      const R x = Machine::load_any(scene_.cones.x.data() + g),
              y = Machine::load_any(scene_.cones.y.data() + g),
              z = Machine::load_any(scene_.cones.z.data() + g),
              least = Machine::load_any(scene_.cones.least.data() + g);
      const R to_sun = x * to_.lx + y * to_.ly + z * to_.lz;
      const R to_observer = x * to_.vx + y * to_.vy + z * to_.vz;
      const Packer pack(min(to_sun, to_observer) > least);
      pack.put_indices(g, facing_ + count);
      count += pack.count();
    }
    while (count > 0 && facing_[count - 1] >= end) // of the next chunk, in the same register
      --count;
    return count;
  }

  /// Facets s, s + 1... of a group; `keep`: those that face both directions within reach.
  UMOV_KERNEL Facets face(std::uint32_t group, std::size_t s, const GatherTask<T> &task,
                          typename Machine::Mask &keep) const {
    const backend::FacetGroup<T> &f = scene_.groups[group];
    const R x = Machine::load(f.nx + s), y = Machine::load(f.ny + s), z = Machine::load(f.nz + s);
    Facets out;
    out.n_l = x * to_.lx + y * to_.ly + z * to_.lz;
    out.n_v = x * to_.vx + y * to_.vy + z * to_.vz;
    out.apart = apart_from_half(pose_.facet, x, y, z);
    out.area = Machine::load(f.area + s);
    if (task.has_aside) {
      const T *const across = pose_.facet.across;
      out.aside = x * R(across[0]) + y * R(across[1]) + z * R(across[2]);
    }
    // A lane without a class has no area.
    keep = (min(min(out.n_l, out.n_v), out.area) > R(T(0))) & (out.apart < R(task.reach));
    return out;
  }

  UMOV_KERNEL void push(std::uint32_t group, std::size_t s, const GatherTask<T> &task,
                        const Facets &facets, R deviation, const Packer &pack) {
    pack.put(facets.n_l, n_l_ + count_);
    pack.put(facets.n_v, n_v_ + count_);
    pack.put(facets.apart, apart_ + count_);
    pack.put(facets.area, area_ + count_);
    if (masks_ != nullptr)
      pack.put(deviation, deviation_ + count_);
    if (task.has_aside)
      pack.put(facets.aside, aside_ + count_);
    if (!scene_.cluster_error.empty())
      pack.put(Machine::load(scene_.cluster_error[group].value + s), cluster_error_ + count_);
    if (task.has_ids)
      pack.put_indices(group * static_cast<std::uint32_t>(lanes) + static_cast<std::uint32_t>(s),
                       id_ + count_);
    count_ += pack.count();
  }

  UMOV_KERNEL void add_free(std::uint32_t group, const GatherTask<T> &task) {
    for (std::size_t s = 0; s < lanes; s += width) {
      typename Machine::Mask keep;
      const Facets facets = face(group, s, task, keep);
      push(group, s, task, facets, R(T(0)), Packer(keep));
    }
  }

  UMOV_KERNEL void add_masked(std::uint32_t group, const GatherTask<T> &task) {
    const backend::GroupMask &mask = masks_->groups[group];
    if (mask.is_large)
      return add_large(group, mask, task);
    const EntryLook sun = look_up(*masks_, masks_->small, pose_.small_sun, mask.entry);
    const EntryLook seen = look_up(*masks_, masks_->small, pose_.small_observer, mask.entry);
    if ((sun.is_hidden || seen.is_hidden) && !task.keeps_hidden)
      return;
    if (sun.is_free && seen.is_free)
      return add_free(group, task);
    add_small(group, mask, sun, seen, task);
  }

  /// Sixteen classes with few points each.
  UMOV_KERNEL void add_small(std::uint32_t group, const backend::GroupMask &mask,
                             const EntryLook &sun, const EntryLook &seen,
                             const GatherTask<T> &task) {
    const T points = T(32) * T(mask.words);
    const R per_point = R(T(1) / points);
    const R sampling = R(T(model_.points) / (points * sqrt(points))), grid = R(T(model_.grid));
    for (std::size_t s = 0; s < lanes; s += width) {
      typename Machine::Mask keep;
      Facets facets = face(group, s, task, keep);
      if (!Machine::any(keep))
        continue;
      R share, mean_square;
      count_small(sun, seen, mask.words, s, share, mean_square);
      share = share * per_point;
      mean_square = mean_square * per_point * per_point;
      const R variance = share * max(R(T(1)) - share, R(T(0))) * sampling +
                         max(mean_square - share * share, R(T(0))) * grid;
      if (!task.keeps_hidden)
        keep = keep & (share > R(T(0)));
      const R deviation = facets.area * sqrt(variance);
      facets.area = facets.area * share;
      push(group, s, task, facets, deviation, Packer(keep));
      varies_ = true;
    }
  }

  /// Counts of nine pairs of directions, weighted. Where all directions around one are free, three
  /// tell what nine would.
  UMOV_KERNEL void count_small(const EntryLook &sun, const EntryLook &seen, std::size_t words,
                               std::size_t s, R &mean, R &mean_square) const {
    if (seen.is_free)
      Machine::template count_lanes<3, 1>(sun, seen, words, s, pose_.small_sun.weight, mean,
                                          mean_square);
    else if (sun.is_free)
      Machine::template count_lanes<1, 3>(sun, seen, words, s, pose_.small_observer.weight, mean,
                                          mean_square);
    else
      Machine::template count_lanes<3, 3>(sun, seen, words, s, small_weight_, mean, mean_square);
  }

  /// Classes with many points each, one after the other.
  UMOV_KERNEL void add_large(std::uint32_t group, const backend::GroupMask &mask,
                             const GatherTask<T> &task) {
    alignas(64) T share[lanes], deviation[lanes];
    for (std::size_t s = 0; s < lanes; s += width) {
      typename Machine::Mask keep;
      Facets facets = face(group, s, task, keep);
      if (!Machine::any(keep))
        continue;
      for (std::size_t j = 0; j < width; ++j)
        share[j] = deviation[j] = T(0);
      for (std::uint32_t rest = Machine::bits(keep); rest != 0; rest &= rest - 1) {
        const auto j = Machine::first_bit(rest);
        look_up_large(mask, static_cast<std::uint32_t>(mask.entry + s + j), share[j], deviation[j]);
      }
      const R shares = Machine::load(share);
      if (!task.keeps_hidden)
        keep = keep & (shares > R(T(0)));
      const R deviations = facets.area * Machine::load(deviation);
      facets.area = facets.area * shares;
      push(group, s, task, facets, deviations, Packer(keep));
    }
  }

  UMOV_KERNEL void look_up_large(const backend::GroupMask &mask, std::uint32_t entry, T &share,
                                 T &deviation) {
    const EntryLook sun = look_up(*masks_, masks_->large, pose_.large_sun, entry);
    const EntryLook seen = look_up(*masks_, masks_->large, pose_.large_observer, entry);
    if (sun.is_hidden || seen.is_hidden)
      return;
    if (sun.is_free && seen.is_free) {
      share = T(1);
      return;
    }
    varies_ = true;
    float count[9];
    Machine::count_long(sun, seen, mask.words, count);
    const T points = T(32) * T(mask.words);
    T mean_square = 0;
    for (std::size_t k = 0; k < 9; ++k) {
      const T f = T(count[k]) / points, w = T(large_weight_[k]);
      share += w * f;
      mean_square += w * f * f;
    }
    const T sampling = share * max(T(1) - share, T(0)) * T(model_.points) / (points * sqrt(points));
    deviation = sqrt(sampling + max(mean_square - share * share, T(0)) * T(model_.grid));
  }

  /// The last register may be read whole: no light comes from what is beyond the last facet.
  UMOV_KERNEL void fill_register() {
    if (count_ % width == 0)
      return;
    Machine::store_any(R(T(1)), n_l_ + count_);
    Machine::store_any(R(T(1)), n_v_ + count_);
    Machine::store_any(R(T(1)), apart_ + count_);
    for (T *column : {area_, deviation_, aside_, cluster_error_})
      Machine::store_any(R(T(0)), column + count_);
  }

  const backend::SceneData<T> &scene_;
  const backend::Masks *masks_;
  const backend::MaskErrorModel &model_;
  const backend::PoseData<T> &pose_;
  const Directions to_;
  float small_weight_[9], large_weight_[9];
  std::size_t count_ = 0;
  bool varies_ = false;
  std::uint32_t facing_[room];
  std::uint32_t id_[room];
  alignas(64) T n_l_[room], n_v_[room], apart_[room], area_[room], deviation_[room];
  alignas(64) T aside_[room], cluster_error_[room];
};

#include "kernel/end.h"
#endif
