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
  T reach = T(4);         ///< facets whose 1 - n.h is less
  bool has_aside = false; ///< n.across too
  bool has_ids = false;   ///< which facet each is
  /// Facets too of which the masks hide all, with area 0; and one pseudo-disagreement in each
  /// deviation, for slivers that no point has found: what is looked up as wholly free or wholly
  /// hidden may still be a little of the other.
  bool has_doubts = false;
};

/// `Machine` names the lane type R, the scalar T, the mask of lanes, how to load, pack and count,
/// and how many groups its chunks have at most.
template <class Machine> class LitFacets {
  using R = typename Machine::R;
  using T = typename Machine::T;
  using Packer = typename Machine::Packer;
  static constexpr std::size_t lanes = backend::lanes, width = Machine::width;
  static constexpr std::size_t listed =
      Machine::groups_per_chunk + lanes; ///< a register is written whole
  static constexpr std::size_t room = (Machine::groups_per_chunk + 1) * lanes;

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
    varies_ = is_any_seen_ = false;
    if (masks_ == nullptr) {
      const std::size_t groups = list_facing(chunk.first, chunk.count);
      if (has_more(task))
        add_all<Known::Free, true>(facing_, groups, task);
      else
        add_whole(facing_, groups, task);
    } else {
      std::uint32_t small = chunk.count;
      while (small > 0 && masks_->groups[chunk.first + small - 1].is_large)
        --small;
      if (small > 0)
        gather_small(chunk.first, small, task);
      const std::size_t large = list_facing(chunk.first + small, chunk.count - small);
      for (std::size_t k = 0; k < large; ++k)
        add_large(facing_[k], task);
    }
    fill_register(task);
  }

  /// So many; what is read of the last register beyond them has no area.
  [[nodiscard]] UMOV_KERNEL std::size_t count() const { return count_; }
  /// Some area is lit and seen.
  [[nodiscard]] UMOV_KERNEL bool is_any_seen() const { return is_any_seen_; }
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
  [[nodiscard]] UMOV_KERNEL T apart_of(std::size_t k) const { return apart_[k]; }
  [[nodiscard]] UMOV_KERNEL T deviation_of(std::size_t k) const { return deviation_[k]; }

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

  /// What the masks know of a group whose directions are free, or partly so, or hidden.
  enum class Known : std::uint8_t { Free, FreeToSun, FreeToObserver, Nothing };

  /// Groups g, g + 1... of which some normals may face both directions.
  UMOV_KERNEL typename Machine::Mask face_both(std::uint32_t g) const {
    const R x = Machine::load_any(scene_.cones.x.data() + g),
            y = Machine::load_any(scene_.cones.y.data() + g),
            z = Machine::load_any(scene_.cones.z.data() + g),
            least = Machine::load_any(scene_.cones.least.data() + g);
    const R to_sun = x * to_.lx + y * to_.ly + z * to_.lz;
    const R to_observer = x * to_.vx + y * to_.vy + z * to_.vz;
    return min(to_sun, to_observer) > least;
  }

  /// Groups that a register has beyond the end are of others.
  UMOV_KERNEL static std::size_t without_others(const std::uint32_t *list, std::size_t count,
                                                std::uint32_t end) {
    while (count > 0 && list[count - 1] >= end)
      --count;
    return count;
  }

  UMOV_KERNEL std::size_t list_facing(std::uint32_t first, std::uint32_t groups) {
    constexpr std::uint32_t few = 3; // not worth a look
    const std::uint32_t end = first + groups;
    std::size_t count = 0;
    for (std::uint32_t g = first; groups <= few && g < end; ++g)
      facing_[count++] = g;
    for (std::uint32_t g = first; groups > few && g < end; g += width)
      count += put_groups(face_both(g), g, facing_ + count);
    return without_others(facing_, count, end);
  }

  /// The three rows of a table around a direction.
  struct Rows {
    const std::uint32_t *offset[3];
    UMOV_KERNEL Rows(const backend::MaskTable &table, const backend::GridLook &look) {
      for (std::size_t k = 0; k < 3; ++k)
        offset[k] = table.offset.data() + look.direction[k] * table.entries;
    }
    /// Entries e, e + 1... that are `what` in all three.
    [[nodiscard]] UMOV_KERNEL typename Machine::Mask are(std::uint32_t what,
                                                         std::uint32_t e) const {
      return Machine::all_three(offset[0] + e, offset[1] + e, offset[2] + e, what);
    }
  };

  /// Sixteen classes to a group, with few points each: sorted first by what is known of them, so
  /// that each kind is counted without a branch.
  UMOV_KERNEL void gather_small(std::uint32_t first, std::uint32_t groups,
                                const GatherTask<T> &task) {
    const Rows sun(masks_->small, pose_.small_sun), seen(masks_->small, pose_.small_observer);
    const std::uint32_t end = first + groups, entry = masks_->groups[first].entry;
    const std::uint32_t free = masks_->free(), hidden = masks_->hidden();
    std::size_t count[4] = {0, 0, 0, 0};
    for (std::uint32_t g = first; g < end; g += width) {
      const std::uint32_t e = entry + (g - first);
      auto faces = face_both(g);
      if (!task.has_doubts)
        faces = faces & !(sun.are(hidden, e) | seen.are(hidden, e));
      const auto free_sun = sun.are(free, e), free_seen = seen.are(free, e);
      count[0] += put_groups(faces & free_sun & free_seen, g, facing_ + count[0]);
      count[1] += put_groups(faces & free_sun & !free_seen, g, partly_[0] + count[1]);
      count[2] += put_groups(faces & !free_sun & free_seen, g, partly_[1] + count[2]);
      count[3] += put_groups(faces & !(free_sun | free_seen), g, partly_[2] + count[3]);
    }
    count[0] = without_others(facing_, count[0], end);
    for (std::size_t kind = 0; kind < 3; ++kind)
      count[kind + 1] = without_others(partly_[kind], count[kind + 1], end);
    const auto ask_for = [&](const Rows &rows, std::size_t kind) {
      for (std::size_t k = 0; k < count[kind + 1]; ++k)
        for (const std::uint32_t *offset : rows.offset)
          Machine::prefetch(masks_->pool.data() + offset[entry + (partly_[kind][k] - first)]);
    };
    ask_for(seen, 0);
    ask_for(sun, 1);
    ask_for(sun, 2);
    ask_for(seen, 2);
    add_all<Known::Free>(facing_, count[0], task); // while what was asked for comes
    add_all<Known::FreeToSun>(partly_[0], count[1], task);
    add_all<Known::FreeToObserver>(partly_[1], count[2], task);
    add_all<Known::Nothing>(partly_[2], count[3], task);
  }

  UMOV_KERNEL static std::size_t put_groups(typename Machine::Mask keep, std::uint32_t first,
                                            std::uint32_t *to) {
    const Packer pack(keep);
    pack.put_indices(first, to);
    return pack.count();
  }

  /// Something is asked for that rarely is: that costs no test where it is not.
  [[nodiscard]] UMOV_KERNEL bool has_more(const GatherTask<T> &task) const {
    return task.has_aside || task.has_ids || !scene_.cluster_error.empty();
  }
  template <Known known>
  UMOV_KERNEL void add_all(const std::uint32_t *groups, std::size_t count,
                           const GatherTask<T> &task) {
    if (has_more(task))
      add_all<known, true>(groups, count, task);
    else
      add_all<known, false>(groups, count, task);
  }
  template <Known known, bool has_all>
  UMOV_KERNEL_LOOP UMOV_KERNEL void add_all(const std::uint32_t *groups, std::size_t count,
                                            const GatherTask<T> &task) {
    const Directions to = to_; // nothing that is written may stand in it
    std::size_t at = count_;
    for (std::size_t k = 0; k < count; ++k)
      if constexpr (known == Known::Free)
        add_free<has_all>(groups[k], task, to, at);
      else
        add_small<known, has_all>(groups[k], task, to, at);
    if constexpr (known == Known::Free) {
      is_any_seen_ = is_any_seen_ || at > count_;
      for (std::size_t k = count_; !task.has_doubts && k < at; k += width)
        Machine::store_any(R(T(0)), deviation_ + k);
    }
    count_ = at;
    varies_ = varies_ || (count > 0 && (known != Known::Free || task.has_doubts));
  }

  /// Groups of which nothing is hidden, in whole registers whose other lanes have no area: most
  /// lanes of a group that faces both directions do so, and packing costs more than shading them.
  UMOV_KERNEL_LOOP UMOV_KERNEL void add_whole(const std::uint32_t *groups, std::size_t count,
                                              const GatherTask<T> &task) {
    const Directions to = to_;                     // nothing that is written may stand in it
    const kernel::FacetPose<T> pose = pose_.facet; // nor in these
    const GatherTask<T> asked = task;
    const backend::FacetGroup<T> *const all = scene_.groups.data();
    const R one = R(T(1)), none = R(T(0));
    std::size_t at = 0;
    for (std::size_t k = 0; k < count; ++k)
      for (std::size_t s = 0; s < lanes; s += width) {
        typename Machine::Mask keep;
        const Facets facets = face<false>(all[groups[k]], pose, s, asked, to, keep);
        Machine::store_any(select(keep, facets.n_l, one), n_l_ + at);
        Machine::store_any(select(keep, facets.n_v, one), n_v_ + at);
        Machine::store_any(select(keep, facets.apart, one), apart_ + at);
        Machine::store_any(select(keep, facets.area, none), area_ + at);
        at += Machine::any(keep) ? width : 0;
      }
    count_ = at;
    is_any_seen_ = at > 0;
  }

  /// Facets s, s + 1... of a group; `keep`: those that face both directions within reach.
  template <bool has_all>
  UMOV_KERNEL static Facets face(const backend::FacetGroup<T> &f, const kernel::FacetPose<T> &pose,
                                 std::size_t s, const GatherTask<T> &task, const Directions &to,
                                 typename Machine::Mask &keep) {
    const R x = Machine::load(f.nx + s), y = Machine::load(f.ny + s), z = Machine::load(f.nz + s);
    Facets out;
    out.n_l = x * to.lx + y * to.ly + z * to.lz;
    out.n_v = x * to.vx + y * to.vy + z * to.vz;
    out.apart = apart_from_half(pose, x, y, z);
    out.area = Machine::load(f.area + s);
    if (has_all && task.has_aside) {
      const T *const across = pose.across;
      out.aside = x * R(across[0]) + y * R(across[1]) + z * R(across[2]);
    }
    // A lane without a class has no area.
    keep = (min(min(out.n_l, out.n_v), out.area) > R(T(0))) & (out.apart < R(task.reach));
    return out;
  }

  /// Writes those of `pack` from `at` on, which moves behind them; their deviations stand already.
  template <bool has_all>
  UMOV_KERNEL void push(std::uint32_t group, std::size_t s, const GatherTask<T> &task,
                        const Facets &facets, const Packer &pack, std::size_t &at) {
    pack.put(facets.n_l, n_l_ + at);
    pack.put(facets.n_v, n_v_ + at);
    pack.put(facets.apart, apart_ + at);
    pack.put(facets.area, area_ + at);
    if constexpr (has_all) {
      if (task.has_aside)
        pack.put(facets.aside, aside_ + at);
      if (!scene_.cluster_error.empty())
        pack.put(Machine::load(scene_.cluster_error[group].value + s), cluster_error_ + at);
      if (task.has_ids)
        pack.put_indices(group * static_cast<std::uint32_t>(lanes) + static_cast<std::uint32_t>(s),
                         id_ + at);
    }
    at += pack.count();
  }

  template <bool has_all>
  UMOV_KERNEL void add_free(std::uint32_t group, const GatherTask<T> &task, const Directions &to,
                            std::size_t &at) {
    for (std::size_t s = 0; s < lanes; s += width) {
      typename Machine::Mask keep;
      const Facets facets = face<has_all>(scene_.groups[group], pose_.facet, s, task, to, keep);
      const Packer pack(keep);
      if (task.has_doubts)
        pack.put(facets.area * R(sqrt(doubt_of(masks_->groups[group]))), deviation_ + at);
      push<has_all>(group, s, task, facets, pack, at);
    }
  }

  /// Variance of the share of a class, of which all points but one agree.
  [[nodiscard]] UMOV_KERNEL T doubt_of(const backend::GroupMask &mask) const {
    const T points = T(32) * T(mask.words), unsure = T(1) / points * (T(1) - T(1) / points);
    return T(model_.points) * unsure / (points * sqrt(points));
  }

  /// Those of `keep` of which something is seen, or all that are in doubt.
  UMOV_KERNEL typename Machine::Mask take_seen(const GatherTask<T> &task, R share,
                                               typename Machine::Mask keep) {
    const auto seen = keep & (share > R(T(0)));
    is_any_seen_ = is_any_seen_ || Machine::any(seen);
    return task.has_doubts ? keep : seen;
  }

  template <Known known, bool has_all>
  UMOV_KERNEL void add_small(std::uint32_t group, const GatherTask<T> &task, const Directions &to,
                             std::size_t &at) {
    const backend::GroupMask &mask = masks_->groups[group];
    const EntryLook sun = look_up(*masks_, masks_->small, pose_.small_sun, mask.entry);
    const EntryLook seen = look_up(*masks_, masks_->small, pose_.small_observer, mask.entry);
    const T points = T(32) * T(mask.words);
    const R per_point = R(T(1) / points), doubt = R(task.has_doubts ? doubt_of(mask) : T(0));
    const R sampling = R(T(model_.points) / (points * sqrt(points))), grid = R(T(model_.grid));
    for (std::size_t s = 0; s < lanes; s += width) {
      typename Machine::Mask keep;
      Facets facets = face<has_all>(scene_.groups[group], pose_.facet, s, task, to, keep);
      if (!Machine::any(keep))
        continue;
      R share, mean_square;
      count_small<known>(sun, seen, mask.words, s, share, mean_square);
      share = share * per_point;
      mean_square = mean_square * per_point * per_point;
      const R variance = share * max(R(T(1)) - share, R(T(0))) * sampling +
                         max(mean_square - share * share, R(T(0))) * grid + doubt;
      keep = take_seen(task, share, keep);
      const R deviation = facets.area * sqrt(variance);
      facets.area = facets.area * share;
      const Packer pack(keep);
      pack.put(deviation, deviation_ + at);
      push<has_all>(group, s, task, facets, pack, at);
    }
  }

  /// Counts of nine pairs of directions, weighted. Where all directions around one are free, three
  /// tell what nine would.
  template <Known known>
  UMOV_KERNEL void count_small(const EntryLook &sun, const EntryLook &seen, std::size_t words,
                               std::size_t s, R &mean, R &mean_square) const {
    if constexpr (known == Known::FreeToObserver)
      Machine::template count_lanes<3, 1>(sun, seen, words, s, pose_.small_sun.weight, mean,
                                          mean_square);
    else if constexpr (known == Known::FreeToSun)
      Machine::template count_lanes<1, 3>(sun, seen, words, s, pose_.small_observer.weight, mean,
                                          mean_square);
    else
      Machine::template count_lanes<3, 3>(sun, seen, words, s, small_weight_, mean, mean_square);
  }

  /// Classes with many points each, one after the other.
  UMOV_KERNEL void add_large(std::uint32_t group, const GatherTask<T> &task) {
    const backend::GroupMask &mask = masks_->groups[group];
    alignas(64) T share[lanes], variance[lanes];
    const R doubt = R(task.has_doubts ? doubt_of(mask) : T(0));
    varies_ = varies_ || task.has_doubts;
    for (std::size_t s = 0; s < lanes; s += width) {
      typename Machine::Mask keep;
      Facets facets = face<true>(scene_.groups[group], pose_.facet, s, task, to_, keep);
      if (!Machine::any(keep))
        continue;
      for (std::size_t j = 0; j < width; ++j)
        share[j] = variance[j] = T(0);
      for (std::uint32_t rest = Machine::bits(keep); rest != 0; rest &= rest - 1) {
        const auto j = Machine::first_bit(rest);
        look_up_large(mask, static_cast<std::uint32_t>(mask.entry + s + j), share[j], variance[j]);
      }
      const R shares = Machine::load(share);
      keep = take_seen(task, shares, keep);
      const R deviations = facets.area * sqrt(Machine::load(variance) + doubt);
      facets.area = facets.area * shares;
      const Packer pack(keep);
      pack.put(deviations, deviation_ + count_);
      push<true>(group, s, task, facets, pack, count_);
    }
  }

  UMOV_KERNEL void look_up_large(const backend::GroupMask &mask, std::uint32_t entry, T &share,
                                 T &variance) {
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
    variance = sampling + max(mean_square - share * share, T(0)) * T(model_.grid);
  }

  /// The last register may be read whole: no light comes from what is beyond the last facet.
  UMOV_KERNEL void fill_register(const GatherTask<T> &task) {
    if (count_ % width == 0)
      return;
    Machine::store_any(R(T(1)), n_l_ + count_);
    Machine::store_any(R(T(1)), n_v_ + count_);
    Machine::store_any(R(T(1)), apart_ + count_);
    Machine::store_any(R(T(0)), area_ + count_);
    Machine::store_any(R(T(0)), deviation_ + count_);
    if (has_more(task)) {
      Machine::store_any(R(T(0)), aside_ + count_);
      Machine::store_any(R(T(0)), cluster_error_ + count_);
    }
  }

  const backend::SceneData<T> &scene_;
  const backend::Masks *masks_;
  const backend::MaskErrorModel &model_;
  const backend::PoseData<T> &pose_;
  const Directions to_;
  float small_weight_[9], large_weight_[9];
  std::size_t count_ = 0;
  bool varies_ = false, is_any_seen_ = false;
  std::uint32_t facing_[listed], partly_[3][listed]; ///< groups
  std::uint32_t id_[room];
  alignas(64) T n_l_[room], n_v_[room], apart_[room], area_[room], deviation_[room];
  alignas(64) T aside_[room], cluster_error_[room];
};

#include "kernel/end.h"
#endif
