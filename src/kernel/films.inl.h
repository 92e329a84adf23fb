// Plane films: amplitudes of a coherent stack and the incoherent sum over a thick layer
// (Born & Wolf 1999, section 1.6). Field directions as in kernel/fresnel.inl.h.
#if defined(UMOV_KERNEL_FILMS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef UMOV_KERNEL_FILMS_INL_H
#undef UMOV_KERNEL_FILMS_INL_H
#else
#define UMOV_KERNEL_FILMS_INL_H
#endif

#include "kernel/angles.inl.h"
#include "kernel/fresnel.inl.h"

#include <cstddef>

#include "kernel/begin.h"

template <class R> UMOV_KERNEL Complex<R> add(Complex<R> a, Complex<R> b) {
  return {a.re + b.re, a.im + b.im};
}
template <class R> UMOV_KERNEL Complex<R> subtract(Complex<R> a, Complex<R> b) {
  return {a.re - b.re, a.im - b.im};
}
/// exp(i z).
template <class R> UMOV_KERNEL Complex<R> exponential_i(Complex<R> z) {
  const R size = exp(-z.im);
  return {size * cos(z.re), size * sin(z.re)};
}

template <class R> struct Film {
  Complex<R> eta;
  R thickness; ///< in wavelengths in vacuum
};

/// What a stack does to a wave from one side: amplitudes of the tangential fields (E for s, H for
/// p), and the factors that make |t|^2 a power where both outer media are transparent.
template <class R> struct StackAmplitudes {
  Amplitudes<R> r, t;
  R power_s, power_p; ///< transmitted power: power_s |t.s|^2
};

/// Admittances of both polarizations: q and q/eta^2.
template <class R> struct Admittance { Complex<R> s, p, q; };

template <class R> UMOV_KERNEL Admittance<R> admittance(Complex<R> eta, R sine_squared) {
  const Complex<R> square = multiply(eta, eta);
  const Complex<R> q = square_root(Complex<R>{square.re - sine_squared, square.im});
  return {q, divide(q, square), q};
}

/// (a - b)/(a + b), 0 where both vanish (equal media at grazing incidence).
template <class R> UMOV_KERNEL Complex<R> step_reflection(Complex<R> a, Complex<R> b) {
  const Complex<R> sum = add(a, b);
  const auto is_void = (sum.re == R(0)) & (sum.im == R(0));
  const R guard = select(is_void, R(1), R(0));
  const Complex<R> out = divide(subtract(a, b), Complex<R>{sum.re + guard, sum.im});
  return {select(is_void, R(0), out.re), select(is_void, R(0), out.im)};
}

/// One polarization, one more film above: r = (r_j + r e^{2i d})/(1 + r_j r e^{2i d}).
template <class R>
UMOV_KERNEL void add_film(Complex<R> r_j, Complex<R> phase, Complex<R> &r, Complex<R> &t) {
  const Complex<R> one{R(1), R(0)};
  const Complex<R> below = multiply(r, multiply(phase, phase));
  const Complex<R> ring = add(one, multiply(r_j, below));
  t = divide(multiply(add(one, r_j), multiply(t, phase)), ring);
  r = divide(add(r_j, below), ring);
}

/// Light from the medium `above` at (eta_above sin)^2 = sine_squared onto `count` films, the first
/// one on top, over the medium `below`. `sine_squared` may exceed what `above` allows: evanescent.
template <class R>
UMOV_KERNEL StackAmplitudes<R> stack(Complex<R> above, R sine_squared, const Film<R> *films,
                                     std::size_t count, Complex<R> below) {
  const R two_pi = R(6.283185307179586);
  Admittance<R> lower = admittance(below, sine_squared);
  const Admittance<R> last = lower;
  const Complex<R> one{R(1), R(0)}, none{R(0), R(0)};
  Complex<R> r_s = none, r_p = none, t_s = one, t_p = one, phase = one;
  for (std::size_t j = count + 1; j-- > 0;) { // film j - 1 lies above the step j
    const Admittance<R> upper =
        j > 0 ? admittance(films[j - 1].eta, sine_squared) : admittance(above, sine_squared);
    add_film(step_reflection(upper.s, lower.s), phase, r_s, t_s);
    add_film(step_reflection(upper.p, lower.p), phase, r_p, t_p);
    if (j > 0) {
      const R depth = two_pi * films[j - 1].thickness;
      phase = exponential_i(Complex<R>{upper.q.re * depth, upper.q.im * depth});
    }
    lower = upper;
  }
  const R top_s = max(lower.s.re, R(1e-30)), top_p = max(lower.p.re, R(1e-30));
  return {{r_s, r_p}, {t_s, t_p}, last.s.re / top_s, last.p.re / top_p};
}

/// Powers of both polarizations and the cross term conj(s) p between them: all that unpolarized
/// phases leave of the amplitudes.
template <class R> struct Powers {
  R s, p;
  Complex<R> z;
};

template <class R>
UMOV_KERNEL Powers<R> powers(Amplitudes<R> a, R factor_s = R(1), R factor_p = R(1)) {
  const R s = a.s.re * a.s.re + a.s.im * a.s.im, p = a.p.re * a.p.re + a.p.im * a.p.im;
  const Complex<R> z = multiply(Complex<R>{a.s.re, -a.s.im}, a.p);
  const R both = sqrt(max(R(0), factor_s * factor_p));
  return {factor_s * s, factor_p * p, {both * z.re, both * z.im}};
}

/// A thick layer: light enters through a surface (reflection `top`, transmissions `down` and `up`,
/// reflection `inside` from below), crosses it with the internal transmittance `tau` per pass and
/// is reflected by what lies beneath. Sum over all passes without interference: R = R_top + T_down
/// T_up tau^2 R_b/(1 - R_in R_b tau^2), the cross terms alike.
template <class R>
UMOV_KERNEL Powers<R> thick_layer(Powers<R> top, Powers<R> down, Powers<R> up, Powers<R> inside,
                                  R tau, Powers<R> beneath) {
  const R t2 = tau * tau;
  const Complex<R> one{R(1), R(0)};
  const auto loop = multiply(inside.z, beneath.z);
  const auto through = multiply(multiply(down.z, up.z), beneath.z);
  return {top.s + down.s * up.s * t2 * beneath.s / (R(1) - inside.s * beneath.s * t2),
          top.p + down.p * up.p * t2 * beneath.p / (R(1) - inside.p * beneath.p * t2),
          add(top.z, divide(Complex<R>{through.re * t2, through.im * t2},
                            subtract(one, Complex<R>{loop.re * t2, loop.im * t2})))};
}

/// The distinct entries of the reflection Mueller matrix from powers.
template <class R> UMOV_KERNEL Reflection<R> reflection(Powers<R> r) {
  return {(r.s + r.p) / R(2), (r.s - r.p) / R(2), r.z};
}

#include "kernel/end.h"
#endif
