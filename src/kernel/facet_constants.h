#pragma once
// Constants of the facet kernel, plain numbers: per material, and per material and pose.

#include <cstddef>
#include <umov/kernel/lobe.h>

namespace umov::kernel {

/// Degree of the polynomials that stand for tabulated functions of a cosine.
inline constexpr std::size_t polynomial_degree = 12;
/// Half vectors that stand for the source's disk where a lobe has no closed form of its mean: its
/// centre and six on a ring, exact up to the fifth power (Stroud 1971, S2 5-1); for lobes so much
/// wider than the disk's image that its variance is at most `nodes_max` of theirs.
inline constexpr std::size_t source_nodes = 7;
inline constexpr double source_ring = 0.81649658092772603; ///< sqrt(2/3) of the radius
inline constexpr double nodes_max = 3e-2;

/// One isotropic lobe.
template <class T> struct LobeConstants {
  LobeKind kind = LobeKind::BlinnPhong;
  Shadowing joint = Shadowing::Ashikhmin;
  T shape = 0;                        ///< m of Blinn-Phong, alpha of the others
  T peak = 0;                         ///< D at the normal, of Blinn-Phong
  T per_width2 = 0;                   ///< 1 / variance of the slope
  T masking[polynomial_degree + 1]{}; ///< P(k) / (n.k) against masking_scale n.k - 1
  T masking_limit = 1;                ///< P = 1 beyond it
  T masking_scale = 2;                ///< 2 / masking_limit
};

/// By what a mean over the disk differs from that of a Gaussian of its variances: a polynomial in
/// the squared coordinates u, w of the normal along and across the scattering plane.
template <class T> struct DiskCorrection {
  T per_along = 0, per_across = 0; ///< 1 / variances of the mean
  T one = 1, u = 0, w = 0, uu = 0, uw = 0, ww = 0, uuu = 0, uuw = 0, uww = 0, www = 0;
};

/// The disk's image in widths of the lobe, for lobes that are not much wider than it.
template <class T> struct DiskChords {
  T per_width = 0;
  T scale = 0;                       ///< of the integral over the image
  T half_along = 0, half_across = 0; ///< half axes
  T bend = 0;                        ///< of the long axis, towards the observer, per square
  T skew = 0;                        ///< growth of the image's brightness towards the observer
};

/// What the source's size makes of a lobe at one phase angle (kernel/disk_lobe.h).
template <class T> struct LobeAtPose {
  T peak = 0; ///< of the mean
  /// Gaussian lobes: growth of the mean's logarithm (base 2) with the squares of the coordinates.
  /// GGX: squares of the half axes of the disk's image.
  T along = 0, across = 0;
  T reach = 4;               ///< 1 - n.h from which on nothing is left in single precision
  bool is_corrected = false; ///< beyond second moments
  bool uses_chords = false;  ///< GGX: where the lobe is narrow
  DiskCorrection<T> correction;
  DiskChords<T> chords;
};

/// Directions of one pose.
template <class T> struct FacetPose {
  T sun[3]{}, observer[3]{};
  T cos_phase = 1;
  /// 1/|l - v|: (n.l - n.v) times it is the normal's coordinate in the plane; 0 at phase 0.
  T along_scale = 0;
  T across[3]{};    ///< perpendicular to the scattering plane, along observer x Sun
  T per_sine = 0;   ///< 1/|observer x Sun|; 0 without a plane
  T half[3]{};      ///< mean half vector of the disk
  T half_shift = 0; ///< its coordinate in the plane, from the half vector of the disk's centre
};

} // namespace umov::kernel
