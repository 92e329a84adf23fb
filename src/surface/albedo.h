#pragma once
// Private: what the specular lobe reflects in all, and the body lobe that takes the rest.

#include <complex>
#include <functional>
#include <vector>

namespace umov {

/// D G2 / 4 as a function of n.l, n.v, l.v and n.h. The last follows from the others, but not to
/// the 1/m that D needs near grazing.
using SpecularWeight = std::function<double(double, double, double, double)>;

/// Fraction of the light from a direction with cosine n_k that one reflection sends out; `eta` null
/// for F = 1 (white furnace). n_k in [0, 1]; the limit is taken at 0.
double directional_albedo(double n_k, double exponent, const std::complex<double> *eta,
                          const SpecularWeight &weight);

/// The paper's body lobe (Eq. 16 with its factor fixed by energy):
/// f_b = R_sub (1-R(l)) (1-R(v)) / (pi (1-Rbar)), R(k) the specular albedo, Rbar = 2 int R mu dmu.
class BodyTable {
public:
  BodyTable(double reflectance, double exponent, std::complex<double> eta,
            const SpecularWeight &weight);
  /// f_b (n.l)(n.v).
  [[nodiscard]] double operator()(double n_l, double n_v) const;

private:
  [[nodiscard]] double passed(double n_k) const; ///< 1 - R(k)

  double factor_;              ///< R_sub / (pi (1 - Rbar))
  std::vector<double> passed_; ///< 1 - R at equal steps of sqrt(n.k)
};

} // namespace umov
