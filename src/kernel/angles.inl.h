// Angles for every lane type: sine and cosine, whole turns taken off, arc tangent. Our own
// polynomials and no fused operations, so that each lane type gives the same bits.
#if defined(UMOV_KERNEL_ANGLES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef UMOV_KERNEL_ANGLES_INL_H
#undef UMOV_KERNEL_ANGLES_INL_H
#else
#define UMOV_KERNEL_ANGLES_INL_H
#endif

#include "kernel/math.inl.h"

#include "kernel/begin.h"

/// The nearest whole number; |x| below 2^51 (float: 2^22). Adding 3 2^51 leaves no bit for a
/// fraction.
template <class R> UMOV_KERNEL R nearest(R x) {
  const R magic = R(6755399441055744.0);
  return (x + magic) - magic;
}
UMOV_KERNEL float nearest(float x) {
  const float magic = 12582912.0F;
  return (x + magic) - magic;
}

/// x less whole multiples of pi/2, |x| below 1e6: the constant in three parts of 33 bits, so that
/// the products are exact (Cody & Waite 1980).
template <class R> UMOV_KERNEL R without_quarters(R x, R quarters) {
  const R first = R(1.57079632673412561417e+00), second = R(6.07710050630396597660e-11),
          third = R(2.02226624879595063154e-21);
  return ((x - quarters * first) - quarters * second) - quarters * third;
}
/// The same in single precision, |x| below 1e4: parts of 11 bits.
template <class R> UMOV_KERNEL R without_quarters_single(R x, R quarters) {
  const R first = R(1.5703125), second = R(4.837512969970703125e-4),
          third = R(7.549789948768648e-8);
  return ((x - quarters * first) - quarters * second) - quarters * third;
}
UMOV_KERNEL float without_quarters(float x, float quarters) {
  return without_quarters_single(x, quarters);
}

/// x in (-pi, pi], up to rounding: whole turns taken off.
template <class R> UMOV_KERNEL R within_turn(R x) {
  return without_quarters(x, R(4) * nearest(x * R(0.15915494309189533577)));
}

/// x in (-2 pi, 2 pi) with the sign of x, up to rounding: what fmod leaves.
template <class R> UMOV_KERNEL R rest_of_turn(R x) {
  const R turns = x * R(0.15915494309189533577);
  const R half = select(turns < R(0), R(0.5), R(-0.5));
  return without_quarters(x, R(4) * nearest(turns + half));
}

template <class R> struct SineCosine { R sine, cosine; };

/// Absolute error below 2e-16 for |x| below 1e6 (float: 2e-7 below 1e4). Polynomials: minimax fits
/// of (sin r - r)/r^3 and (cos r - 1 + r^2/2)/r^4 in r^2, |r| <= pi/4.
template <class R> UMOV_KERNEL SineCosine<R> sine_cosine(R x) {
  const R quarters = nearest(x * R(0.63661977236758134308));
  const R r = without_quarters(x, quarters), r2 = r * r;
  R p = R(1.5918101230274120348e-10);
  p = p * r2 + R(-2.5051131455427947391e-8);
  p = p * r2 + R(2.755731610068302914e-6);
  p = p * r2 + R(-0.00019841269836754970014);
  p = p * r2 + R(0.0083333333333309461029);
  p = p * r2 + R(-0.16666666666666664621);
  const R s = r + (r * r2) * p;
  R q = R(-1.1382614868556324576e-11);
  q = q * r2 + R(2.0876146024689746601e-9);
  q = q * r2 + R(-2.7557317270560324065e-7);
  q = q * r2 + R(0.000024801587298763433164);
  q = q * r2 + R(-0.0013888888888887395746);
  q = q * r2 + R(0.041666666666666665387);
  const R c = (R(1) - R(0.5) * r2) + (r2 * r2) * q;
  // Odd quarters exchange the two; the half turn changes both signs.
  const R halves = nearest(R(0.5) * quarters - R(0.25));
  const R odd = quarters - R(2) * halves;
  const R turn = R(1) - R(2) * (halves - R(2) * nearest(R(0.5) * halves - R(0.25)));
  const auto is_odd = odd > R(0.5);
  return {turn * select(is_odd, c, s), turn * select(is_odd, -s, c)};
}

// Double has the C library's, which is right to the last bit; in float that of graphics processors
// takes double for the turns of large angles.
UMOV_KERNEL double sin(double x) { return std::sin(x); }
UMOV_KERNEL double cos(double x) { return std::cos(x); }
UMOV_KERNEL float sin(float x) { return sine_cosine(x).sine; }
UMOV_KERNEL float cos(float x) { return sine_cosine(x).cosine; }

/// The angle of (x, y) from the x axis, in [-pi, pi]; 0 for the origin and within 1e-37 of
/// it. Absolute error below 5e-16 (float: 4e-7).
/// Polynomial: minimax fit of (atan t - t)/t^3 in t^2, |t| <= tan(pi/8).
template <class R> UMOV_KERNEL R arc_tangent(R y, R x) {
  const R ax = abs(x), ay = abs(y);
  const R big = max(ax, ay), small = min(ax, ay);
  const R t0 = small / max(big, R(1e-37));
  const auto is_steep = t0 > R(0.41421356237309503);
  const R t = select(is_steep, (t0 - R(1)) / (t0 + R(1)), t0), t2 = t * t;
  R p = R(-0.019170700393742989118);
  p = p * t2 + R(0.039226605510871358014);
  p = p * t2 + R(-0.050852748016420942097);
  p = p * t2 + R(0.058581154762998843993);
  p = p * t2 + R(-0.066645075975616747087);
  p = p * t2 + R(0.076921829174611611241);
  p = p * t2 + R(-0.090909045663543985597);
  p = p * t2 + R(0.11111111014966641024);
  p = p * t2 + R(-0.14285714284662940169);
  p = p * t2 + R(0.19999999999995503405);
  p = p * t2 + R(-0.33333333333333330146);
  const R quarter_pi = R(0.78539816339744830962);
  R angle = t + (t * t2) * p;
  angle = select(is_steep, quarter_pi + angle, angle);
  angle = select(ay > ax, R(2) * quarter_pi - angle, angle);
  angle = select(x < R(0), R(4) * quarter_pi - angle, angle);
  return select(y < R(0), -angle, angle);
}

#include "kernel/end.h"
#endif
