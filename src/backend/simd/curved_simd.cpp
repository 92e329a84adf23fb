// The sums of scenes with curved classes for each instruction set. In a file of their own: beside
// them the loops of all other scenes would be taken apart into calls, a tenth of their rate.

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "backend/simd/curved_simd.cpp"
#include "backend/simd/curved_simd.h"

#include <bit>
#include <hwy/foreach_target.h>
// foreach_target comes first: it includes this file once for each instruction set.
#include "backend/simd/machine.inl.h"

#include "kernel/begin.h"

void sum_curved_here(const SceneData<float> &scene, const Masks *masks, const MaskErrorModel &model,
                     const PoseData<float> &pose, backend::PoseSums &out) {
  FacetLoops<SimdMachine>(scene, masks, model, pose, out).run();
}

#include "kernel/end.h"

#if HWY_ONCE

namespace umov::kernel {
HWY_EXPORT(sum_curved_here);
} // namespace umov::kernel

namespace umov::backend {

void sum_curved_facets(const SceneData<float> &scene, const Masks *masks,
                       const MaskErrorModel &model, const PoseData<float> &pose, PoseSums &out) {
  using namespace kernel;
  HWY_DYNAMIC_DISPATCH(sum_curved_here)(scene, masks, model, pose, out);
}

} // namespace umov::backend
#endif
