#pragma once
// Thermal radiation of a body by Kirchhoff's law.

#include <umov/optics/interface.h>

namespace umov {

/// Emissivity of an opaque surface towards one direction, for each polarization 1 - R: i for
/// unpolarized sums, q referred to s = n x v, the normal of the emission plane (q <= 0 for a smooth
/// surface: it shines p-polarized).
struct Emissivity {
  double i = 0, q = 0;
};
/// Smooth surface (Siegel & Howell 2002, section 3; the substrate must be opaque).
Emissivity smooth_emissivity(const Interface &surface, double cos_emission);

/// Planck's law, spectral radiance [W m-2 sr-1 nm-1] at a temperature [K] >= 0. CODATA 2018
/// constants.
double planck_radiance(Wavelength wavelength, double temperature_k);

} // namespace umov
