#pragma once
// A lobe under a source with a size: the numbers of one pose for kernel/disk_lobe.inl.h, in double.
// docs/theory/lobes.md.

#include "kernel/facet_constants.h"
#include "kernel/microfacet.inl.h"
#include "kernel/solar_nodes.inl.h"

#include <numbers>

namespace umov::kernel {

/// Variance of the disk's image over that of a Gaussian lobe: below `plain_max` cumulants beyond
/// the second change 5e-5 of the peak at most, up to `corrected_max` the fourth and the sixth
/// tell the rest to 6e-4 of the peak; beyond, the image is cut into chords.
inline constexpr double plain_max = 0.02, corrected_max = 0.3;
/// The same for GGX, with the square of the image's half axis over alpha^2: its Taylor series to
/// fourth order holds to 4e-4 of the peak up to there.
inline constexpr double ggx_plain_max = 0.01, ggx_taylor_max = 0.1;

/// The image of a disk of directions in half-vector space.
struct DiskImage {
  double along = 0, across = 0; ///< variances in the scattering plane and across it
  double tangent = 0;           ///< of half the phase angle
  /// The disk is even in directions of light: its image's mean lies off that of the disk's centre.
  [[nodiscard]] UMOV_KERNEL double shift() const { return -tangent * along; }
};

UMOV_KERNEL DiskImage disk_image(double radius, double l_v) {
  const DiskVariances<double> kappa = disk_variances(radius, l_v);
  const double cosine2 = max((1 + l_v) / 2, 1e-6);
  return {kappa.along, kappa.across, sqrt(max(0.0, (1 - l_v) / 2) / cosine2)};
}

/// Cumulants of an even ellipse: its characteristic function is 2 J1(k)/k, whose logarithm is
/// -k^2/8 - k^4/384 - k^6/9216 (Rayleigh's sums), k^2 = a^2 k_x^2 + b^2 k_y^2; each k^2 is an
/// operator -(a^2 d2/dx2 + b^2 d2/dy2), which makes Hermite polynomials of a Gaussian.
/// p, q: squares of the half axes over the variances of the mean.
UMOV_KERNEL void put_correction(double p, double q, DiskCorrection<double> &out) {
  const double f = -1.0 / 384, s = 1.0 / 9216;
  const double p2 = p * p, q2 = q * q, pq = p * q, p3 = p * p2, q3 = q * q2;
  out.one = 1 + f * (3 * p2 + 2 * pq + 3 * q2) - s * (15 * p3 + 9 * p * pq + 9 * q * pq + 15 * q3);
  out.u = f * (-6 * p2 - 2 * pq) + s * (45 * p3 + 18 * p * pq + 9 * q * pq);
  out.w = f * (-6 * q2 - 2 * pq) + s * (45 * q3 + 18 * q * pq + 9 * p * pq);
  out.uu = f * p2 - s * (15 * p3 + 3 * p * pq);
  out.uw = f * 2 * pq - s * 18 * (p * pq + q * pq);
  out.ww = f * q2 - s * (15 * q3 + 3 * q * pq);
  out.uuu = s * p3;
  out.uuw = s * 3 * p * pq;
  out.uww = s * 3 * q * pq;
  out.www = s * q3;
}

/// `width`: standard deviation of the slope of a Gaussian lobe, alpha of GGX; `scale`: what the
/// integral over chords in units of the width is multiplied by.
UMOV_KERNEL void put_chords(const DiskImage &disk, double width, double scale,
                            DiskChords<double> &out) {
  const double a = 2 * sqrt(disk.along), b = 2 * sqrt(disk.across);
  out.per_width = 1 / width;
  out.scale = scale / (std::numbers::pi * a * b);
  out.half_along = a / width;
  out.half_across = b / width;
  out.bend = disk.tangent / (1 + disk.tangent * disk.tangent) * width;
  out.skew = disk.tangent * width * disk.along / (disk.along + width * width);
}

/// 1 - n.h or more where the squared sine of the angle is `sine2`; 4, which nothing reaches, from
/// 90 deg on.
UMOV_KERNEL double apart_of(double sine2) { return sine2 < 1 ? 0.5 * sine2 * (1 + sine2) : 4; }

/// Everything that a pose makes of a lobe. What `out` does not use stays as it was.
UMOV_KERNEL void put_lobe_at_pose(const LobeConstants<double> &lobe, const DiskImage &disk,
                                  LobeAtPose<double> &out) {
  constexpr double pi = std::numbers::pi, log2e = std::numbers::log2e;
  if (lobe.kind == LobeKind::Ggx) {
    const double alpha2 = lobe.shape * lobe.shape, size = 4 * disk.across / alpha2;
    out.peak = alpha2 / pi;
    out.along = 4 * disk.along;
    out.across = 4 * disk.across;
    out.reach = 4;
    out.is_corrected = size > ggx_plain_max;
    out.uses_chords = size > ggx_taylor_max;
    if (out.uses_chords)
      put_chords(disk, lobe.shape, 1 / pi, out.chords);
    return;
  }
  const bool is_beckmann = lobe.kind == LobeKind::Beckmann;
  const double per_variance = is_beckmann ? 2 / (lobe.shape * lobe.shape) : lobe.shape;
  const double peak = is_beckmann ? per_variance / (2 * pi) : lobe.peak;
  const double p = per_variance * disk.along, q = per_variance * disk.across;
  out.uses_chords = q > corrected_max;
  out.is_corrected = q > plain_max;
  if (out.uses_chords) {
    const double width = 1 / sqrt(per_variance), a = 2 * sqrt(disk.along) + 8 * width,
                 b = 2 * sqrt(disk.across) + 8 * width; // kernel/disk_lobe.inl.h takes 7
    put_chords(disk, width, peak / per_variance * sqrt(pi / 2), out.chords);
    out.reach = apart_of(a * a + b * b);
    return;
  }
  constexpr double halvings = 130; // exp2 is 0 from 127 on
  out.reach = per_variance > 0 ? apart_of(2 / log2e * halvings * (1 + q) / per_variance) : 4;
  const auto by = blinn_phong_spread(per_variance, disk.along, disk.across);
  out.peak = peak * by.scale;
  // Beckmann's exponent is that of a Gaussian as it stands; Blinn-Phong's is a power of the cosine
  // and takes what is added to it.
  out.along = (is_beckmann ? by.along - per_variance / 2 : by.along) * log2e;
  out.across = (is_beckmann ? by.across - per_variance / 2 : by.across) * log2e;
  if (out.is_corrected) {
    out.correction.per_along = per_variance / (1 + p);
    out.correction.per_across = per_variance / (1 + q);
    put_correction(4 * p / (1 + p), 4 * q / (1 + q), out.correction);
  }
}

UMOV_KERNEL float rounded(double x) { return static_cast<float>(x); }

/// The constants of a lobe in single precision.
UMOV_KERNEL LobeConstants<float> round_lobe(const LobeConstants<double> &from) {
  LobeConstants<float> out;
  out.kind = from.kind;
  out.joint = from.joint;
  out.shape = rounded(from.shape);
  out.peak = rounded(from.peak);
  out.per_width2 = rounded(from.per_width2);
  for (std::size_t k = 0; k <= polynomial_degree; ++k)
    out.masking[k] = rounded(from.masking[k]);
  out.masking_limit = rounded(from.masking_limit);
  out.masking_scale = rounded(from.masking_scale);
  return out;
}

/// What the pose makes of it, likewise.
UMOV_KERNEL void round_lobe_at_pose(const LobeAtPose<double> &from, LobeAtPose<float> &to) {
  to.peak = rounded(from.peak);
  to.along = rounded(from.along);
  to.across = rounded(from.across);
  to.reach = rounded(from.reach);
  to.is_corrected = from.is_corrected;
  to.uses_chords = from.uses_chords;
  if (from.is_corrected) {
    const auto &c = from.correction;
    to.correction = {rounded(c.per_along), rounded(c.per_across), rounded(c.one), rounded(c.u),
                     rounded(c.w),         rounded(c.uu),         rounded(c.uw),  rounded(c.ww),
                     rounded(c.uuu),       rounded(c.uuw),        rounded(c.uww), rounded(c.www)};
  }
  if (from.uses_chords) {
    const auto &c = from.chords;
    to.chords = {rounded(c.per_width),   rounded(c.scale), rounded(c.half_along),
                 rounded(c.half_across), rounded(c.bend),  rounded(c.skew)};
  }
}

/// Half vector of two directions; `other` where there is none (phase 180).
template <class V> UMOV_KERNEL V half_vector(V l, V v, V other) {
  const V sum = l + v;
  const double length = norm(sum);
  return length > 1e-12 ? (1 / length) * sum : other;
}
/// Mean half vector of the disk. `apart` is |l - v|.
template <class V>
UMOV_KERNEL V mean_half_vector(V l, V v, V other, double apart, const DiskImage &disk) {
  if (!(apart > 1e-7))
    return half_vector(l, v, other);
  // The shift is the tangent of half the phase angle, |l - v|/|l + v|, times `along`.
  const V mean = (l + v) - disk.along * (l - v);
  const double length = norm(mean);
  return length > 1e-12 ? (1 / length) * mean : other;
}

} // namespace umov::kernel
