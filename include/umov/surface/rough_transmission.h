#pragma once
#include <complex>
#include <umov/core/vec3.h>
#include <umov/surface/distribution.h>
#include <umov/surface/material.h>

namespace umov {

/// Transmission through a rough boundary between two clear media (Walter et al. 2007, Eq. 21):
/// f_t [1/sr] = |l.h||v.h|/(|l.n||v.n|) n_o^2 T G2 D/(n_i l.h + n_o v.h)^2 with
/// h_t = -(n_i l + n_o v) normalised. `l` lies on the side of the normal in the medium n_i, `v` on
/// the other in n_o; 0 if they do not. The Mueller matrix is f_t times that of transmission in the
/// plane (l, v), entries a, b (powers) and the real cross term; radiance scales with n^2.
struct RoughTransmission {
  double f = 0;            ///< without T
  double t_s = 0, t_p = 0; ///< power transmittances of the microfacet
  double cross = 0;        ///< sqrt(t_s t_p): both amplitudes are real between clear media
};
/// Light through a rough boundary in one direction.
RoughTransmission rough_transmission(const Distribution &normals, Shadowing shadowing,
                                     Vec3<Facet> l, Vec3<Facet> v, double n_i, double n_o);

} // namespace umov
