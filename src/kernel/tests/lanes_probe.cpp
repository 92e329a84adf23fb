#include "kernel/tests/lanes_probe.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernel/tests/lanes_probe.cpp"
#include <hwy/foreach_target.h>
// foreach_target comes first: it includes this file once for each instruction set.
#include "backend/simd/lanes.inl.h"

#include "kernel/tests/probes.inl.h"

#include "kernel/begin.h"

void lane_values_here(std::size_t family, float x, std::vector<double> &out) {
  bool is_same = true;
  probe<Lanes, float>(family, Lanes(x), [&](Lanes value) {
    const FloatTag d;
    const float first = hn::GetLane(value.v);
    is_same = is_same && hn::AllTrue(d, hn::Eq(value.v, hn::Set(d, first)));
    out.push_back(static_cast<double>(first));
  });
  if (!is_same)
    out.clear();
}

#include "kernel/end.h"

#if HWY_ONCE
#include <hwy/targets.h>

namespace umov::kernel {
HWY_EXPORT(lane_values_here);
} // namespace umov::kernel

namespace umov::test {

std::vector<double> lane_values(std::size_t family, float x) {
  using namespace kernel; // the table of HWY_EXPORT stands there
  std::vector<double> out;
  HWY_DYNAMIC_DISPATCH(lane_values_here)(family, x, out);
  return out;
}

void for_each_instruction_set(void (*body)(const char *name, void *data), void *data) {
  hwy::SetSupportedTargetsForTest(0);
  const std::int64_t all = hwy::SupportedTargets() & HWY_TARGETS;
  for (std::int64_t rest = all; rest != 0; rest &= rest - 1) {
    hwy::SetSupportedTargetsForTest(rest & -rest);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    body(hwy::TargetName(rest & -rest), data);
  }
  hwy::SetSupportedTargetsForTest(0);
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
}

} // namespace umov::test
#endif
