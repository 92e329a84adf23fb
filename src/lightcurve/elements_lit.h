#pragma once
// Private: what each element would send to the observer if nothing stood in the way.

#include "lightcurve/elements.h"

#include <umov/lightcurve/integrator.h>

namespace umov {

/// Directions of a pose with what follows from them.
struct PoseGeometry {
  Vec3<Body> sun, observer;
  Vec3<Body> half; ///< unit half vector; zero at phase 180
  double cos_phase = 0;
  bool has_plane = true; ///< false at phase 0 and 180: no scattering plane, Q = 0 by definition
};
PoseGeometry geometry_of(const Pose &pose);

/// One side of one element that faces both the Sun and the observer somewhere.
struct LitElement {
  std::uint32_t element = 0, slot = 0;
  std::uint32_t body_at = 0; ///< first of its bands in LitElements::body
  float side = 1;            ///< +1 front, -1 back
  bool is_glint = false;     ///< flat, and within its lobe's half width of the half vector
  double specular = 0;       ///< integral of D G / 4 [m2/sr]
  double projected = 0;      ///< integral of (n.l)(n.v) [m2]
  double share = 0;          ///< mean over the bands of its part in the light of the whole object
};

struct LitElements {
  std::vector<LitElement> list;                   ///< by slot, then in the order of the mesh
  std::vector<double> body;                       ///< integral of the body lobe [m2/sr]
  std::vector<FresnelFactors> fresnel;            ///< [slot * bands + band]
  std::vector<double> total;                      ///< per band: I if nothing were hidden
  std::vector<double> rule_error_i, rule_error_q; ///< per band: error of the triangle rule
};

LitElements light_elements(const Scene &scene, const Elements &elements, const PoseGeometry &pose);

} // namespace umov
