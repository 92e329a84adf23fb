#pragma once
// A smooth boundary with films and thick layers on it, at one wavelength.

#include <complex>
#include <umov/core/quantity.h>
#include <umov/optics/stokes.h>
#include <vector>

namespace umov {

/// One layer on a substrate, as light of one wavelength meets it.
struct OpticalLayer {
  std::complex<double> eta;
  double thickness_nm = 0;
  bool is_coherent = true; ///< false: so thick that interference averages out
};

/// The distinct entries of the Mueller matrix of a reflection or transmission in the plane of
/// incidence: M00 = M11 = a, M01 = M10 = b, M22 = M33 = z.re, M32 = -M23 = z.im.
struct MuellerEntries {
  double a = 0, b = 0;
  std::complex<double> z;
  /// All sixteen entries.
  [[nodiscard]] Mueller<ScatteringPlane, ScatteringPlane> matrix() const;
};

/// Boundary between vacuum and a substrate, with layers between them, the first one on top.
/// Coherent neighbours interfere (Born & Wolf 1999, section 1.6); thick layers are summed over all
/// passes without interference, cross terms between s and p included, so that the matrix stays
/// physically realisable. Directions of fields: docs/conventions.md.
class Interface {
public:
  /// A bare boundary.
  explicit Interface(std::complex<double> substrate);
  /// With layers, the first on top, at one wavelength.
  Interface(std::complex<double> substrate, std::vector<OpticalLayer> layers,
            Wavelength wavelength);

  /// Reflection at an incidence whose cosine is in [0, 1].
  [[nodiscard]] MuellerEntries reflection(double cos_incidence) const;
  /// What enters the substrate (power, with both sides' obliquity) where no layer is thick; for a
  /// slab in vacuum use `slab_transmission`.
  [[nodiscard]] MuellerEntries transmission(double cos_incidence) const;
  /// Mean reflectance of diffuse light from outside, 2 int R mu dmu.
  [[nodiscard]] double mean_reflectance() const;
  /// True where nothing is there: n = 1 and no layer.
  [[nodiscard]] bool is_void() const;
  /// Index of the substrate.
  [[nodiscard]] std::complex<double> substrate() const { return substrate_; }

private:
  std::complex<double> substrate_;
  std::vector<OpticalLayer> layers_; ///< thickness in wavelengths
  bool has_thick_ = false;
};

/// A plane slab in vacuum, thick against the coherence length: sum over all passes with the
/// internal transmittance `tau` per pass. Clear (tau = 1): R = 2 R1/(1 + R1), T = (1 - R1)/(1 + R1)
/// for each polarization.
MuellerEntries slab_reflection(std::complex<double> eta, double cos_incidence, double tau);
/// What passes through such a slab.
MuellerEntries slab_transmission(std::complex<double> eta, double cos_incidence, double tau);

} // namespace umov
