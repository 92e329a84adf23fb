// The lists of weighed facets for each instruction set. In a file of their own: beside them the
// compiler takes the sums apart into calls, which costs a tenth of their rate.

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "backend/simd/lists_simd.cpp"
#include <bit>
#include <hwy/foreach_target.h>
// foreach_target comes first: it includes this file once for each instruction set.
#include "backend/simd/machine.inl.h"

#include "kernel/begin.h"

void list_weighed_here(const SceneData<float> &scene, const Masks *masks,
                       const MaskErrorModel &model, const PoseData<float> &pose,
                       backend::WeighedList &out) {
  backend::PoseSums unused;
  FacetLoops<SimdMachine>(scene, masks, model, pose, unused).list_weighed(out);
}

#include "kernel/end.h"

#if HWY_ONCE

namespace umov::kernel {
HWY_EXPORT(list_weighed_here);
} // namespace umov::kernel

namespace umov::backend {

void list_weighed(const SceneData<float> &scene, const Masks *masks, const MaskErrorModel &model,
                  const PoseData<float> &pose, WeighedList &out) {
  using namespace kernel;
  HWY_DYNAMIC_DISPATCH(list_weighed_here)(scene, masks, model, pose, out);
}

} // namespace umov::backend
#endif
