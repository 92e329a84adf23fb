#pragma once
// Colour and polarization, applied to the sums of a pose, and its half-widths: the same text in
// double on the processor and in single precision on cards (docs/theory/engine.md).

#include "backend/scene_data.h"
#include "kernel/microfacet.inl.h"

#include <cmath>

namespace umov::backend {

inline constexpr double normal_95 = 1.959963984540054; ///< two-sided quantile of the normal law
/// Rounding of the sums, in parts of I: docs/theory/engine.md has the measured agreement.
inline constexpr double sums_rounding = 2e-6;
/// Part of the square of all standard deviations together that stands for what neighbouring classes
/// have in common: the same shadow's edge crosses many.
inline constexpr double mask_alike = 4e-3F;

/// Columns of a pose's light over the bands, per unit of area; var_* are squared standard
/// deviations, `bias` a bound of what is known to be left out of I.
template <class T> struct LightColumns { T *i, *q, *u, *v, *var_i, *var_q, *var_u, *var_v, *bias; };

/// Sums of a slot over the facets, with their standard deviations.
template <class T> struct SlotSums {
  const T *specular, *specular_deviation, *specular_bias;
  const T *product, *product_deviation;
  bool varies = true; ///< some deviation is not 0
};

/// What the material of a slot makes of its sums, for `bands` bands.
template <class T> struct SlotColour {
  std::uint32_t bands = 0, column = 0, product_count = 0; ///< column: first of its reflections
  bool has_lobe = false, has_single_bounce = false, has_emission = false;
  bool is_plain = false;          ///< one lobe for all bands and at most one product
  bool is_intensity_only = false; ///< Q is left 0
  View<const std::uint32_t> lobe; ///< per band
  View<const T> single_bounce;    ///< [product * bands + band], as those below
  View<const T> whole;            ///< with what is unpolarized
  View<const T> q, u;             ///< of emission
  T diffuse_error = 0;
};

/// Reflection of all microfacets at one phase angle, by column, and room to work in: of one slot
/// M10/M00, and deviations of I, Q, U.
template <class T> struct ColourRoom {
  const T *a, *b; ///< M00, M10
  T *ratio, *dev_i, *dev_q, *dev_u;
};

/// Reflection against the cosine of incidence, in even steps from 0 to 1.
template <class T> struct ReflectionTable {
  View<const T> values; ///< [row][a of all columns, b of all columns]
  std::uint32_t columns = 0, steps = 1;
};

/// Of the microfacets that reflect at this phase angle.
UMOV_KERNEL double incidence_cosine(double cos_phase) {
  const double square = 0.5 * (1 + cos_phase);
  return std::sqrt(square < 0 ? 0 : square > 1 ? 1 : square);
}

/// M00 and M10 of all columns.
template <class T> UMOV_KERNEL void reflect(const ReflectionTable<T> &table, T cosine, T *a, T *b) {
  const T x = cosine * static_cast<T>(table.steps);
  std::size_t first = static_cast<std::size_t>(x);
  first = (first < 1 ? 1 : first > table.steps - 2 ? table.steps - 2 : first) - 1;
  const auto c = kernel::cubic_weights(x - static_cast<T>(first + 1));
  const std::size_t n = table.columns;
  const T *row[4];
  for (std::size_t k = 0; k < 4; ++k)
    row[k] = table.values.data() + (first + k) * 2 * n;
  const auto mix = [&](std::size_t i) {
    return c.w[0] * row[0][i] + c.w[1] * row[1][i] + c.w[2] * row[2][i] + c.w[3] * row[3][i];
  };
  for (std::size_t i = 0; i < n; ++i) {
    a[i] = mix(i);
    b[i] = mix(n + i);
  }
}

template <class T> UMOV_KERNEL T magnitude(T x) { return x < 0 ? -x : x; }

/// The common case in one loop: one lobe for all bands and at most one product.
template <class T>
UMOV_KERNEL void add_plain(const SlotColour<T> &slot, const SlotSums<T> &sums,
                           const T *__restrict a, const T *__restrict b,
                           const LightColumns<T> &out) {
  const T s = slot.has_lobe ? sums.specular[0] : 0,
          d = slot.has_lobe ? sums.specular_deviation[0] : 0,
          e = slot.has_lobe ? sums.specular_bias[0] : 0;
  const T *__restrict whole = slot.product_count > 0 ? slot.whole.data() : a;
  const T s_p = slot.product_count > 0 ? sums.product[0] : 0,
          d_p = slot.product_count > 0 ? sums.product_deviation[0] : 0;
  const T e_p = slot.diffuse_error;
  const std::size_t n = slot.bands;
  const bool has_q = !slot.is_intensity_only;
  T *__restrict i = out.i, *__restrict q = out.q, *__restrict var_i = out.var_i,
                *__restrict var_q = out.var_q, *__restrict bias = out.bias;
  for (std::size_t k = 0; k < n; ++k) {
    const T diffuse = whole[k] * s_p;
    i[k] += a[k] * s + diffuse;
    bias[k] += a[k] * e + e_p * diffuse;
  }
  for (std::size_t k = 0; has_q && k < n; ++k)
    q[k] += b[k] * s;
  if (!sums.varies)
    return;
  for (std::size_t k = 0; k < n; ++k) {
    const T dev_i = a[k] * d + magnitude(whole[k]) * d_p;
    var_i[k] += dev_i * dev_i;
  }
  for (std::size_t k = 0; has_q && k < n; ++k)
    var_q[k] += (b[k] * d) * (b[k] * d);
}

/// Deviations of a slot are added before they are squared: its lobes and products share facets.
template <class T>
UMOV_KERNEL void add_variances(const SlotColour<T> &slot, const SlotSums<T> &sums,
                               const ColourRoom<T> &at, const LightColumns<T> &out) {
  const std::size_t n = slot.bands;
  const T *a = at.a + slot.column, *b = at.b + slot.column, *ratio = at.ratio;
  T *__restrict dev_i = at.dev_i, *__restrict dev_q = at.dev_q, *__restrict dev_u = at.dev_u;
  for (std::size_t k = 0; k < n; ++k) {
    const T d = slot.has_lobe ? sums.specular_deviation[slot.lobe[k]] : 0;
    dev_i[k] = a[k] * d;
    dev_q[k] = magnitude(b[k]) * d;
    dev_u[k] = 0;
  }
  for (std::size_t p = 0; p < slot.product_count; ++p) {
    const T d = sums.product_deviation[p];
    const T *whole = slot.whole.data() + p * n, *bounced = slot.single_bounce.data() + p * n;
    for (std::size_t k = 0; k < n; ++k)
      dev_i[k] += magnitude(whole[k]) * d;
    for (std::size_t k = 0; slot.has_single_bounce && k < n; ++k)
      dev_q[k] += magnitude(ratio[k] * bounced[k]) * d;
    for (std::size_t k = 0; slot.has_emission && k < n; ++k) {
      dev_q[k] += magnitude(slot.q[p * n + k]) * d;
      dev_u[k] += magnitude(slot.u[p * n + k]) * d;
    }
  }
  for (std::size_t k = 0; k < n; ++k)
    out.var_i[k] += dev_i[k] * dev_i[k];
  for (std::size_t k = 0; !slot.is_intensity_only && k < n; ++k)
    out.var_q[k] += dev_q[k] * dev_q[k];
  for (std::size_t k = 0; !slot.is_intensity_only && slot.has_emission && k < n; ++k)
    out.var_u[k] += dev_u[k] * dev_u[k];
}

/// Adds the light of one slot with kernels.
template <class T>
UMOV_KERNEL void add_slot(const SlotColour<T> &slot, const SlotSums<T> &sums,
                          const ColourRoom<T> &at, const LightColumns<T> &out) {
  const std::size_t n = slot.bands;
  const T *__restrict a = at.a + slot.column, *__restrict b = at.b + slot.column;
  if (slot.is_plain)
    return add_plain(slot, sums, a, b, out);
  T *__restrict i = out.i, *__restrict q = out.q, *__restrict bias = out.bias;
  T *__restrict ratio = at.ratio;
  const bool has_q = !slot.is_intensity_only;
  for (std::size_t k = 0; slot.has_single_bounce && k < n; ++k)
    ratio[k] = a[k] > 0 ? b[k] / a[k] : 0;
  for (std::size_t k = 0; slot.has_lobe && k < n; ++k) {
    const std::uint32_t lobe = slot.lobe[k];
    i[k] += a[k] * sums.specular[lobe];
    bias[k] += a[k] * sums.specular_bias[lobe];
    q[k] += has_q ? b[k] * sums.specular[lobe] : 0;
  }
  for (std::size_t p = 0; p < slot.product_count; ++p) {
    const T s = sums.product[p], e = slot.diffuse_error;
    const T *__restrict whole = slot.whole.data() + p * n;
    for (std::size_t k = 0; k < n; ++k) {
      i[k] += whole[k] * s;
      bias[k] += e * (whole[k] * s);
    }
    const T *__restrict bounced = slot.single_bounce.data() + p * n;
    for (std::size_t k = 0; has_q && slot.has_single_bounce && k < n; ++k)
      q[k] += ratio[k] * bounced[k] * s;
    for (std::size_t k = 0; has_q && slot.has_emission && k < n; ++k) {
      q[k] += slot.q[p * n + k] * s;
      out.u[k] += slot.u[p * n + k] * s;
    }
  }
  if (sums.varies)
    add_variances(slot, sums, at, out);
}

/// What single precision costs on the flanks of a lobe.
template <class T> struct LobeRounding {
  T per_peak; ///< 1 over the largest value of D G2/4, that of a Gaussian
  T per_root; ///< relative error per sqrt(2 x) where the lobe has fallen to exp(-x)
};

inline constexpr int halvings_most = 127;
/// The n with 2^-n below x, for x between 0 and 1; 0 above. From the exponent's bits.
UMOV_KERNEL int halvings(double x) {
  const int n = 1023 - static_cast<int>(__builtin_bit_cast(std::uint64_t, x) >> 52);
  return n < 0 ? 0 : n > halvings_most ? halvings_most : n;
}
UMOV_KERNEL int halvings(float x) {
  const int n = 127 - static_cast<int>(__builtin_bit_cast(std::uint32_t, x) >> 23);
  return n < 0 ? 0 : n > halvings_most ? halvings_most : n;
}
/// sqrt(2 x) of what has fallen to 2^-n = exp(-x) of its peak; ln 2 rounded up.
template <class T> UMOV_KERNEL T flank_root(int n) {
  using std::sqrt;
  return sqrt(static_cast<T>(1.4) * static_cast<T>(n));
}
/// On the flank of a lobe, exp(-m |n - h|^2/2), the rounding of n and h to single precision is
/// multiplied by m |n - h|, which is sqrt(2 m x) where the lobe has fallen to exp(-x): by that of
/// the whole sum at most. Below 2^-126 of the peak nothing is left.
template <class T> UMOV_KERNEL T rounding_of(T sum, const LobeRounding<T> &of, T root) {
  return sum * of.per_root * root + static_cast<T>(1.2e-38) / of.per_peak;
}

/// Half-width of a pose's light in one band, times `scale`.
template <class T> UMOV_KERNEL T half_width(T variance, T i, T bias, T scale) {
  using std::sqrt;
  const T known = (static_cast<T>(sums_rounding) * magnitude(i) + bias) * scale;
  return (variance > 0 ? static_cast<T>(normal_95) * sqrt(variance) * scale : 0) + known;
}

} // namespace umov::backend
