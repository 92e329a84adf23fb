#pragma once
// Constants of the facet kernel, plain numbers: per material, and per material and pose.

#include <cstddef>
#include <umov/kernel/lobe.h>

namespace umov::kernel {

/// Degree of the polynomials that stand for tabulated functions of a cosine.
inline constexpr std::size_t polynomial_degree = 12;
/// Half vectors that stand for the source's disk: its centre and six on a ring, exact up to the
/// fifth power (Stroud 1971, S2 5-1).
inline constexpr std::size_t source_nodes = 7;
inline constexpr double source_ring = 0.81649658092772603; ///< sqrt(2/3) of the radius
/// Variance of the disk's image over that of the lobe, up to which a closed form is taken: it
/// leaves out fourth moments, of the order q^2/8; and up to which seven nodes are.
inline constexpr double closed_form_max = 1e-2, nodes_max = 3e-2;

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

/// What the source's size makes of a lobe at one phase angle.
template <class T> struct LobeAtPose {
  bool has_closed_form = false;      ///< Blinn-Phong, Gaussian mean over the disk
  bool uses_nodes = false;           ///< seven half vectors
  T peak = 0, along = 0, across = 0; ///< of the mean; growth of its logarithm (base 2) with x2, y2
};

/// Directions of one pose.
template <class T> struct FacetPose {
  T sun[3]{}, observer[3]{};
  T cos_phase = 1;
  T along_scale =
      0; ///< 1/|l - v|: (n.l - n.v) times it is the normal's x in the plane; 0 at phase 0
  T half[source_nodes][3]{};
};

} // namespace umov::kernel
