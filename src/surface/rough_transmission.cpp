#include <umov/surface/rough_transmission.h>

#include "kernel/microfacet.inl.h"

#include <cmath>

namespace umov {
namespace {

double joint(const Distribution &normals, Shadowing shadowing, Vec3<Facet> l, Vec3<Facet> v) {
  // The two directions lie on opposite sides: masking and shadowing are independent
  // (Walter et al. 2007, section 5.1), and only the Smith form of Heitz 2014 is left for the rest.
  const double p_l = normals.masking(l), p_v = normals.masking({v.x, v.y, -v.z});
  return shadowing == Shadowing::Smith ? kernel::smith(p_l, p_v) : kernel::separable(p_l, p_v);
}

} // namespace

RoughTransmission rough_transmission(const Distribution &normals, Shadowing shadowing,
                                     Vec3<Facet> l, Vec3<Facet> v, double n_i, double n_o) {
  RoughTransmission out;
  if (!(l.z > 0 && v.z < 0))
    return out;
  Vec3<Facet> h = -(n_i * l + n_o * v);
  const double size = norm(h);
  if (!(size > 1e-12))
    return out; // equal indices, straight on: nothing bends
  h = h / size;
  if (h.z < 0)
    h = -h;
  const double l_h = dot(l, h), v_h = dot(v, h);
  if (!(l_h > 0 && v_h < 0))
    return out; // a facet seen from its wrong side
  const double bend = n_i * l_h + n_o * v_h;
  if (!(bend * bend > 0))
    return out;
  out.f = l_h * -v_h / (l.z * -v.z) * n_o * n_o * normals.density(h) *
          joint(normals, shadowing, l, v) / (bend * bend);
  // Fresnel at the facet: cosines l_h and -v_h obey Snell's law by the choice of h.
  const double c_i = l_h, c_o = -v_h;
  const double r_s = (n_i * c_i - n_o * c_o) / (n_i * c_i + n_o * c_o);
  const double r_p = (n_o * c_i - n_i * c_o) / (n_o * c_i + n_i * c_o);
  out.t_s = 1 - r_s * r_s;
  out.t_p = 1 - r_p * r_p;
  out.cross = std::sqrt(out.t_s * out.t_p);
  return out;
}

} // namespace umov
