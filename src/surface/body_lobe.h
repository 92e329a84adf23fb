#pragma once
// Private: light that is not one reflection: scattered below the surface, or between microfacets.

#include "surface/albedo.h"

#include <umov/optics/interface.h>
#include <umov/surface/surface.h>

namespace umov {

/// Light scattered below the surface of one band.
class BodyLight {
public:
  /// Unpolarized (paper's Eq. 16 with its factor fixed by energy):
  /// f_b = R_sub (1-R(l)) (1-R(v)) / (pi (1-Rbar)), R(k) what the surface itself reflects.
  BodyLight(double reflectance, AlbedoTable reflected);
  /// Polarized (Baek et al. 2018): M_b = R_sub/(pi (1 - Fbar)) t_out t_in^T.
  BodyLight(double reflectance, const Interface &surface);

  /// f M (n.l)(n.v) for incoming light `in`, both in the scattering plane.
  [[nodiscard]] Stokes<ScatteringPlane> operator()(const SurfaceDirections &at,
                                                   const Stokes<ScatteringPlane> &in) const;

  /// I of sunlight is factor() (n.l)(n.v) entering(n.l) entering(n.v).
  [[nodiscard]] bool is_polarized() const { return surface_.has_value(); }
  [[nodiscard]] double factor() const { return factor_; }
  [[nodiscard]] double entering(double n_k) const;
  /// Of the polarized lobe: half the difference of what leaves in s and in p, over the squared sine
  /// of the angle of emission, which it goes with near the normal.
  [[nodiscard]] double polarizing(double n_k) const;

  /// Directional albedo for unpolarized light.
  [[nodiscard]] double albedo(double n_k) const;

private:
  double factor_ = 0;
  double reflectance_ = 0;
  AlbedoTable reflected_;
  std::optional<Interface> surface_; ///< of the polarized lobe
};

/// Light that met several microfacets (Kulla & Conty 2017):
/// f_ms = F_ms (1-E(l))(1-E(v))/(pi (1-Ebar)), F_ms = Fbar^2 Ebar/(1 - Fbar (1 - Ebar)).
class Interreflected {
public:
  Interreflected(std::shared_ptr<const AlbedoTable> furnace, double mean_reflectance);
  /// f (n.l)(n.v) = factor() (n.l)(n.v) lost(n.l) lost(n.v).
  [[nodiscard]] double operator()(double n_l, double n_v) const;
  [[nodiscard]] double factor() const;
  [[nodiscard]] double lost(double n_k) const;
  /// Directional albedo F_ms (1 - E(k)).
  [[nodiscard]] double albedo(double n_k) const;

private:
  std::shared_ptr<const AlbedoTable> furnace_;
  double f_ms_ = 0;
};

} // namespace umov
