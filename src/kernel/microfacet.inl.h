// Microfacets: distribution of normals and the joint masking of two directions.
#if defined(UMOV_KERNEL_MICROFACET_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef UMOV_KERNEL_MICROFACET_INL_H
#undef UMOV_KERNEL_MICROFACET_INL_H
#else
#define UMOV_KERNEL_MICROFACET_INL_H
#endif

#include "kernel/math.inl.h"
#include <numbers>
#include <umov/kernel/lobe.h>

#include "kernel/begin.h"

/// Blinn-Phong D: facet area per macroscopic area and solid angle, (m+2)/(2 pi) (n.h)^m, normalised
/// with the projected area (Walter et al. 2007). n_h in [0, 1], m >= 0.
template <class R> UMOV_KERNEL R blinn_phong_peak(R m) {
  return (m + R(2)) / R(2 * std::numbers::pi);
}
template <class R> UMOV_KERNEL R blinn_phong(R n_h, R m) {
  return blinn_phong_peak(m) * power(n_h, m);
}

/// D over a spread of half vectors with variances kappa1, kappa2 along two axes, on which the
/// normal has the squared coordinates x2, y2: D is a Gaussian there, so the mean is one again,
/// scale D(h) exp(along x2 + across y2).
template <class R> struct Spread { R scale, along, across; };
template <class R> UMOV_KERNEL Spread<R> blinn_phong_spread(R m, R kappa1, R kappa2) {
  const R p = m * kappa1, q = m * kappa2;
  return {R(1) / sqrt((R(1) + p) * (R(1) + q)), m / R(2) * p / (R(1) + p),
          m / R(2) * q / (R(1) + q)};
}

/// Beckmann D = exp(-tan^2/a^2)/(pi a^2 cos^4) (Walter et al. 2007) from sin^2 and cos^2 > 0.
template <class R> UMOV_KERNEL R beckmann(R sine2, R cosine2, R alpha) {
  const R a2 = alpha * alpha;
  return exp(-sine2 / (cosine2 * a2)) / (R(std::numbers::pi) * a2 * cosine2 * cosine2);
}
template <class R> UMOV_KERNEL R beckmann(R n_h, R alpha) {
  const R c2 = max(n_h * n_h, R(1e-30));
  return beckmann(R(1) - c2, c2, alpha);
}

/// Smith's G1 of Beckmann: 1/(1 + L), L = (erf(a) - 1)/2 + exp(-a^2)/(2 a sqrt(pi)).
template <class R> UMOV_KERNEL R beckmann_masking(R n_k, R alpha) {
  const R sine = sqrt(max(R(0), (R(1) - n_k) * (R(1) + n_k)));
  const R a = n_k / max(alpha * sine, R(1e-30));
  const R root_pi = R(1.7724538509055160);
  const R lambda = exp(-a * a) / (R(2) * a * root_pi) - erfc(a) / R(2);
  return select(n_k > R(0), R(1) / (R(1) + max(R(0), lambda)), R(0));
}

/// 2 pi int of Beckmann's D sin(theta) from theta on, with z = 1/(a cos): int 2 z^2 exp(1/a^2 -
/// z^2) dz = exp(1/a^2) (z exp(-z^2) + sqrt(pi)/2 erfc(z)) a, written without the large factors.
template <class R> UMOV_KERNEL R beckmann_beyond(R cos_theta, R alpha) {
  const R c = max(cos_theta, R(1e-9));
  const R z = R(1) / (alpha * c);
  const R tail = exp(-(R(1) - c) * (R(1) + c) / (c * c * alpha * alpha));
  // exp(z^2) erfc(z) by its continued fraction for large z (Abramowitz & Stegun 7.1.14): 14 terms
  // err by 1e-15 at 5, less beyond.
  const R root_pi = R(1.7724538509055160);
  const R small = min(z, R(5)), large = max(z, R(5));
  R fraction = R(0);
  for (int k = 14; k >= 1; --k)
    fraction = R(k) / R(2) / (large + fraction);
  const R scaled =
      select(z < R(5), exp(small * small) * erfc(small), R(1) / (root_pi * (large + fraction)));
  return alpha * tail * (z + root_pi / R(2) * scaled);
}

/// GGX D = a^2/(pi (cos^2 (a^2 - 1) + 1)^2) (Walter et al. 2007) from sin^2 and cos^2, without the
/// cancellation for small a.
template <class R> UMOV_KERNEL R ggx(R sine2, R cosine2, R alpha) {
  const R a2 = alpha * alpha;
  const R f = sine2 + a2 * cosine2;
  return a2 / (R(std::numbers::pi) * f * f);
}
template <class R> UMOV_KERNEL R ggx(R n_h, R alpha) {
  return ggx((R(1) - n_h) * (R(1) + n_h), n_h * n_h, alpha);
}

/// Smith's G1 of GGX: 2/(1 + sqrt(1 + a^2 tan^2)).
template <class R> UMOV_KERNEL R ggx_masking(R n_k, R alpha) {
  const R s2 = (R(1) - n_k) * (R(1) + n_k);
  return R(2) * n_k / (n_k + sqrt(n_k * n_k + alpha * alpha * s2));
}

/// 2 pi int of GGX's D sin(theta) from theta on: int_0^c 2 a^2/(1 - (1 - a^2) x^2)^2 dx.
template <class R> UMOV_KERNEL R ggx_beyond(R cos_theta, R alpha) {
  const R a2 = alpha * alpha, b2 = R(1) - a2, c = cos_theta;
  const R f = (R(1) - c) * (R(1) + c) + a2 * c * c; // 1 - b2 c^2
  const R root = sqrt(abs(b2)), least = R(1e-4), b = max(root, least);
  const R angle =
      select(b2 > R(0), log((R(1) + b * c) * (R(1) + b * c) / f) / (R(2) * b), atan(b * c) / b);
  return a2 * (c / f + select(root > least, angle, c)); // c: the limit at b = 0
}

/// Ashikhmin & Shirley 2000 with the normalisation of D; x2, y2: squared components of h along and
/// across the direction field.
template <class R> UMOV_KERNEL R ashikhmin_shirley(R n_h, R x2, R y2, R nu, R nv) {
  const R across = x2 + y2;
  const R m = select(across > R(0), (nu * x2 + nv * y2) / max(across, R(1e-37)), nu);
  return sqrt((nu + R(2)) * (nv + R(2))) / R(2 * std::numbers::pi) * power(n_h, m);
}

/// Weights of Lagrange's cubic through four equal steps, at t steps past the second.
template <class R> struct CubicWeights { R w[4]; };
template <class R> UMOV_KERNEL CubicWeights<R> cubic_weights(R t) {
  const R a = t + R(1), b = t, c = t - R(1), d = t - R(2);
  return {{-b * c * d / R(6), a * c * d / R(2), -a * b * d / R(2), a * b * c / R(6)}};
}
/// The cubic through v[0..3].
template <class R> UMOV_KERNEL R cubic(const R *v, R t) {
  const auto c = cubic_weights(t);
  return c.w[0] * v[0] + c.w[1] * v[1] + c.w[2] * v[2] + c.w[3] * v[3];
}

/// <n.h> of the paper's density (Eq. 11): (m+1)/(m+2).
template <class R> UMOV_KERNEL R mean_cosine(R m) { return (m + R(1)) / (m + R(2)); }

/// Independent masking: P(l) P(v).
template <class R> UMOV_KERNEL R separable(R p_l, R p_v) { return p_l * p_v; }

/// Ashikhmin, Premoze & Shirley 2000, Eq. 14 of the paper: (1-t) P(l)P(v) + t min, t = cos(phi/2).
template <class R> UMOV_KERNEL R ashikhmin(R p_l, R p_v, R cos_phi) {
  const R t = sqrt(max(R(0), (R(1) + cos_phi) / R(2)));
  return (R(1) - t) * p_l * p_v + t * min(p_l, p_v);
}

/// Height-correlated Smith, 1/(1 + L_l + L_v) with L = 1/P - 1 (Ross et al. 2005; Heitz 2014,
/// section 6), written with P so that P = 0 gives 0.
template <class R> UMOV_KERNEL R smith(R p_l, R p_v) {
  const R sum = p_l + p_v - p_l * p_v;
  return select(sum > R(0), p_l * p_v / max(sum, R(1e-37)), R(0));
}

/// Height and direction correlated Smith, 1/(1 + max L + x min L), x = 4.41 phi/(4.41 phi + 1)
/// (van Ginneken et al. 1998; Heitz 2014). Both sides are multiplied by P(l)P(v).
template <class R> UMOV_KERNEL R smith_directional(R p_l, R p_v, R cos_phi) {
  const R phi = acos(clamped(cos_phi, R(-1), R(1)));
  const R x = R(4.41) * phi / (R(4.41) * phi + R(1));
  const R low = min(p_l, p_v), high = max(p_l, p_v);
  // 1 + (1/low - 1) + x (1/high - 1) = (high + x low (1 - high)) / (low high)
  const R sum = high + x * low * (R(1) - high);
  return select(sum > R(0), low * high / max(sum, R(1e-37)), R(0));
}

/// Cosine of the azimuth between the projections of two directions on the surface, 1 where one of
/// them is the normal (the masking of that direction is 1 there, so the value does not matter).
template <class R> UMOV_KERNEL R cos_azimuth(R n_l, R n_v, R l_v) {
  const R s = (R(1) - n_l * n_l) * (R(1) - n_v * n_v);
  const R tiny = R(1e-30);
  return select(s > tiny, clamped((l_v - n_l * n_v) * inverse_sqrt(max(s, tiny)), R(-1), R(1)),
                R(1));
}

/// G2 of both directions from the masking of each.
template <class R> UMOV_KERNEL R joint_masking(Shadowing joint, R p_l, R p_v, R n_l, R n_v, R l_v) {
  switch (joint) {
  case Shadowing::Ashikhmin:
    return ashikhmin(p_l, p_v, cos_azimuth(n_l, n_v, l_v));
  case Shadowing::Smith:
    return smith(p_l, p_v);
  case Shadowing::SmithDirectional:
    return smith_directional(p_l, p_v, cos_azimuth(n_l, n_v, l_v));
  case Shadowing::Separable:
    break;
  }
  return separable(p_l, p_v);
}

/// n.h from the three cosines; 0 where h is undefined (phase 180).
template <class R> UMOV_KERNEL R half_cosine(R n_l, R n_v, R l_v) {
  const R s = R(2) + R(2) * l_v;
  const R tiny = R(1e-30);
  return select(s > tiny, clamped((n_l + n_v) / sqrt(max(s, tiny)), R(0), R(1)), R(0));
}

#include "kernel/end.h"
#endif
