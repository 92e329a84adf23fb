#pragma once
// What a card does with a batch of poses, one thread for each: it makes the pose ready, adds up its
// facets and colours the sums. The same text on the card and on the host.

#include "backend/colours.h"
#include "backend/cuda/thread_machine.h"
#include "backend/pose_constants.h"

namespace umov::backend {

/// What the materials of a scene make of sums; no bands: sums are all that is asked for.
struct CardColours {
  View<const SlotColour<float>> slots; ///< as SceneData::slots
  View<const LobeRounding<float>> rounding;
  ReflectionTable<float> reflection;
  std::uint32_t bands = 0;
};

/// A scene and its masks in the memory of a card.
struct CardScene {
  SceneData<float> scene;
  View<const kernel::LobeConstants<double>> lobes; ///< what poses are made ready from
  CardColours colours;
  Masks masks;
  bool has_masks = false, has_polarized_body = false;
  MaskErrorModel error;
};

/// How microfacets reflect in a pose.
struct PoseReflection {
  float incidence = 1; ///< cosine
  bool has_plane = false;
};

/// Poses and room for what becomes of them, [pose * number + index].
struct CardBatch {
  View<const PoseDirections> poses;
  PoseData<float> *ready = nullptr;
  kernel::LobeAtPose<float> *lobes = nullptr;
  RunningSum *sums = nullptr; ///< as `CardColumns` says
  std::uint8_t *is_any_seen = nullptr;
  bool goes_on = false; ///< sums hold those of the chunks before
  // Where light or abundances are asked for, not sums:
  PoseReflection *reflection = nullptr; ///< of light
  float *work = nullptr;                ///< as `CardColumns` says: abundances, and room for light
  float *light = nullptr;               ///< [column * bands + band], as `LightRow` has them
};

/// Columns of a pose's light per unit of area; V is 0 of everything that has a kernel.
enum LightRow : std::uint8_t { RowI, RowQ, RowU, RowIErr, RowQErr, RowUErr, RowVErr };
inline constexpr std::size_t light_columns = RowVErr + 1; ///< how many

/// Sums of a pose with what is not known of them: abundances.
template <class T> struct Weighed {
  T *specular, *specular_deviation, *specular_bias, *product, *product_deviation;
};

/// Where the sums of a pose stand: four columns of lobes, three of products.
struct CardColumns {
  std::size_t lobes = 0, products = 0;
  [[nodiscard]] UMOV_KERNEL std::size_t size() const { return 4 * lobes + 3 * products; }
  /// Columns of `Weighed`.
  [[nodiscard]] UMOV_KERNEL std::size_t weighed_size() const { return 3 * lobes + 2 * products; }
  /// The same with room to colour them in: reflections, deviations of a slot, light.
  [[nodiscard]] UMOV_KERNEL std::size_t work_size(std::size_t reflections,
                                                  std::size_t bands) const {
    return weighed_size() + 2 * reflections + (4 + 9) * bands;
  }
  template <class T> [[nodiscard]] UMOV_KERNEL Weighed<T> weighed_at(T *first) const {
    T *const product = first + 3 * lobes;
    return {first, first + lobes, first + 2 * lobes, product, product + products};
  }
  /// The columns from `first` on as the sums of a pose.
  template <class S> [[nodiscard]] UMOV_KERNEL PoseSumsOf<S> sums_at(S *first) const {
    PoseSumsOf<S> out;
    out.specular = {first, lobes};
    out.specular_variance = {first + lobes, lobes};
    out.specular_bias = {first + 2 * lobes, lobes};
    out.specular_linear = {first + 3 * lobes, lobes};
    S *const after = first + 4 * lobes;
    out.product = {after, products};
    out.product_variance = {after + products, products};
    out.product_linear = {after + 2 * products, products};
    return out;
  }
};

UMOV_KERNEL CardColumns columns_of(const CardScene &card) {
  return {card.scene.lobes.size(), card.scene.products.size()};
}

/// Directions, lobes and grids of one pose: differences of unit vectors, so in double.
UMOV_KERNEL void prepare_on_card(const CardScene &card, const CardBatch &batch, std::size_t pose) {
  const PoseDirections &of = batch.poses[pose];
  PoseData<float> &out = batch.ready[pose];
  out = {};
  kernel::FacetPose<double> facet;
  const kernel::DiskImage disk = put_directions(of, card.has_polarized_body, facet);
  round_directions(facet, out.facet);
  const std::size_t count = card.lobes.size();
  kernel::LobeAtPose<float> *const lobes = batch.lobes + pose * count;
  for (std::size_t k = 0; k < count; ++k) {
    kernel::LobeAtPose<double> lobe;
    kernel::put_lobe_at_pose(card.lobes[k], disk, lobe);
    kernel::round_lobe_at_pose(lobe, lobes[k]);
  }
  out.lobes = {lobes, count};
  if (card.has_masks)
    put_looks(of, card.masks, out);
  if (batch.reflection != nullptr)
    batch.reflection[pose] = {kernel::rounded(incidence_cosine(of.cos_phase)), of.has_plane};
}

/// Sums over all facets of a pose that is ready. `has_curved` as FacetLoops has it.
template <bool has_curved>
UMOV_KERNEL void sum_on_card(const CardScene &card, const CardBatch &batch, std::size_t pose) {
  const CardColumns columns = columns_of(card);
  RunningSum *const first = batch.sums + pose * columns.size();
  for (std::size_t k = 0; !batch.goes_on && k < columns.size(); ++k)
    first[k] = RunningSum();
  PoseSumsOf<RunningSum> sums = columns.sums_at(first);
  sums.is_any_seen = batch.goes_on && batch.is_any_seen[pose] != 0;
  kernel::FacetLoops<ThreadMachine, has_curved>(card.scene, card.has_masks ? &card.masks : nullptr,
                                                card.error, batch.ready[pose], sums)
      .run();
  batch.is_any_seen[pose] = sums.is_any_seen ? 1 : 0;
}

/// Takes pieces of a pose's room, one after the other.
class WorkRoom {
public:
  UMOV_KERNEL explicit WorkRoom(float *first) : next_(first) {}
  UMOV_KERNEL float *take(std::size_t size) {
    float *const out = next_;
    next_ += size;
    return out;
  }
  UMOV_KERNEL float *zeros(std::size_t size) {
    float *const out = take(size);
    for (std::size_t k = 0; k < size; ++k)
      out[k] = 0;
    return out;
  }

private:
  float *next_;
};

/// Sums with their standard deviations and biases, from what the facets gave.
UMOV_KERNEL void weigh(const CardScene &card, const PoseSumsOf<RunningSum> &sums,
                       const Weighed<float> &out) {
  using std::sqrt;
  const auto deviation = [&](RunningSum variance, RunningSum linear) {
    const float alike = linear.rounded();
    return card.has_masks
               ? sqrt(variance.rounded() + static_cast<float>(mask_alike) * alike * alike)
               : 0.0F;
  };
  for (std::size_t k = 0; k < sums.specular.size(); ++k) {
    const float sum = sums.specular[k].rounded();
    const LobeRounding<float> &of = card.colours.rounding[k];
    const float root = flank_root<float>(halvings(sum * of.per_peak));
    out.specular[k] = sum;
    out.specular_deviation[k] = deviation(sums.specular_variance[k], sums.specular_linear[k]);
    out.specular_bias[k] = sums.specular_bias[k].rounded() + rounding_of(sum, of, root);
  }
  for (std::size_t k = 0; k < sums.product.size(); ++k) {
    out.product[k] = sums.product[k].rounded();
    out.product_deviation[k] = deviation(sums.product_variance[k], sums.product_linear[k]);
  }
}

/// Abundances of a pose, into its room.
UMOV_KERNEL void weigh_on_card(const CardScene &card, const CardBatch &batch, std::size_t pose) {
  const CardColumns columns = columns_of(card);
  weigh(card, columns.sums_at(batch.sums + pose * columns.size()),
        columns.weighed_at(batch.work + pose * columns.weighed_size()));
}

/// Light in all bands, with half-widths, from the sums of a pose.
UMOV_KERNEL void colour_on_card(const CardScene &card, const CardBatch &batch, std::size_t pose) {
  const CardColumns columns = columns_of(card);
  const CardColours &colours = card.colours;
  const std::size_t n = colours.bands, reflections = colours.reflection.columns;
  WorkRoom room(batch.work + pose * columns.work_size(reflections, n));
  const Weighed<float> of = columns.weighed_at(room.take(columns.weighed_size()));
  weigh(card, columns.sums_at(batch.sums + pose * columns.size()), of);
  float *const a = room.take(reflections), *const b = room.take(reflections);
  reflect(colours.reflection, batch.reflection[pose].incidence, a, b);
  for (std::size_t k = 0; !batch.reflection[pose].has_plane && k < reflections; ++k)
    b[k] = 0;
  const ColourRoom<float> at{a, b, room.take(n), room.take(n), room.take(n), room.take(n)};
  const LightColumns<float> light{room.zeros(n), room.zeros(n), room.zeros(n),
                                  room.zeros(n), room.zeros(n), room.zeros(n),
                                  room.zeros(n), room.zeros(n), room.zeros(n)};
  for (std::size_t slot = 0; slot < colours.slots.size(); ++slot) {
    const SlotTerms &terms = card.scene.slots[slot];
    add_slot(colours.slots[slot],
             {of.specular + terms.lobe_first, of.specular_deviation + terms.lobe_first,
              of.specular_bias + terms.lobe_first, of.product + terms.product_first,
              of.product_deviation + terms.product_first, card.has_masks},
             at, light);
  }
  float *const row = batch.light + pose * light_columns * n;
  for (std::size_t k = 0; k < n; ++k) {
    const float i = light.i[k], bias = light.bias[k];
    row[RowI * n + k] = i;
    row[RowQ * n + k] = light.q[k];
    row[RowU * n + k] = light.u[k];
    row[RowIErr * n + k] = half_width(light.var_i[k], i, bias, 1.0F);
    row[RowQErr * n + k] = half_width(light.var_q[k], i, bias, 1.0F);
    row[RowUErr * n + k] = half_width(light.var_u[k], i, bias, 1.0F);
    row[RowVErr * n + k] = half_width(light.var_v[k], i, bias, 1.0F);
  }
}

} // namespace umov::backend
