// Fresnel reflection of a smooth interface with a complex index (Born & Wolf 1999, section 1.5),
// with the field directions of docs/conventions.md: (s, p, k) right-handed in both beams, so that
// r_s = -r_p at normal incidence.
#if defined(UMOV_KERNEL_FRESNEL_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef UMOV_KERNEL_FRESNEL_INL_H
#undef UMOV_KERNEL_FRESNEL_INL_H
#else
#define UMOV_KERNEL_FRESNEL_INL_H
#endif

#include "kernel/math.inl.h"

#include "kernel/begin.h"

template <class R> struct Complex { R re, im; };

template <class R> UMOV_KERNEL Complex<R> multiply(Complex<R> a, Complex<R> b) {
  return {a.re * b.re - a.im * b.im, a.re * b.im + a.im * b.re};
}
template <class R> UMOV_KERNEL Complex<R> divide(Complex<R> a, Complex<R> b) {
  const R d = b.re * b.re + b.im * b.im;
  return {(a.re * b.re + a.im * b.im) / d, (a.im * b.re - a.re * b.im) / d};
}

/// Principal square root of z with Im z >= 0 (so Im of the root is >= 0). The larger part comes
/// from the sum and the other by division: no cancellation, and the root of c^2 is exactly c.
template <class R> UMOV_KERNEL Complex<R> square_root(Complex<R> z) {
  const R modulus = sqrt(z.re * z.re + z.im * z.im);
  const R large = sqrt((modulus + abs(z.re)) / R(2));
  const R small = select(large > R(0), z.im / (R(2) * max(large, R(1e-30))), R(0));
  return {select(z.re >= R(0), large, small), select(z.re >= R(0), small, large)};
}

template <class R> struct Amplitudes { Complex<R> s, p; };

/// r_s and r_p at an incidence whose cosine is c in [0, 1], from vacuum onto eta = n + ik with
/// n > 0, k >= 0. Exactly 0 for eta = 1; -1 and -1 at grazing incidence (c = 0) on any other eta.
template <class R> UMOV_KERNEL Amplitudes<R> fresnel(R c, Complex<R> eta) {
  const Complex<R> square = multiply(eta, eta);
  const Complex<R> q = square_root(Complex<R>{square.re - R(1) + c * c, square.im});
  const Complex<R> scaled{square.re * c, square.im * c};
  // Without an interface nothing is reflected, at grazing incidence (0/0) too.
  const auto is_void = (eta.re == R(1)) & (eta.im == R(0));
  const R guard = select(is_void, R(1), R(0));
  const Complex<R> s = divide(Complex<R>{c - q.re, -q.im}, Complex<R>{c + q.re + guard, q.im});
  const Complex<R> p = divide(Complex<R>{scaled.re - q.re, scaled.im - q.im},
                              Complex<R>{scaled.re + q.re + guard, scaled.im + q.im});
  return {{select(is_void, R(0), s.re), select(is_void, R(0), s.im)},
          {select(is_void, R(0), p.re), select(is_void, R(0), p.im)}};
}

/// The four distinct entries of the reflection Mueller matrix: M00 = M11 = a, M01 = M10 = b,
/// M22 = M33 = z.re, M32 = -M23 = z.im, with z = conj(r_s) r_p.
template <class R> struct Reflection {
  R a, b;
  Complex<R> z;
};

template <class R> UMOV_KERNEL Reflection<R> reflection(Amplitudes<R> r) {
  const R s = r.s.re * r.s.re + r.s.im * r.s.im, p = r.p.re * r.p.re + r.p.im * r.p.im;
  return {(s + p) / R(2), (s - p) / R(2), multiply(Complex<R>{r.s.re, -r.s.im}, r.p)};
}

#include "kernel/end.h"
#endif
