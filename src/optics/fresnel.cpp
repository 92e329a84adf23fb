#include <umov/optics/fresnel.h>

#include "kernel/fresnel.inl.h"

namespace umov {
namespace {

kernel::Amplitudes<double> amplitudes(double c, std::complex<double> eta) {
  return kernel::fresnel(c, kernel::Complex<double>{eta.real(), eta.imag()});
}

} // namespace

FresnelAmplitudes fresnel_amplitudes(double cos_incidence, std::complex<double> eta) {
  const auto r = amplitudes(cos_incidence, eta);
  return {{r.s.re, r.s.im}, {r.p.re, r.p.im}};
}

Mueller<ScatteringPlane, ScatteringPlane> fresnel_mueller(double cos_incidence,
                                                          std::complex<double> eta) {
  const auto f = kernel::reflection(amplitudes(cos_incidence, eta));
  return {{{{f.a, f.b, 0, 0}, {f.b, f.a, 0, 0}, {0, 0, f.z.re, -f.z.im}, {0, 0, f.z.im, f.z.re}}}};
}

} // namespace umov
