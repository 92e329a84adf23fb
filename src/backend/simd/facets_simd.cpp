// The facet loops for each instruction set of the processor family, chosen when the program runs.

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "backend/simd/facets_simd.cpp"
#include "backend/simd/curved_simd.h"

#include <bit>
#include <hwy/foreach_target.h>
// foreach_target comes first: it includes this file once for each instruction set.
#include "backend/simd/machine.inl.h"

#include "kernel/begin.h"

void sum_facets_here(const SceneData<float> &scene, const Masks *masks, const MaskErrorModel &model,
                     const PoseData<float> &pose, backend::PoseSums &out) {
  FacetLoops<SimdMachine, false>(scene, masks, model, pose, out).run();
}

#include "kernel/end.h"

#if HWY_ONCE
#include <hwy/targets.h>

namespace umov::kernel {
HWY_EXPORT(sum_facets_here);
} // namespace umov::kernel

namespace umov::backend {

void sum_facets(const SceneData<float> &scene, const Masks *masks, const MaskErrorModel &model,
                const PoseData<float> &pose, backend::PoseSums &out) {
  if (!scene.patches_of.empty())
    return sum_curved_facets(scene, masks, model, pose, out);
  using namespace kernel; // the table of HWY_EXPORT stands there
  HWY_DYNAMIC_DISPATCH(sum_facets_here)(scene, masks, model, pose, out);
}

bool choose_instruction_set(InstructionSet set) {
  const auto of = [](InstructionSet which) -> std::int64_t {
    switch (which) {
    case InstructionSet::Baseline:
      return HWY_STATIC_TARGET;
    case InstructionSet::Sse4:
      return HWY_SSE4;
    case InstructionSet::Avx2:
      return HWY_AVX2;
    case InstructionSet::Avx512:
      return HWY_AVX3 | HWY_AVX3_DL;
    case InstructionSet::Best:
      break;
    }
    return 0;
  };
  hwy::SetSupportedTargetsForTest(0); // all that the machine has
  const std::int64_t wanted = of(set) & HWY_TARGETS & (hwy::SupportedTargets() | HWY_STATIC_TARGET);
  if (set != InstructionSet::Best && wanted == 0)
    return false;
  hwy::SetSupportedTargetsForTest(wanted);
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
  return true;
}

const char *instruction_set_name() {
  const std::int64_t targets = hwy::SupportedTargets() & HWY_TARGETS;
  return hwy::TargetName(targets & -targets); // the best one is the lowest bit
}

} // namespace umov::backend
#endif
