#pragma once
// A material made ready for a set of bands: what the sum over facets needs.

#include <complex>
#include <memory>
#include <umov/optics/band.h>
#include <umov/optics/stokes.h>
#include <umov/surface/material.h>
#include <vector>

namespace umov {

/// Fresnel factors of unpolarized light at one phase angle: M00 = a, M10 = b.
struct FresnelFactors {
  double a = 0, b = 0;
};

/// A compiled material. Copies share their tables. All functions are pure and thread safe.
/// n_l, n_v: cosines of Sun and observer to the normal; l_v: cosine of the phase angle. Directions
/// at or below the horizon (n_l <= 0 or n_v <= 0) give 0.
class Surface {
public:
  /// Tabulates g(k), and R(k) per band where there is a body lobe. BadInput where a table does not
  /// cover a band, m < 0 or a reflectance is outside 0..1.
  static Result<Surface> compile(const Material &material, const std::vector<Band> &bands);

  /// w (n.l)(n.v) = D(h) G2(l,v) / 4 [1/sr]: the specular sum of a facet per unit area, without
  /// Fresnel. Finite everywhere; 0 at phase 180.
  [[nodiscard]] double specular(double n_l, double n_v, double l_v) const;

  /// f_b (n.l)(n.v) [1/sr] of the body lobe in a band, unpolarized (adds to I alone).
  [[nodiscard]] double body(std::size_t band, double n_l, double n_v) const;
  [[nodiscard]] bool has_body() const;

  /// Fresnel reflection of every contributing microfacet (incidence = half the phase angle).
  [[nodiscard]] FresnelFactors fresnel(std::size_t band, double l_v) const;
  /// The whole Mueller matrix of one reflection at that phase angle (physics.md section 2).
  [[nodiscard]] Mueller<ScatteringPlane, ScatteringPlane> mueller(std::size_t band,
                                                                  double l_v) const;
  /// Mueller BRDF [1/sr]: w M_F + body lobe in M00. Grazing and back directions give zeros.
  [[nodiscard]] Mueller<ScatteringPlane, ScatteringPlane> brdf(std::size_t band, double n_l,
                                                               double n_v, double l_v) const;
  /// Directional albedo of the specular lobe alone, Fresnel included (R(k) of physics.md section
  /// 3).
  [[nodiscard]] double specular_albedo(std::size_t band, double n_k) const;
  /// The same with F = 1 (white furnace).
  [[nodiscard]] double furnace_albedo(double n_k) const;
  /// Masking P(k) of one direction.
  [[nodiscard]] double masking(double n_k) const;
  [[nodiscard]] const Material &material() const;
  [[nodiscard]] std::size_t band_count() const;

private:
  struct Tables;
  std::shared_ptr<const Tables> tables_;
};

} // namespace umov
