// Lanes of doubles as a number: what kernels take for R (Highway, Apache-2.0). Every operation is
// the IEEE one and none is fused, so that lanes give the bits of scalar double.
#if defined(UMOV_ORBIT_DOUBLE_LANES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef UMOV_ORBIT_DOUBLE_LANES_INL_H
#undef UMOV_ORBIT_DOUBLE_LANES_INL_H
#else
#define UMOV_ORBIT_DOUBLE_LANES_INL_H
#endif

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace umov::kernel::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using DoubleTag = hn::CappedTag<double, 8>;

struct DoubleMask {
  hn::Mask<DoubleTag> m;
  friend HWY_INLINE DoubleMask operator&(DoubleMask a, DoubleMask b) { return {hn::And(a.m, b.m)}; }
  friend HWY_INLINE DoubleMask operator|(DoubleMask a, DoubleMask b) { return {hn::Or(a.m, b.m)}; }
};

struct DoubleLanes {
  hn::Vec<DoubleTag> v;
  DoubleLanes() = default;
  HWY_INLINE explicit DoubleLanes(double x) : v(hn::Set(DoubleTag(), x)) {}
  HWY_INLINE explicit DoubleLanes(int x) : DoubleLanes(static_cast<double>(x)) {}
  HWY_INLINE DoubleLanes(hn::Vec<DoubleTag> x) : v(x) {}

  friend HWY_INLINE DoubleLanes operator+(DoubleLanes a, DoubleLanes b) {
    return hn::Add(a.v, b.v);
  }
  friend HWY_INLINE DoubleLanes operator-(DoubleLanes a, DoubleLanes b) {
    return hn::Sub(a.v, b.v);
  }
  friend HWY_INLINE DoubleLanes operator*(DoubleLanes a, DoubleLanes b) {
    return hn::Mul(a.v, b.v);
  }
  friend HWY_INLINE DoubleLanes operator/(DoubleLanes a, DoubleLanes b) {
    return hn::Div(a.v, b.v);
  }
  friend HWY_INLINE DoubleLanes operator-(DoubleLanes a) { return hn::Neg(a.v); }
  friend HWY_INLINE DoubleMask operator>(DoubleLanes a, DoubleLanes b) {
    return {hn::Gt(a.v, b.v)};
  }
  friend HWY_INLINE DoubleMask operator<(DoubleLanes a, DoubleLanes b) {
    return {hn::Lt(a.v, b.v)};
  }
  friend HWY_INLINE DoubleMask operator>=(DoubleLanes a, DoubleLanes b) {
    return {hn::Ge(a.v, b.v)};
  }
  friend HWY_INLINE DoubleMask operator<=(DoubleLanes a, DoubleLanes b) {
    return {hn::Le(a.v, b.v)};
  }
};

HWY_INLINE DoubleLanes select(DoubleMask m, DoubleLanes yes, DoubleLanes no) {
  return hn::IfThenElse(m.m, yes.v, no.v);
}
HWY_INLINE bool any(DoubleMask m) { return !hn::AllFalse(DoubleTag(), m.m); }
// As std::min and std::max do it with numbers that are not: the first one stays.
HWY_INLINE DoubleLanes min(DoubleLanes a, DoubleLanes b) { return select(b < a, b, a); }
HWY_INLINE DoubleLanes max(DoubleLanes a, DoubleLanes b) { return select(a < b, b, a); }
HWY_INLINE DoubleLanes abs(DoubleLanes a) { return hn::Abs(a.v); }
HWY_INLINE DoubleLanes sqrt(DoubleLanes a) { return hn::Sqrt(a.v); }

} // namespace umov::kernel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
