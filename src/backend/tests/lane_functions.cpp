#include "backend/tests/lane_functions.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "backend/tests/lane_functions.cpp"
#include <hwy/foreach_target.h>
// foreach_target comes first: it includes this file once for each instruction set.
#include "backend/simd/lanes.inl.h"

#include "kernel/begin.h"

Lanes call(test::LaneFunction function, Lanes x) {
  switch (function) {
  case test::LaneFunction::Exp2:
    return exp2(x);
  case test::LaneFunction::Exp:
    return exp(x);
  case test::LaneFunction::Log2OfOneMinus:
    return log2_of_one_minus(x);
  case test::LaneFunction::Log:
    return log(x);
  case test::LaneFunction::Acos:
    return acos(x);
  case test::LaneFunction::InverseSqrt:
    return inverse_sqrt(x);
  case test::LaneFunction::Sqrt:
    return sqrt(x);
  case test::LaneFunction::Reciprocal:
    return Lanes(1.0f) / x;
  case test::LaneFunction::Sin:
    return sin(x);
  case test::LaneFunction::Cos:
    return cos(x);
  case test::LaneFunction::Atan:
    return atan(x);
  case test::LaneFunction::Erfc:
    break;
  }
  return erfc(x);
}

/// `count` is a multiple of 16.
void apply_here(test::LaneFunction function, const float *x, std::size_t count, float *out) {
  const FloatTag d;
  for (std::size_t i = 0; i < count; i += hn::Lanes(d))
    hn::StoreU(call(function, Lanes(hn::LoadU(d, x + i))).v, d, out + i);
}

#include "kernel/end.h"

#if HWY_ONCE
namespace umov::kernel {
HWY_EXPORT(apply_here);
} // namespace umov::kernel

namespace umov::test {

std::vector<float> apply(LaneFunction function, const std::vector<float> &x) {
  using namespace kernel; // the table of HWY_EXPORT stands there
  std::vector<float> in = x, out;
  in.resize((x.size() + 15) / 16 * 16, 1.0f);
  out.resize(in.size());
  HWY_DYNAMIC_DISPATCH(apply_here)(function, in.data(), in.size(), out.data());
  out.resize(x.size());
  return out;
}

} // namespace umov::test
#endif
