// What is compiled for the card at hand when it is first used: the entries, and behind them the
// very kernels that the processor runs.

#include "backend/cuda/card_poses.h"

// The host has laid out what it hands over with its own compiler.
static_assert(sizeof(umov::backend::CardScene) == UMOV_CARD_SCENE_BYTES);
static_assert(sizeof(umov::backend::CardBatch) == UMOV_CARD_BATCH_BYTES);
static_assert(sizeof(umov::backend::PoseData<float>) == UMOV_CARD_POSE_BYTES);
static_assert(sizeof(umov::kernel::LobeAtPose<float>) == UMOV_CARD_LOBE_BYTES);
static_assert(sizeof(umov::backend::SlotColour<float>) == UMOV_CARD_COLOUR_BYTES);

extern "C" __global__ void umov_prepare_poses(umov::backend::CardScene scene,
                                              umov::backend::CardBatch batch) {
  const unsigned i = blockIdx.x * blockDim.x + threadIdx.x;
  if (i < batch.poses.size())
    umov::backend::prepare_on_card(scene, batch, i);
}

extern "C" __global__ void umov_sum_poses(umov::backend::CardScene scene,
                                          umov::backend::CardBatch batch) {
  const unsigned i = blockIdx.x * blockDim.x + threadIdx.x;
  if (i < batch.poses.size())
    umov::backend::sum_on_card<false>(scene, batch, i);
}

// Apart from the other: lobes narrower than a curved part's elements need some twenty registers more.
extern "C" __global__ void umov_sum_curved_poses(umov::backend::CardScene scene,
                                                 umov::backend::CardBatch batch) {
  const unsigned i = blockIdx.x * blockDim.x + threadIdx.x;
  if (i < batch.poses.size())
    umov::backend::sum_on_card<true>(scene, batch, i);
}

extern "C" __global__ void umov_colour_poses(umov::backend::CardScene scene,
                                             umov::backend::CardBatch batch) {
  const unsigned i = blockIdx.x * blockDim.x + threadIdx.x;
  if (i < batch.poses.size())
    umov::backend::colour_on_card(scene, batch, i);
}

extern "C" __global__ void umov_weigh_poses(umov::backend::CardScene scene,
                                            umov::backend::CardBatch batch) {
  const unsigned i = blockIdx.x * blockDim.x + threadIdx.x;
  if (i < batch.poses.size())
    umov::backend::weigh_on_card(scene, batch, i);
}
