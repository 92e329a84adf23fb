// The mean of a lobe's D over the half vectors of a disk, for lobes of any width:
// docs/theory/lobes.md.
#if defined(UMOV_KERNEL_DISK_LOBE_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef UMOV_KERNEL_DISK_LOBE_INL_H
#undef UMOV_KERNEL_DISK_LOBE_INL_H
#else
#define UMOV_KERNEL_DISK_LOBE_INL_H
#endif

#include "kernel/angles.inl.h"
#include "kernel/facet_constants.h"
#include "kernel/math.inl.h"
#include "kernel/microfacet.inl.h"

#include "kernel/begin.h"

/// The normal n against the mean half vector h: 1 - n.h, and coordinates in the scattering plane
/// and across it, squared.
template <class R> struct FromHalf { R apart, x, x2, y2; };

/// From second moments to the disk, of a Gaussian; x2, y2 in the coordinates that it is one in.
/// Beyond six standard deviations there is nothing to correct: the polynomial stays what it is
/// there.
template <class R, class T> UMOV_KERNEL R disk_correction(const DiskCorrection<T> &c, R x2, R y2) {
  const R most = R(T(40));
  const R u = min(x2 * R(c.per_along), most), w = min(y2 * R(c.per_across), most);
  const R first = R(c.one) + u * (R(c.u) + u * (R(c.uu) + u * R(c.uuu)));
  const R second = R(c.w) + u * (R(c.uw) + u * R(c.uuw));
  const R third = R(c.ww) + u * R(c.uww);
  return max(R(T(0)), first + w * (second + w * (third + w * R(c.www))));
}

/// Blinn-Phong; log2_cosine of n.h.
template <class R, class T>
UMOV_KERNEL R blinn_phong_over_disk(const LobeConstants<T> &lobe, const LobeAtPose<T> &at,
                                    const FromHalf<R> &from, R log2_cosine) {
  const R plain = R(at.peak) * exp2(R(lobe.shape) * log2_cosine + R(at.along) * from.x2 +
                                    R(at.across) * from.y2);
  return at.is_corrected ? plain * disk_correction(at.correction, from.x2, from.y2) : plain;
}

/// Cosines to h below this are taken for it: slopes stay finite.
template <class R> UMOV_KERNEL R cosine_to_half(R apart) { return max(R(1) - apart, R(1e-4)); }

/// Beckmann, a Gaussian in slopes.
template <class R, class T>
UMOV_KERNEL R beckmann_over_disk(const LobeAtPose<T> &at, const FromHalf<R> &from) {
  const R cosine = cosine_to_half(from.apart), per_cosine2 = R(T(1)) / (cosine * cosine);
  const R x2 = from.x2 * per_cosine2, y2 = from.y2 * per_cosine2;
  const R plain =
      R(at.peak) * per_cosine2 * per_cosine2 * exp2(R(at.along) * x2 + R(at.across) * y2);
  return at.is_corrected ? plain * disk_correction(at.correction, x2, y2) : plain;
}

/// The integral over one chord of the image, in widths of the lobe: from x1 to x2 at a distance of
/// sinh from the normal; cosh^2 = 1 + sinh^2.
template <class R> UMOV_KERNEL R gaussian_chord(R x1, R x2, R sinh) {
  const R root_half = R(0.70710678118654752), most = R(8.9); // what erfc takes
  const R from = clamped(x1 * root_half, -most, most), to = min(x2 * root_half, most);
  return exp(R(-0.5) * sinh * sinh) * (erfc(from) - erfc(to));
}
/// int dx/(g^2 + x^2)^2 with g = cosh, without the cancellation of far chords.
template <class R> UMOV_KERNEL R ggx_chord(R x1, R x2, R g) {
  const R g2 = g * g, along = x2 - x1, both = g2 + x1 * x2;
  const R turn = arc_tangent(g * along, both);
  const R rest = g * along * (g2 - x1 * x2) / ((g2 + x1 * x1) * (g2 + x2 * x2));
  return (turn + rest) / (R(2) * g2 * g);
}

template <class R> UMOV_KERNEL R arc_sinh(R x) {
  const R size = abs(x), root = log(size + sqrt(size * size + R(1)));
  return select(x < R(0), -root, root);
}

/// Gauss and Legendre's nodes on [-1, 1].
inline constexpr std::size_t chord_count = 8;
template <class T> UMOV_KERNEL T chord_node(std::size_t k) {
  constexpr T node[chord_count / 2] = {T(0.18343464249564981), T(0.52553240991632899),
                                       T(0.79666647741362674), T(0.96028985649753623)};
  return k < chord_count / 2 ? -node[chord_count / 2 - 1 - k] : node[k - chord_count / 2];
}
template <class T> UMOV_KERNEL T chord_weight(std::size_t k) {
  constexpr T weight[chord_count / 2] = {T(0.36268378337836198), T(0.31370664587788729),
                                         T(0.22238103445337447), T(0.10122853629037626)};
  return weight[k < chord_count / 2 ? chord_count / 2 - 1 - k : k - chord_count / 2];
}

/// The disk's image as chords in the scattering plane's direction, each in closed form; x, y: the
/// normal in the image's axes, in widths of the lobe, y >= 0. Chords crowd where the lobe looks (y
/// + sinh), so that it may be narrower or wider than the image: within 1e-3 of the peak while the
/// image is at most five widths long, within 2e-2 however narrow the lobe (where it ends is known
/// to the second order of the disk's radius).
template <class R, class T>
UMOV_KERNEL R chords_over_disk(LobeKind kind, const DiskChords<T> &image, R x, R y) {
  const bool is_gaussian = kind != LobeKind::Ggx;
  const R reach = R(T(is_gaussian ? 6 : 1e6)), b = R(image.half_across), a = R(image.half_along);
  const R least = max(-y - b, -reach), most = max(min(b - y, reach), least);
  const R low = arc_sinh(least), high = arc_sinh(most);
  const R middle = R(T(0.5)) * (low + high), span = R(T(0.5)) * (high - low);
  const R per_across = R(T(1) / image.half_across);
  R sum = R(T(0));
  for (std::size_t k = 0; k < chord_count; ++k) {
    const R e = exp(middle + span * R(chord_node<T>(k))), per_e = R(T(1)) / e;
    const R sinh = R(T(0.5)) * (e - per_e), cosh = R(T(0.5)) * (e + per_e);
    const R at = y + sinh, part = at * per_across;
    const R half_chord = a * sqrt(max(R(T(0)), R(T(1)) - part * part));
    const R away = abs(x + R(image.bend) * at * at);
    const R chord = is_gaussian ? gaussian_chord(away - half_chord, away + half_chord, sinh)
                                : ggx_chord(away - half_chord, away + half_chord, cosh);
    sum = sum + R(chord_weight<T>(k)) * cosh * chord;
  }
  const R brightness = R(T(1)) - clamped(x, -a, a) * R(image.skew);
  return R(image.scale) * span * sum * max(R(T(0)), brightness);
}

/// GGX: D is a rational function of slopes, and its mean a series of its derivatives; chords where
/// the image is not small against the lobe's width there.
template <class R, class T>
UMOV_KERNEL R ggx_over_disk(const LobeConstants<T> &lobe, const LobeAtPose<T> &at,
                            const FromHalf<R> &from, R half_shift) {
  const R cosine = cosine_to_half(from.apart), per_cosine2 = R(T(1)) / (cosine * cosine);
  const R x2 = from.x2 * per_cosine2, y2 = from.y2 * per_cosine2;
  const R size = x2 + y2 + R(lobe.shape * lobe.shape), per_size = R(T(1)) / size;
  const R u = x2 * per_size, w = y2 * per_size;
  const R p = R(at.along) * per_size, q = R(at.across) * per_size;
  R mean = R(T(1)) + p * (R(T(3)) * u - R(T(0.5))) + q * (R(T(3)) * w - R(T(0.5)));
  if (at.is_corrected)
    mean = mean + p * p * (R(T(0.375)) - u * (R(T(6)) - R(T(10)) * u)) +
           p * q * (R(T(0.25)) - R(T(2)) * (u + w) + R(T(20)) * u * w) +
           q * q * (R(T(0.375)) - w * (R(T(6)) - R(T(10)) * w));
  const R per_cosine = per_size * per_cosine2;
  const R series = R(at.peak) * per_cosine * per_cosine * max(R(T(0)), mean);
  if (!at.uses_chords)
    return series;
  const auto is_narrow = size < R(at.across * T(10));
  if (!any(is_narrow))
    return series;
  const R scale = R(at.chords.per_width) / cosine;
  const R chords =
      chords_over_disk(lobe.kind, at.chords, (from.x + half_shift) * scale, sqrt(from.y2) * scale) *
      per_cosine2 * per_cosine2;
  return select(is_narrow, chords, series);
}

/// Blinn-Phong and Beckmann where the disk's image is not small against them.
template <class R, class T>
UMOV_KERNEL R narrow_over_disk(const LobeConstants<T> &lobe, const LobeAtPose<T> &at,
                               const FromHalf<R> &from, R half_shift) {
  // Blinn-Phong is a Gaussian in the angle (to the fourth order), Beckmann in the slope.
  const R sine2 = from.x2 + from.y2;
  const R cosine = cosine_to_half(from.apart), per_cosine2 = R(T(1)) / (cosine * cosine);
  const bool is_beckmann = lobe.kind == LobeKind::Beckmann;
  const R scale =
      R(at.chords.per_width) * (is_beckmann ? R(T(1)) / cosine : R(T(1)) + sine2 * R(T(1) / T(6)));
  const R x = (from.x + half_shift) * scale, y = sqrt(from.y2) * scale;
  const auto is_near =
      max(abs(x) - R(at.chords.half_along), y - R(at.chords.half_across)) < R(T(7));
  if (!any(is_near))
    return R(T(0));
  const R mean = chords_over_disk(lobe.kind, at.chords, x, y);
  return select(is_near, is_beckmann ? mean * per_cosine2 * per_cosine2 : mean, R(T(0)));
}

#include "kernel/end.h"
#endif
