// Lanes of a vector unit as a number: what kernels take for R (Highway, Apache-2.0).
#if defined(UMOV_BACKEND_LANES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef UMOV_BACKEND_LANES_INL_H
#undef UMOV_BACKEND_LANES_INL_H
#else
#define UMOV_BACKEND_LANES_INL_H
#endif

#include <hwy/highway.h>
// After Highway: the kernels then take the namespace of the instruction set.
#include "kernel/angles.inl.h"

HWY_BEFORE_NAMESPACE();
namespace umov::kernel::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// As many floats as a register has, at most 16.
using FloatTag = hn::CappedTag<float, 16>;
using IntTag = hn::RebindToSigned<FloatTag>;
using WordTag = hn::RebindToUnsigned<FloatTag>;

struct LaneMask {
  hn::Mask<FloatTag> m;
  friend HWY_INLINE LaneMask operator&(LaneMask a, LaneMask b) { return {hn::And(a.m, b.m)}; }
  friend HWY_INLINE LaneMask operator!(LaneMask a) { return {hn::Not(a.m)}; }
  friend HWY_INLINE LaneMask operator|(LaneMask a, LaneMask b) { return {hn::Or(a.m, b.m)}; }
};

struct Lanes {
  hn::Vec<FloatTag> v;
  Lanes() = default;
  HWY_INLINE explicit Lanes(float x) : v(hn::Set(FloatTag(), x)) {}
  HWY_INLINE explicit Lanes(double x) : Lanes(static_cast<float>(x)) {}
  HWY_INLINE explicit Lanes(int x) : Lanes(static_cast<float>(x)) {}
  HWY_INLINE Lanes(hn::Vec<FloatTag> x) : v(x) {}

  friend HWY_INLINE Lanes operator+(Lanes a, Lanes b) { return hn::Add(a.v, b.v); }
  friend HWY_INLINE Lanes operator-(Lanes a, Lanes b) { return hn::Sub(a.v, b.v); }
  friend HWY_INLINE Lanes operator*(Lanes a, Lanes b) { return hn::Mul(a.v, b.v); }
  /// a/b to 2e-7 for b between 1e-37 and 1e37: divisions proper would take most of the time.
  friend HWY_INLINE Lanes operator/(Lanes a, Lanes b) {
    const auto r = hn::ApproximateReciprocal(b.v);
    const auto two = hn::Set(FloatTag(), 2.0f);
    return hn::Mul(a.v, hn::Mul(r, hn::NegMulAdd(b.v, r, two)));
  }
  friend HWY_INLINE Lanes operator-(Lanes a) { return hn::Neg(a.v); }
  friend HWY_INLINE LaneMask operator>(Lanes a, Lanes b) { return {hn::Gt(a.v, b.v)}; }
  friend HWY_INLINE LaneMask operator<(Lanes a, Lanes b) { return {hn::Lt(a.v, b.v)}; }
  friend HWY_INLINE LaneMask operator>=(Lanes a, Lanes b) { return {hn::Ge(a.v, b.v)}; }
  friend HWY_INLINE LaneMask operator<=(Lanes a, Lanes b) { return {hn::Le(a.v, b.v)}; }
  friend HWY_INLINE LaneMask operator==(Lanes a, Lanes b) { return {hn::Eq(a.v, b.v)}; }
};

HWY_INLINE Lanes product_and(Lanes a, Lanes b, Lanes c) { return hn::MulAdd(a.v, b.v, c.v); }
HWY_INLINE Lanes min(Lanes a, Lanes b) { return hn::Min(a.v, b.v); }
HWY_INLINE Lanes max(Lanes a, Lanes b) { return hn::Max(a.v, b.v); }
HWY_INLINE Lanes abs(Lanes a) { return hn::Abs(a.v); }
/// 1/sqrt(a) to 2e-7 for a above 1e-37: one step of Newton's on the processor's estimate.
HWY_INLINE Lanes inverse_sqrt(Lanes a) {
  const FloatTag d;
#if HWY_TARGET == HWY_SCALAR || HWY_TARGET == HWY_EMU128
  return hn::Div(hn::Set(d, 1.0f), hn::Sqrt(a.v)); // an estimate without a processor is too rough
#else
  const auto r = hn::ApproximateReciprocalSqrt(a.v);
  const auto half = hn::Mul(hn::Mul(a.v, r), hn::Mul(r, hn::Set(d, -0.5f)));
  return hn::Mul(r, hn::Add(half, hn::Set(d, 1.5f)));
#endif
}
HWY_INLINE Lanes sqrt(Lanes a) { return a * inverse_sqrt(max(a, Lanes(1e-36f))); }
HWY_INLINE Lanes select(LaneMask m, Lanes yes, Lanes no) {
  return hn::IfThenElse(m.m, yes.v, no.v);
}
HWY_INLINE bool any(LaneMask m) { return !hn::AllFalse(FloatTag(), m.m); }

/// 2^x: relative error below 3e-7 for x in [-126, 127]; 0 below.
HWY_INLINE Lanes exp2(Lanes x) {
  const FloatTag d;
  const IntTag di;
  // At -127 the exponent's bits are 0, and so is the result.
  const auto clamped = hn::Min(hn::Max(x.v, hn::Set(d, -127.0f)), hn::Set(d, 127.0f));
  // Adding 3 2^22 rounds to a whole number, which then stands in the lowest bits.
  const auto magic = hn::Set(d, 12582912.0f);
  const auto shifted = hn::Add(clamped, magic);
  const auto f = hn::Sub(clamped, hn::Sub(shifted, magic));
  // Chebyshev fit of 2^f, |f| <= 1/2, in relative error.
  constexpr float c[6] = {1.00000012f,   0.693146944f,   0.240221217f,
                          0.0555074252f, 0.00967545994f, 0.00132669706f};
  auto p = hn::Set(d, c[5]);
  for (int k = 4; k >= 0; --k)
    p = hn::MulAdd(p, f, hn::Set(d, c[k]));
  const auto scale =
      hn::BitCast(d, hn::Add(hn::ShiftLeft<23>(hn::BitCast(di, shifted)), hn::Set(di, 127 << 23)));
  return hn::Mul(p, scale);
}
HWY_INLINE Lanes exp(Lanes x) { return exp2(x * Lanes(1.44269504f)); }

/// log2 x for x in [1e-37, 1e37]; `apart` is x - 1 where x is near 1, as exact as it is known.
HWY_INLINE Lanes log2_of(Lanes x, Lanes apart) {
  const FloatTag d;
  const IntTag di;
  // x = m 2^e with m in [sqrt(1/2), sqrt(2)).
  const auto shifted = hn::Sub(hn::BitCast(di, x.v), hn::Set(di, 0x3F3504F3));
  const auto e = hn::ShiftRight<23>(shifted);
  const auto m =
      hn::BitCast(d, hn::Add(hn::And(shifted, hn::Set(di, 0x007FFFFF)), hn::Set(di, 0x3F3504F3)));
  const auto is_near = hn::RebindMask(d, hn::Eq(e, hn::Zero(di)));
  const Lanes z = hn::IfThenElse(is_near, apart.v, hn::Sub(m, hn::Set(d, 1.0f)));
  const Lanes s = z / (Lanes(2.0f) + z), s2 = s * s;
  // 2 atanh(s) / ln 2, |s| <= 0.1716.
  Lanes p(2.0f / 9 * 1.44269504f);
  p = hn::MulAdd(p.v, s2.v, hn::Set(d, 2.0f / 7 * 1.44269504f));
  p = hn::MulAdd(p.v, s2.v, hn::Set(d, 2.0f / 5 * 1.44269504f));
  p = hn::MulAdd(p.v, s2.v, hn::Set(d, 2.0f / 3 * 1.44269504f));
  p = hn::MulAdd(p.v, s2.v, hn::Set(d, 2.0f * 1.44269504f));
  return hn::MulAdd(p.v, s.v, hn::ConvertTo(d, e));
}
/// log2(1 - y), y in [0, 1]: absolute error below 2e-7 + 2e-7 |log2(1 - y)|, also for tiny y: the
/// rounding of 1 - y would cost 6e-8 times the exponent. -99.7 at y = 1.
HWY_INLINE Lanes log2_of_one_minus(Lanes y) {
  return log2_of(max(Lanes(1.0f) - y, Lanes(1e-30f)), -y);
}
/// log x for x in [1e-37, 1e37]: absolute error below 2e-7 + 2e-7 |log x|.
HWY_INLINE Lanes log(Lanes x) { return log2_of(x, x - Lanes(1.0f)) * Lanes(0.693147181f); }

/// arc cosine [rad], absolute error below 7e-5 (Abramowitz & Stegun 1972, 4.4.45); for the
/// correlation of shadowing with direction, which it changes by less than 3e-4.
HWY_INLINE Lanes acos(Lanes x) {
  const Lanes a = min(abs(x), Lanes(1.0f));
  const Lanes p = ((Lanes(-0.0187293f) * a + Lanes(0.0742610f)) * a + Lanes(-0.2121144f)) * a +
                  Lanes(1.5707288f);
  const Lanes near = sqrt(Lanes(1.0f) - a) * p;
  return select(x < Lanes(0.0f), Lanes(3.14159265f) - near, near);
}

/// erfc x for |x| < 9: error below 4e-7 (1 + x^2) of the result.
HWY_INLINE Lanes erfc(Lanes x) {
  const Lanes a = abs(x), t = Lanes(1.0f) / (Lanes(1.0f) + Lanes(0.5f) * a);
  // exp(x^2) erfc(x) / t, t = 1/(1 + x/2), at the Chebyshev nodes of t: 3e-8.
  constexpr float c[11] = {0.510791353f,     0.343580313f,    0.139735946f,   0.0182217491f,
                           -0.0107533107f,   -0.00324373307f, 0.00153384704f, 0.000431040021f,
                           -0.000304719086f, -3.67643615e-5f, 4.42884144e-5f};
  const Lanes p = polynomial(c, 10, Lanes(2.0f) * t - Lanes(1.0f)) * t * exp(-a * a);
  return select(x < Lanes(0.0f), Lanes(2.0f) - p, p);
}

HWY_INLINE Lanes nearest(Lanes x) { return hn::Round(x.v); }
HWY_INLINE Lanes without_quarters(Lanes x, Lanes quarters) {
  return without_quarters_single(x, quarters);
}
/// Absolute errors below 2e-7 for |x| below 1e4.
HWY_INLINE Lanes sin(Lanes x) { return sine_cosine(x).sine; }
HWY_INLINE Lanes cos(Lanes x) { return sine_cosine(x).cosine; }
/// Absolute error below 4e-7 for |x| below 1e37.
HWY_INLINE Lanes atan(Lanes x) { return arc_tangent(x, Lanes(1.0f)); }

} // namespace umov::kernel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
