// The loops over facets: what those that are lit and seen add up to. The same text for every
// instruction set; what differs is in the Machine, which stands above its inclusion.
#if defined(UMOV_BACKEND_FACET_LOOPS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef UMOV_BACKEND_FACET_LOOPS_INL_H
#undef UMOV_BACKEND_FACET_LOOPS_INL_H
#else
#define UMOV_BACKEND_FACET_LOOPS_INL_H
#endif

#include "backend/curved_classes.inl.h"
#include "backend/lit_facets.inl.h"
#include "kernel/body.inl.h"

#include <type_traits>

#include "kernel/begin.h"

using backend::Chunk;
using backend::MaskErrorModel;
using backend::Masks;
using backend::PoseData;
using backend::PoseSumsOf;
using backend::ProductKind;
using backend::SceneData;
using backend::SeenListOf;
using backend::SlotTerms;
using backend::View;

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

/// Sums of one pose. `Machine` is that of LitFacets, with what sums are held in, S, and how to take
/// a total. `has_curved`: some slot may have SlotTerms::patch_spread; loops without are those of
/// most scenes, and a pose of theirs shall not pay for the others.
template <class Machine, bool has_curved = true> class FacetLoops {
  using R = typename Machine::R;
  using T = typename Machine::T;
  using S = typename Machine::S;
  static constexpr std::size_t width = Machine::width;

public:
  UMOV_KERNEL FacetLoops(const SceneData<T> &scene, const Masks *masks, const MaskErrorModel &model,
                         const PoseData<T> &pose, PoseSumsOf<S> &out)
      : scene_(scene), masks_(masks), model_(model), pose_(pose), out_(out),
        lit_(scene, masks, model, pose), curved_(scene, pose) {}

  UMOV_KERNEL void run() {
    bool is_any_left_out = false;
    for (const Chunk &chunk : scene_.chunks) {
      const SlotTerms &slot = scene_.slots[chunk.slot];
      const GatherTask<T> task = task_of(slot);
      is_any_left_out = is_any_left_out || task.reach < T(2);
      lit_.gather(chunk, task);
      if (lit_.count() == 0)
        continue;
      out_.is_any_seen = out_.is_any_seen || lit_.is_any_seen();
      if (slot.is_general)
        hand_back(chunk.slot);
      else
        shade(slot);
    }
    if (!out_.is_any_seen && is_any_left_out)
      look_for_any();
  }

  /// Facets of some groups of which something is both lit and seen.
  UMOV_KERNEL void list_seen(View<const Chunk> chunks, SeenListOf<S> &out) {
    out.clear();
    GatherTask<T> task;
    task.has_ids = true;
    for (const Chunk &chunk : chunks) {
      lit_.gather(chunk, task);
      for (std::size_t k = 0; k < lit_.count(); ++k)
        out.push({lit_.group(k), lit_.lane(k), chunk.slot, static_cast<S>(lit_.area_of(k)), 0});
    }
  }

  /// Facets that have light, with the area of each that is looked up as free, how uncertain that
  /// is, and what it weighs in the sums.
  UMOV_KERNEL void list_weighed(backend::WeighedListOf<S> &out) {
    out.facets.clear();
    for (const Chunk &chunk : scene_.chunks) {
      const SlotTerms &slot = scene_.slots[chunk.slot];
      GatherTask<T> task = task_of(slot);
      task.has_ids = true;
      lit_.gather(chunk, task);
      const std::size_t first = out.facets.size();
      for (std::size_t k = 0; k < lit_.count(); ++k)
        out.facets.push({lit_.group(k), lit_.lane(k), chunk.slot, static_cast<S>(lit_.area_of(k)),
                         square(static_cast<S>(lit_.deviation_of(k)))});
      if (lit_.count() == 0 || slot.is_general)
        continue;
      weigh(slot, first, out);
      if (is_curved(slot))
        weigh_curved(slot, first, out);
    }
  }

private:
  UMOV_KERNEL static S square(S x) { return x * x; }
  [[nodiscard]] UMOV_KERNEL static bool is_curved(const SlotTerms &slot) {
    return has_curved && slot.patch_spread > 0;
  }

  [[nodiscard]] UMOV_KERNEL GatherTask<T> task_of(const SlotTerms &slot) const {
    GatherTask<T> task;
    task.reach = reach_of(slot);
    task.has_aside = slot.is_polarized;
    task.has_ids = slot.is_general || is_curved(slot);
    task.has_doubts = model_.has_doubts && masks_ != nullptr;
    return task;
  }

  /// 1 - n.h of the farthest facets that any lobe of a slot without other light has light from.
  [[nodiscard]] UMOV_KERNEL T reach_of(const SlotTerms &slot) const {
    if (slot.is_general || slot.product_count > 0)
      return T(4);
    T reach = 0;
    for (std::uint32_t k = 0; k < slot.lobe_count; ++k)
      reach = max(reach, pose_.lobes[slot.lobe_first + k].reach);
    if (is_curved(slot)) { // of some of its normals
      const T chord = sqrt(T(2) * reach) + T(slot.patch_spread);
      reach = chord * chord / T(2);
    }
    return reach;
  }

  /// A facet that is lit and seen, beyond the reach of its lobe, is dark but not hidden.
  UMOV_KERNEL void look_for_any() {
    for (const Chunk &chunk : scene_.chunks) {
      lit_.gather(chunk, {});
      if (lit_.count() > 0) {
        out_.is_any_seen = true;
        return;
      }
    }
  }

  UMOV_KERNEL void shade(const SlotTerms &slot) {
    if (is_curved(slot))
      shade_curved(slot);
    else if (is_closed_family(slot))
      shade_family(slot);
    else
      for (std::uint32_t k = slot.lobe_first; k < slot.lobe_first + slot.lobe_count; ++k)
        shade_lobe<false>(k);
    if (slot.product_count > 0)
      shade_products(slot);
  }

  /// Apart: it is rare, and what is often would pay for it with registers.
  UMOV_KERNEL_LOOP UMOV_KERNEL void shade_curved(const SlotTerms &slot) {
    for (std::uint32_t k = slot.lobe_first; k < slot.lobe_first + slot.lobe_count; ++k) {
      curved_.weigh(k, slot, lit_);
      shade_lobe<true>(k);
    }
  }

  [[nodiscard]] UMOV_KERNEL bool is_closed_family(const SlotTerms &slot) const {
    bool is_closed = slot.family != backend::no_family && scene_.cluster_error.empty();
    for (std::uint32_t k = 0; is_closed && k < slot.lobe_count; ++k)
      is_closed = !pose_.lobes[slot.lobe_first + k].uses_chords;
    return is_closed;
  }

  UMOV_KERNEL void shade_family(const SlotTerms &slot) {
    const backend::LobeFamily<T> &family = scene_.families[slot.family];
    R sum[backend::family_lobes_max], variance[backend::family_lobes_max],
        linear[backend::family_lobes_max];
    for (std::size_t b = 0; b < slot.lobe_count; ++b)
      sum[b] = variance[b] = linear[b] = R(T(0));
    const bool varies = lit_.varies();
    for (std::size_t k = 0; k < lit_.count(); k += width) {
      const R n_l = lit_.n_l(k), n_v = lit_.n_v(k);
      const FromHalf<R> from = from_half(pose_.facet, lit_.apart(k), n_l, n_v);
      R g[backend::family_nodes_max];
      for (std::size_t n = 0; n < family.node_count; ++n)
        g[n] = lobe_shadowing(family.node[n], pose_.facet, n_l, n_v);
      const R log2_cosine = log2_of_one_minus(from.apart);
      const R area = lit_.area(k), deviation = varies ? lit_.deviation(k) : R(T(0));
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
    for (std::size_t b = 0; b < slot.lobe_count; ++b)
      add_lobe(slot.lobe_first + b, sum[b], variance[b], linear[b]);
  }

  /// `is_curved`: some classes have weights of their own.
  template <bool is_curved> UMOV_KERNEL void shade_lobe(std::size_t lobe) {
    R sum = R(T(0)), variance = R(T(0)), linear = R(T(0)), bias = R(T(0));
    const bool is_clustered = !scene_.cluster_error.empty(), varies = lit_.varies();
    const R reach = R(pose_.lobes[lobe].reach);
    for (std::size_t k = 0; k < lit_.count(); k += width) {
      const R n_l = lit_.n_l(k), n_v = lit_.n_v(k), apart = lit_.apart(k);
      if (!Machine::any(apart < reach) && !(is_curved && curved_.has_any(k)))
        continue; // asked before the density is known: what follows does not wait for the answer
      const R density = lobe_density(scene_.lobes[lobe], pose_.lobes[lobe], pose_.facet,
                                     from_half(pose_.facet, apart, n_l, n_v));
      R w = density * lobe_shadowing(scene_.lobes[lobe], pose_.facet, n_l, n_v) * R(T(0.25));
      if constexpr (is_curved)
        w = curved_.in_place_of(w, k);
      const R light = lit_.area(k) * w;
      sum = sum + light;
      if (varies) {
        const R error = lit_.deviation(k) * w;
        variance = variance + error * error;
        linear = linear + error;
      }
      if (is_clustered)
        bias = bias + light * cluster_error(lobe, k, apart);
    }
    if (is_clustered)
      out_.specular_bias[lobe] += Machine::total(bias);
    add_lobe(lobe, sum, variance, linear);
  }

  /// Weights of what was gathered, which `out` holds from `first` on.
  UMOV_KERNEL void weigh(const SlotTerms &slot, std::size_t first,
                         backend::WeighedListOf<S> &out) const {
    S *const to = out.weights.data() + first * out.terms;
    alignas(64) T w[width];
    const auto put = [&](std::size_t k, std::size_t term, R weight) {
      Machine::store_any(weight, w);
      for (std::size_t j = 0; j < width && k + j < lit_.count(); ++j)
        to[(k + j) * out.terms + term] = static_cast<S>(w[j]);
    };
    for (std::size_t k = 0; k < lit_.count(); k += width) {
      const R n_l = lit_.n_l(k), n_v = lit_.n_v(k), apart = lit_.apart(k);
      for (std::size_t l = 0; l < slot.lobe_count; ++l) {
        const std::size_t lobe = slot.lobe_first + l;
        put(k, l, lobe_weight(scene_.lobes[lobe], pose_.lobes[lobe], pose_.facet, apart, n_l, n_v));
      }
      if (slot.product_count == 0)
        continue;
      ProfileValues<R> values = profile_values<R, T>(scene_, slot, n_l, n_v);
      if (slot.is_polarized)
        values.turn = emission_turn(pose_.facet, lit_.aside(k), n_l, n_v);
      for (std::size_t p = 0; p < slot.product_count; ++p)
        put(k, slot.lobe_count + p,
            values.template product<T>(scene_.products[slot.product_first + p]));
    }
  }

  /// The same of classes that have weights of their own.
  UMOV_KERNEL_LOOP UMOV_KERNEL void weigh_curved(const SlotTerms &slot, std::size_t first,
                                                 backend::WeighedListOf<S> &out) {
    S *const to = out.weights.data() + first * out.terms;
    for (std::size_t l = 0; l < slot.lobe_count; ++l) {
      curved_.weigh(slot.lobe_first + l, slot, lit_);
      for (std::size_t k = 0; k < lit_.count(); ++k)
        if (curved_.has_one(k))
          to[k * out.terms + l] = static_cast<S>(curved_.one(k));
    }
  }

  UMOV_KERNEL void add_lobe(std::size_t lobe, R sum, R variance, R linear) {
    out_.specular[lobe] += Machine::total(sum);
    if (!lit_.varies())
      return;
    out_.specular_variance[lobe] += Machine::total(variance);
    out_.specular_linear[lobe] += Machine::total(linear);
  }

  /// Relative error of the lobe from unlike normals in a class: m spread^2 / 2 at the peak, more on
  /// its flanks as (n - h)^2 m. Neighbours err to the same side, so the errors add up.
  UMOV_KERNEL R cluster_error(std::size_t lobe, std::size_t k, R apart) const {
    return lit_.cluster_error(k) *
           (R(T(1)) + apart * R(T(2) * scene_.lobes[lobe].per_width2)); // |n - h|^2 = 2 apart
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
    R sum[room], variance[room], linear[room];
    for (std::size_t p = 0; p < count; ++p)
      sum[p] = variance[p] = linear[p] = R(T(0));
    const bool varies = lit_.varies();
    for (std::size_t k = 0; k < lit_.count(); k += width) {
      const R n_l = lit_.n_l(k), n_v = lit_.n_v(k);
      ProfileValues<R> values = profile_values<R, T>(scene_, slot, n_l, n_v);
      if (slot.is_polarized)
        values.turn = emission_turn(pose_.facet, lit_.aside(k), n_l, n_v);
      const R area = lit_.area(k), deviation = varies ? lit_.deviation(k) : R(T(0));
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
      if (!varies)
        continue;
      out_.product_variance[slot.product_first + p] += Machine::total(variance[p]);
      out_.product_linear[slot.product_first + p] += Machine::total(linear[p]);
    }
  }

  UMOV_KERNEL void hand_back(std::uint32_t slot) {
    for (std::size_t k = 0; k < lit_.count(); ++k)
      out_.seen.push({lit_.group(k), lit_.lane(k), slot, static_cast<S>(lit_.area_of(k)),
                      square(static_cast<S>(lit_.deviation_of(k)))});
  }

  const SceneData<T> &scene_;
  const Masks *masks_;
  const MaskErrorModel &model_;
  const PoseData<T> &pose_;
  PoseSumsOf<S> &out_;
  LitFacets<Machine> lit_;
  std::conditional_t<has_curved, CurvedClasses<Machine>, NoCurvedClasses<Machine>> curved_;
};

#include "kernel/end.h"
#endif
