// The loops over facets: which are lit and seen, how much of each, and what they add up to. The
// same text for every instruction set; what differs is in `load`, `store`, `total` and the counting
// of bits, which stand above its inclusion.
#if defined(UMOV_BACKEND_FACET_LOOPS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef UMOV_BACKEND_FACET_LOOPS_INL_H
#undef UMOV_BACKEND_FACET_LOOPS_INL_H
#else
#define UMOV_BACKEND_FACET_LOOPS_INL_H
#endif

#include "backend/scene_data.h"
#include "kernel/body.inl.h"
#include "kernel/facet.inl.h"

#include "kernel/begin.h"

using backend::Chunk;
using backend::FacetGroup;
using backend::GridLook;
using backend::GroupMask;
using backend::MaskBlock;
using backend::MaskErrorModel;
using backend::Masks;
using backend::MaskTable;
using backend::PoseData;
using backend::PoseSumsOf;
using backend::ProductKind;
using backend::SceneData;
using backend::SeenListOf;
using backend::SlotTerms;
using backend::View;

/// The blocks of one entry in the three directions around one.
struct EntryLook {
  const MaskBlock *block[3];
  bool is_free = false, is_hidden = false;
};

UMOV_KERNEL EntryLook look_up(const Masks &masks, const MaskTable &table, const GridLook &look,
                              std::uint32_t entry) {
  EntryLook out;
  std::uint32_t offset[3];
  for (std::size_t k = 0; k < 3; ++k) {
    offset[k] = table.offset[look.direction[k] * table.entries + entry];
    out.block[k] = masks.pool.data() + offset[k];
  }
  out.is_free = offset[0] == masks.free() && offset[1] == masks.free() && offset[2] == masks.free();
  out.is_hidden =
      offset[0] == masks.hidden() && offset[1] == masks.hidden() && offset[2] == masks.hidden();
  return out;
}

/// (n.k) p(n.k) of a slot's profiles, of which there are some, towards both directions.
template <class R> struct ProfileValues {
  R in[backend::profiles_max], out[backend::profiles_max];
  EmissionTurn<R> turn; ///< if the slot is polarized
  template <class T> UMOV_KERNEL R product(const backend::Product &p) const {
    switch (p.kind) {
    case ProductKind::Cosine:
      return in[p.first] * out[p.second] * turn.cosine;
    case ProductKind::Sine:
      return in[p.first] * out[p.second] * turn.sine;
    case ProductKind::Even:
      break;
    }
    return R(T(0.5)) * (in[p.first] * out[p.second] + in[p.second] * out[p.first]);
  }
};
template <class R, class T>
UMOV_KERNEL ProfileValues<R> profile_values(const SceneData<T> &scene, const SlotTerms &slot, R n_l,
                                            R n_v) {
  ProfileValues<R> out;
  if (slot.profile_count == 1 && scene.profiles[slot.profile_first].degree == 0) { // Lambert's
    out.in[0] = n_l * R(scene.profiles[slot.profile_first].c[0]);
    out.out[0] = n_v * R(scene.profiles[slot.profile_first].c[0]);
    return out;
  }
  const T bend = scene.profiles[slot.profile_first].bend;
  const R scale = R(T(2) * (T(1) + bend));
  const R t_l = scale * n_l / (n_l + R(bend)) - R(T(1));
  const R t_v = scale * n_v / (n_v + R(bend)) - R(T(1));
  for (std::size_t i = 0; i < slot.profile_count; ++i) {
    const auto &profile = scene.profiles[slot.profile_first + i];
    // Both directions at once: neither waits for the other's chain.
    R in = R(profile.c[profile.degree]), seen = in;
    for (std::size_t k = profile.degree; k-- > 0;) {
      const R c = R(profile.c[k]);
      in = in * t_l + c;
      seen = seen * t_v + c;
    }
    out.in[i] = n_l * in;
    out.out[i] = n_v * seen;
  }
  return out;
}

/// Sums of one pose. `Machine` names the lane type R, the scalar T, what sums are held
/// in, S, and how to load and count.
template <class Machine> class FacetLoops {
  using R = typename Machine::R;
  using T = typename Machine::T;
  using S = typename Machine::S;
  static constexpr std::size_t lanes = backend::lanes, width = Machine::width;

public:
  UMOV_KERNEL FacetLoops(const SceneData<T> &scene, const Masks *masks, const MaskErrorModel &model,
                         const PoseData<T> &pose, PoseSumsOf<S> &out)
      : scene_(scene), masks_(masks), model_(model), pose_(pose), out_(out) {
    for (std::size_t a = 0; a < 3; ++a)
      for (std::size_t b = 0; b < 3; ++b) {
        small_weight_[3 * a + b] = pose.small_sun.weight[a] * pose.small_observer.weight[b];
        large_weight_[3 * a + b] = pose.large_sun.weight[a] * pose.large_observer.weight[b];
      }
  }

  UMOV_KERNEL void run() {
    bool is_any_left_out = false;
    for (const Chunk &chunk : scene_.chunks) {
      const T reach = reach_of(scene_.slots[chunk.slot]);
      if (reach < T(2)) {
        find_facing<true>(chunk, reach);
        is_any_left_out = true;
      } else
        find_facing<false>(chunk);
      if (masks_ != nullptr)
        hide();
      if (count_ == 0)
        continue;
      out_.is_any_seen = true;
      const SlotTerms &slot = scene_.slots[chunk.slot];
      if (slot.is_general)
        hand_back(chunk.slot);
      else if (is_closed_family(slot))
        shade_family(slot);
      else
        shade_lobes(slot);
      if (slot.product_count > 0 && !slot.is_general)
        shade_products(slot);
    }
    if (!out_.is_any_seen && is_any_left_out)
      look_for_any();
  }

  /// Facets of some groups of which something is both lit and seen.
  UMOV_KERNEL void list_seen(View<const Chunk> chunks, SeenListOf<S> &out) {
    out.clear();
    for (const Chunk &chunk : chunks) {
      find_facing<false>(chunk);
      if (masks_ != nullptr)
        hide();
      for (std::size_t k = 0; k < count_; ++k)
        for (std::uint32_t j = 0; j < lanes; ++j)
          if (area_[k][j] > 0)
            out.push({group_[k], j, chunk.slot, static_cast<S>(area_[k][j]), 0});
    }
  }

  /// All facets that face both directions, with the area of each that is looked up as free and how
  /// uncertain it is. One pseudo-disagreement stands for slivers that no point has found: what is
  /// looked up as wholly free or wholly hidden may still be a little of the other.
  UMOV_KERNEL void list_facing(SeenListOf<S> &out) {
    out.clear();
    std::uint32_t facing[backend::groups_per_chunk];
    T whole[backend::groups_per_chunk][lanes];
    for (const Chunk &chunk : scene_.chunks) {
      find_facing<false>(chunk);
      const std::size_t all = count_;
      for (std::size_t k = 0; k < all; ++k) {
        facing[k] = group_[k];
        for (std::size_t j = 0; j < lanes; ++j)
          whole[k][j] = area_[k][j];
      }
      for (std::size_t k = 0; k < all; ++k)
        list_group(facing[k], whole[k], chunk.slot, out);
    }
  }

private:
  /// Directions in lanes, loaded once for a loop.
  struct Directions {
    R lx, ly, lz, vx, vy, vz;
    UMOV_KERNEL explicit Directions(const FacetPose<T> &p)
        : lx(R(p.sun[0])), ly(R(p.sun[1])), lz(R(p.sun[2])), vx(R(p.observer[0])),
          vy(R(p.observer[1])), vz(R(p.observer[2])) {}
  };
  struct Cosines {
    R n_l, n_v;
  };
  UMOV_KERNEL static Cosines cosines(const Directions &d, const FacetGroup<T> &f, std::size_t s,
                                     R &x, R &y, R &z) {
    x = Machine::load(f.nx + s);
    y = Machine::load(f.ny + s);
    z = Machine::load(f.nz + s);
    return {x * d.lx + y * d.ly + z * d.lz, x * d.vx + y * d.vy + z * d.vz};
  }

  /// 1 - n.h of the farthest facets that any lobe of a slot without other light has light from.
  [[nodiscard]] UMOV_KERNEL T reach_of(const SlotTerms &slot) const {
    if (slot.is_general || slot.product_count > 0)
      return T(4);
    T reach = 0;
    for (std::uint32_t k = 0; k < slot.lobe_count; ++k)
      reach = max(reach, pose_.lobes[slot.lobe_first + k].reach);
    return reach;
  }

  /// A facet that is lit and seen, beyond the reach of its lobe, is dark but not hidden.
  UMOV_KERNEL void look_for_any() {
    for (const Chunk &chunk : scene_.chunks) {
      find_facing<false>(chunk);
      if (masks_ != nullptr)
        hide();
      if (count_ > 0) {
        out_.is_any_seen = true;
        return;
      }
    }
  }

  /// Lists the groups some of which face both directions, with the area that does, if wanted only
  /// of facets within reach of the half vector. Without a branch: whether the next group is among
  /// them is as good as random.
  template <bool is_near_only> UMOV_KERNEL void find_facing(const Chunk &chunk, T reach = 0) {
    const Directions d(pose_.facet);
    const FacetGroup<T> *const groups = scene_.groups.data() + chunk.first;
    const std::uint32_t first = chunk.first, all = chunk.count;
    std::size_t count = 0;
    for (std::uint32_t g = 0; g < all; ++g) {
      const FacetGroup<T> &f = groups[g];
      bool is_any = false;
      for (std::size_t s = 0; s < lanes; s += width) {
        R x, y, z;
        const Cosines at = cosines(d, f, s, x, y, z);
        auto faces = min(at.n_l, at.n_v) > R(T(0));
        if constexpr (is_near_only)
          faces = faces & (apart_from_half(pose_.facet, x, y, z) < R(reach));
        is_any = Machine::any(faces) | is_any;
        Machine::store(select(faces, Machine::load(f.area + s), R(T(0))), area_[count] + s);
      }
      group_[count] = first + g;
      count += is_any ? 1 : 0;
    }
    for (std::size_t k = 0; k < count; ++k)
      is_exact_[k] = true;
    count_ = count;
  }

  /// Multiplies the areas by what is both lit and seen; groups of which nothing is are dropped.
  UMOV_KERNEL void hide() {
    const std::size_t facing = count_;
    count_ = 0;
    for (std::size_t k = 0; k < facing; ++k) {
      const GroupMask &mask = masks_->groups[group_[k]];
      if (k != count_) {
        for (std::size_t s = 0; s < lanes; s += width)
          Machine::store(Machine::load(area_[k] + s), area_[count_] + s);
        group_[count_] = group_[k];
        is_exact_[count_] = true;
      }
      if (mask.is_large ? hide_large(mask) : hide_small(mask))
        ++count_;
    }
  }

  UMOV_KERNEL static S square(S x) { return x * x; }

  UMOV_KERNEL void list_group(std::uint32_t group, const T *whole, std::uint32_t slot,
                              SeenListOf<S> &out) {
    const GroupMask &mask = masks_->groups[group];
    count_ = 0;
    group_[0] = group;
    for (std::size_t j = 0; j < lanes; ++j)
      area_[0][j] = whole[j];
    is_exact_[0] = true;
    const bool is_any = mask.is_large ? hide_large(mask) : hide_small(mask);
    const S points = S(32) * S(mask.words), unsure = S(1) / points * (S(1) - S(1) / points);
    const S pseudo = static_cast<S>(model_.points) * unsure / (points * sqrt(points));
    for (std::uint32_t j = 0; j < lanes; ++j)
      if (whole[j] > 0)
        out.push({group, j, slot, is_any ? static_cast<S>(area_[0][j]) : S(0),
                  (is_any && !is_exact_[0] ? square(static_cast<S>(deviation_[0][j])) : S(0)) +
                      square(static_cast<S>(whole[j])) * pseudo});
  }

  /// Makes room for a deviation where there was none.
  UMOV_KERNEL void clear_deviation() {
    for (std::size_t s = 0; is_exact_[count_] && s < lanes; s += width)
      Machine::store(R(T(0)), deviation_[count_] + s);
    is_exact_[count_] = false;
  }

  /// Many classes with few points each. Where all directions around one are free, three counts tell
  /// what nine would. False if nothing of them is left.
  UMOV_KERNEL bool hide_small(const GroupMask &mask) {
    const EntryLook sun = look_up(*masks_, masks_->small, pose_.small_sun, mask.entry);
    const EntryLook seen = look_up(*masks_, masks_->small, pose_.small_observer, mask.entry);
    if (sun.is_hidden || seen.is_hidden)
      return false;
    if (sun.is_free && seen.is_free)
      return true;
    clear_deviation();
    const T points = T(32) * T(mask.words);
    bool is_any = false;
    for (std::size_t s = 0; s < lanes; s += width) {
      R mean, mean_square;
      if (seen.is_free)
        Machine::template count_lanes<3, 1>(sun, seen, mask.words, s, pose_.small_sun.weight, mean,
                                            mean_square);
      else if (sun.is_free)
        Machine::template count_lanes<1, 3>(sun, seen, mask.words, s, pose_.small_observer.weight,
                                            mean, mean_square);
      else
        Machine::template count_lanes<3, 3>(sun, seen, mask.words, s, small_weight_, mean,
                                            mean_square);
      is_any =
          apply(s, mean * R(T(1) / points), mean_square * R(T(1) / (points * points)), points) ||
          is_any;
    }
    return is_any;
  }

  /// Multiplies areas by their visible shares, of nine whose mean square is given.
  UMOV_KERNEL bool apply(std::size_t s, R share, R mean_square, T points) {
    const R area = Machine::load(area_[count_] + s);
    const R visible = area * share;
    const R sampling =
        share * max(R(T(1)) - share, R(T(0))) * R(T(model_.points) / (points * sqrt(points)));
    const R grid = max(mean_square - share * share, R(T(0))) * R(T(model_.grid));
    Machine::store(visible, area_[count_] + s);
    Machine::store(area * sqrt(sampling + grid), deviation_[count_] + s);
    return Machine::any(visible > R(T(0)));
  }

  /// Few classes with many points each.
  UMOV_KERNEL bool hide_large(const GroupMask &mask) {
    bool is_any = false;
    const T points = T(32) * T(mask.words);
    for (std::size_t j = 0; j < lanes; ++j) {
      T &area = area_[count_][j];
      if (!(area > 0))
        continue;
      const auto entry = static_cast<std::uint32_t>(mask.entry + j);
      const EntryLook sun = look_up(*masks_, masks_->large, pose_.large_sun, entry);
      const EntryLook seen = look_up(*masks_, masks_->large, pose_.large_observer, entry);
      if (sun.is_hidden || seen.is_hidden) {
        area = 0;
        continue;
      }
      is_any = true;
      if (sun.is_free && seen.is_free)
        continue;
      clear_deviation();
      float count[9];
      Machine::count_long(sun, seen, mask.words, count);
      T share = 0, mean_square = 0;
      for (std::size_t k = 0; k < 9; ++k) {
        const T f = T(count[k]) / points, w = T(large_weight_[k]);
        share += w * f;
        mean_square += w * f * f;
      }
      const T sampling =
          share * max(T(1) - share, T(0)) * T(model_.points) / (points * sqrt(points));
      deviation_[count_][j] =
          area * sqrt(sampling + max(mean_square - share * share, T(0)) * T(model_.grid));
      area *= share;
    }
    return is_any;
  }

  UMOV_KERNEL void shade_lobes(const SlotTerms &slot) {
    for (std::uint32_t k = slot.lobe_first; k < slot.lobe_first + slot.lobe_count; ++k)
      shade_lobe(k);
  }

  [[nodiscard]] UMOV_KERNEL bool is_closed_family(const SlotTerms &slot) const {
    bool is_closed = slot.family != backend::no_family && scene_.cluster_error.empty();
    for (std::uint32_t k = 0; is_closed && k < slot.lobe_count; ++k)
      is_closed = !pose_.lobes[slot.lobe_first + k].uses_chords;
    return is_closed;
  }

  UMOV_KERNEL void shade_family(const SlotTerms &slot) {
    const backend::LobeFamily<T> &family = scene_.families[slot.family];
    const Directions d(pose_.facet);
    R sum[backend::family_lobes_max], variance[backend::family_lobes_max],
        linear[backend::family_lobes_max];
    for (std::size_t b = 0; b < slot.lobe_count; ++b)
      sum[b] = variance[b] = linear[b] = R(T(0));
    for (std::size_t k = 0; k < count_; ++k)
      for (std::size_t s = 0; s < lanes; s += width) {
        R x, y, z;
        const Cosines at = cosines(d, scene_.groups[group_[k]], s, x, y, z);
        const R n_l = max(at.n_l, R(T(0))), n_v = max(at.n_v, R(T(0)));
        const FromHalf<R> from = from_half(pose_.facet, x, y, z, n_l, n_v);
        R g[backend::family_nodes_max];
        for (std::size_t n = 0; n < family.node_count; ++n)
          g[n] = lobe_shadowing(family.node[n], pose_.facet, n_l, n_v);
        const R log2_cosine = log2_of_one_minus(from.apart);
        const R area = Machine::load(area_[k] + s);
        const R deviation = is_exact_[k] ? R(T(0)) : Machine::load(deviation_[k] + s);
        for (std::size_t b = 0; b < slot.lobe_count; ++b) {
          const T *weight = family.weight[b];
          R shadowing = g[0] * R(weight[0]);
          for (std::size_t n = 1; n < family.node_count; ++n)
            shadowing = shadowing + g[n] * R(weight[n]);
          const std::size_t lobe = slot.lobe_first + b;
          const R w =
              blinn_phong_over_disk(scene_.lobes[lobe], pose_.lobes[lobe], from, log2_cosine) *
              shadowing;
          const R error = deviation * w;
          sum[b] = sum[b] + area * w;
          variance[b] = variance[b] + error * error;
          linear[b] = linear[b] + error;
        }
      }
    for (std::size_t b = 0; b < slot.lobe_count; ++b) {
      out_.specular[slot.lobe_first + b] += Machine::total(sum[b]);
      out_.specular_variance[slot.lobe_first + b] += Machine::total(variance[b]);
      out_.specular_linear[slot.lobe_first + b] += Machine::total(linear[b]);
    }
  }

  UMOV_KERNEL void shade_lobe(std::size_t lobe) {
    const Directions d(pose_.facet);
    R sum = R(T(0)), variance = R(T(0)), linear = R(T(0)), bias = R(T(0));
    const bool is_clustered = !scene_.cluster_error.empty();
    for (std::size_t k = 0; k < count_; ++k)
      for (std::size_t s = 0; s < lanes; s += width) {
        R x, y, z;
        const Cosines at = cosines(d, scene_.groups[group_[k]], s, x, y, z);
        const R n_l = max(at.n_l, R(T(0))), n_v = max(at.n_v, R(T(0)));
        const R density = lobe_density(scene_.lobes[lobe], pose_.lobes[lobe], pose_.facet,
                                       from_half(pose_.facet, x, y, z, n_l, n_v));
        if (!Machine::any(density > R(T(0))))
          continue; // far from a narrow lobe
        const R w =
            density * lobe_shadowing(scene_.lobes[lobe], pose_.facet, n_l, n_v) * R(T(0.25));
        sum = sum + Machine::load(area_[k] + s) * w;
        if (!is_exact_[k]) {
          const R error = Machine::load(deviation_[k] + s) * w;
          variance = variance + error * error;
          linear = linear + error;
        }
        if (is_clustered)
          bias = bias + Machine::load(area_[k] + s) * w * cluster_error(lobe, k, s, x, y, z);
      }
    out_.specular_bias[lobe] += Machine::total(bias);
    out_.specular[lobe] += Machine::total(sum);
    out_.specular_variance[lobe] += Machine::total(variance);
    out_.specular_linear[lobe] += Machine::total(linear);
  }

  /// Relative error of the lobe from unlike normals in a class: m spread^2 / 2 at the peak, more on
  /// its flanks as (n - h)^2 m. Neighbours err to the same side, so the errors add up.
  UMOV_KERNEL R cluster_error(std::size_t lobe, std::size_t k, std::size_t s, R x, R y, R z) const {
    const auto &h = pose_.facet.half;
    const R dx = x - R(h[0]), dy = y - R(h[1]), dz = z - R(h[2]);
    return Machine::load(scene_.cluster_error[group_[k]].value + s) *
           (R(T(1)) + (dx * dx + dy * dy + dz * dz) * R(scene_.lobes[lobe].per_width2));
  }

  /// The number of products is known to the compiler where it is small: sums stay in registers.
  UMOV_KERNEL void shade_products(const SlotTerms &slot) {
    switch (slot.product_count) {
    case 1:
      return shade_products_of<1>(slot);
    case 2:
      return shade_products_of<2>(slot);
    case 3:
      return shade_products_of<3>(slot);
    case 4:
      return shade_products_of<4>(slot);
    default:
      return shade_products_of<0>(slot);
    }
  }

  /// `known` products; 0: as many as the slot has.
  template <std::size_t known> UMOV_KERNEL void shade_products_of(const SlotTerms &slot) {
    const std::size_t count = known > 0 ? known : slot.product_count;
    constexpr std::size_t room = known > 0 ? known : backend::products_max;
    const Directions d(pose_.facet);
    R sum[room], variance[room], linear[room];
    for (std::size_t p = 0; p < count; ++p)
      sum[p] = variance[p] = linear[p] = R(T(0));
    for (std::size_t k = 0; k < count_; ++k)
      for (std::size_t s = 0; s < lanes; s += width) {
        R x, y, z;
        const Cosines at = cosines(d, scene_.groups[group_[k]], s, x, y, z);
        const R n_l = max(at.n_l, R(T(0))), n_v = max(at.n_v, R(T(0)));
        ProfileValues<R> values = profile_values<R, T>(scene_, slot, n_l, n_v);
        if (slot.is_polarized)
          values.turn = emission_turn(pose_.facet, x, y, z, n_l, n_v);
        const R area = Machine::load(area_[k] + s);
        const R deviation = is_exact_[k] ? R(T(0)) : Machine::load(deviation_[k] + s);
        for (std::size_t p = 0; p < count; ++p) {
          const R w = values.template product<T>(scene_.products[slot.product_first + p]);
          const R error = deviation * w;
          sum[p] = sum[p] + area * w;
          variance[p] = variance[p] + error * error;
          linear[p] = linear[p] + abs(error);
        }
      }
    for (std::size_t p = 0; p < count; ++p) {
      out_.product[slot.product_first + p] += Machine::total(sum[p]);
      out_.product_variance[slot.product_first + p] += Machine::total(variance[p]);
      out_.product_linear[slot.product_first + p] += Machine::total(linear[p]);
    }
  }

  UMOV_KERNEL void hand_back(std::uint32_t slot) {
    for (std::size_t k = 0; k < count_; ++k)
      for (std::uint32_t j = 0; j < lanes; ++j)
        if (area_[k][j] > 0)
          out_.seen.push({group_[k], j, slot, static_cast<S>(area_[k][j]),
                          is_exact_[k] ? 0 : square(static_cast<S>(deviation_[k][j]))});
  }

  const SceneData<T> &scene_;
  const Masks *masks_;
  const MaskErrorModel &model_;
  const PoseData<T> &pose_;
  PoseSumsOf<S> &out_;
  float small_weight_[9]{}, large_weight_[9]{};
  std::size_t count_ = 0; ///< groups of the chunk that are lit and seen
  std::uint32_t group_[backend::groups_per_chunk];
  bool is_exact_[backend::groups_per_chunk]; ///< no deviation: nothing of it is partly hidden
  alignas(64) T area_[backend::groups_per_chunk][lanes];
  alignas(64) T deviation_[backend::groups_per_chunk][lanes]; ///< of the area
};

#include "kernel/end.h"
#endif
