#pragma once
// Sums of a pose where some slot has curved classes (SlotTerms::patch_spread): as sum_facets.

#include "backend/scene_data.h"

namespace umov::backend {

void sum_curved_facets(const SceneData<float> &scene, const Masks *masks,
                       const MaskErrorModel &model, const PoseData<float> &pose, PoseSums &out);

} // namespace umov::backend
