#pragma once
#include <complex>
#include <umov/optics/stokes.h>

namespace umov {

/// Amplitude reflection coefficients; with exp(-i omega t) and (s, p, k) right-handed in both
/// beams.
struct FresnelAmplitudes {
  std::complex<double> s, p;
};

/// Reflection from vacuum onto eta = n + ik (n > 0, k >= 0) at an incidence with cosine in [0, 1]:
/// r_s = (c - q)/(c + q), r_p = (eta^2 c - q)/(eta^2 c + q), q = sqrt(eta^2 - 1 + c^2)
/// (Born & Wolf 1999, section 1.5). The paper's Eqs. 1 and 18 have r_s with the other sign, which
/// belongs to other field directions; intensities agree.
FresnelAmplitudes fresnel_amplitudes(double cos_incidence, std::complex<double> eta);

/// Mueller matrix of that reflection, both Stokes vectors referred to the s axis.
Mueller<ScatteringPlane, ScatteringPlane> fresnel_mueller(double cos_incidence,
                                                          std::complex<double> eta);

} // namespace umov
