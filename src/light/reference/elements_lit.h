#pragma once
// Private: what each element would send to the observer if nothing stood in the way.

#include "light/reference/elements.h"

#include <umov/light/integrator.h>

namespace umov {

/// Directions of a pose with what follows from them.
struct PoseGeometry {
  Vec3<Body> sun, observer;
  Vec3<Body> half; ///< unit half vector; zero at phase 180
  double cos_phase = 0;
  double sun_radius_rad = 0;
  bool has_plane = true; ///< false at phase 0 and 180: no scattering plane, Q = 0 by definition
};
PoseGeometry geometry_of(const Pose &pose);

/// One side of one element that faces both the Sun and the observer somewhere.
struct LitElement {
  std::uint32_t element = 0, slot = 0;
  std::uint32_t specular_at = 0; ///< first of its lobes in LitElements::specular
  std::uint32_t diffuse_at = 0;  ///< first of its bands in LitElements::diffuse
  float side = 1;                ///< +1 front, -1 back
  bool is_piece = false;         ///< `element` counts in LitElements::pieces
  bool is_glint = false;         ///< flat, and within its lobe's half width of the half vector
  double projected = 0;          ///< integral of (n.l)(n.v) [m2]
  double share = 0; ///< mean over the bands of its part in the light of the whole object
};

struct LitElements {
  std::vector<LitElement> list; ///< by slot, then in the order of the mesh
  std::vector<Element> pieces;  ///< of elements cut for this pose
  bool has_u_or_v = false;      ///< some surface or the source gives light outside I and Q
  std::size_t lobes = 1;        ///< 1: the lobe is the same in all bands; or bands
  std::vector<double> specular; ///< integral of D G / 4 per lobe [m2/sr]
  std::vector<Stokes<ScatteringPlane>> diffuse;       ///< all other light, per band [m2/sr]
  std::vector<Stokes<ScatteringPlane>> fresnel;       ///< one reflection: [slot * bands + band]
  std::vector<double> total;                          ///< per band: I if nothing were hidden
  std::vector<Stokes<ScatteringPlane>> rule_variance; ///< as `diffuse`: squared error of the rule

  [[nodiscard]] std::size_t lobe_of(std::size_t band) const { return lobes == 1 ? 0 : band; }
  /// Light of an element in a band if nothing were hidden.
  [[nodiscard]] Stokes<ScatteringPlane> light_of(const LitElement &e, std::size_t band) const {
    return fresnel[e.slot * total.size() + band] * specular[e.specular_at + lobe_of(band)] +
           diffuse[e.diffuse_at + band];
  }
};

inline const Element &element_of(const Elements &elements, const LitElements &lit,
                                 const LitElement &e) {
  return e.is_piece ? lit.pieces[e.element] : elements.list[e.element];
}

/// Directions at a point of an element's side, for its surface.
SurfaceDirections directions_at(const Scene &scene, const PoseGeometry &pose, const Element &e,
                                std::uint32_t slot, Vec3<Body> normal);

/// Throws Failure (Interrupted) once `cancel`, which may be null, became true.
LitElements light_elements(const Scene &scene, const Elements &elements, const PoseGeometry &pose,
                           const Stokes<ScatteringPlane> &source,
                           const std::atomic<bool> *cancel = nullptr);

} // namespace umov
