#pragma once
// What a card does with a batch of poses, one thread for each: it makes the pose ready and adds up
// its facets. The same text on the card and on the host.

#include "backend/cuda/thread_machine.h"
#include "backend/pose_constants.h"

namespace umov::backend {

/// A scene and its masks in the memory of a card.
struct CardScene {
  SceneData<float> scene;
  View<const kernel::LobeConstants<double>> lobes; ///< what poses are made ready from
  Masks masks;
  bool has_masks = false, has_polarized_body = false;
  MaskErrorModel error;
};

/// Poses and room for what becomes of them, [pose * number + index].
struct CardBatch {
  View<const PoseDirections> poses;
  PoseData<float> *ready = nullptr;
  kernel::LobeAtPose<float> *lobes = nullptr;
  RunningSum *sums = nullptr; ///< as `CardColumns` says
  std::uint8_t *is_any_seen = nullptr;
};

/// Where the sums of a pose stand: four columns of lobes, three of products.
struct CardColumns {
  std::size_t lobes = 0, products = 0;
  [[nodiscard]] UMOV_KERNEL std::size_t size() const { return 4 * lobes + 3 * products; }
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
}

/// Sums over all facets of a pose that is ready.
UMOV_KERNEL void sum_on_card(const CardScene &card, const CardBatch &batch, std::size_t pose) {
  const CardColumns columns = columns_of(card);
  RunningSum *const first = batch.sums + pose * columns.size();
  for (std::size_t k = 0; k < columns.size(); ++k)
    first[k] = RunningSum();
  PoseSumsOf<RunningSum> sums = columns.sums_at(first);
  kernel::FacetLoops<ThreadMachine>(card.scene, card.has_masks ? &card.masks : nullptr, card.error,
                                    batch.ready[pose], sums)
      .run();
  batch.is_any_seen[pose] = sums.is_any_seen ? 1 : 0;
}

} // namespace umov::backend
