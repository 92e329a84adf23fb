// Brushed and woven surfaces: D = sqrt((nu+2)(nv+2))/(2 pi) (h.n)^(nu cos^2 phi + nv sin^2 phi)
// (Ashikhmin & Shirley 2000); phi counts from the direction field.

#include "kernel/gauss.h"
#include "kernel/microfacet.inl.h"
#include "surface/distribution_models.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <umov/core/quantity.h>

namespace umov {
namespace {

constexpr std::size_t cosines = 128, azimuths = 24; ///< cells of the table of masking

class AshikhminShirley final : public Distribution {
public:
  AshikhminShirley(double nu, double nv) : nu_(nu), nv_(nv) {
    values_.resize((cosines + 1) * (azimuths + 1));
    for (std::size_t i = 0; i <= cosines; ++i)
      for (std::size_t j = 0; j <= azimuths; ++j)
        values_[i * (azimuths + 1) + j] = projected_area(
            cosine_of(static_cast<double>(i)), pi / 2 * static_cast<double>(j) / azimuths);
  }

  double density(Vec3<Facet> h) const override {
    if (!(h.z > 0))
      return 0;
    return kernel::ashikhmin_shirley(std::min(h.z, 1.0), h.x * h.x, h.y * h.y, nu_, nv_);
  }
  double masking(Vec3<Facet> k) const override {
    if (!(k.z > 0))
      return 0;
    const double across = std::hypot(k.x, k.y);
    if (!(across > 0) || k.z >= 1)
      return std::min(1.0, k.z / values_.back());
    const double azimuth = std::atan2(std::abs(k.y), std::abs(k.x));
    return std::min(1.0, k.z / table(std::sqrt(k.z) * cosines, azimuth / (pi / 2) * azimuths));
  }
  double width() const override { return 1 / std::sqrt(std::max(nu_, nv_) + 2); }
  double half_width_rad() const override {
    const double m = std::min(nu_, nv_);
    return m > 0 ? std::acos(std::exp2(-1 / m)) : pi / 2;
  }
  double reach_rad() const override {
    return std::min(pi / 2, 9 / std::sqrt(std::min(nu_, nv_) + 2));
  }
  std::shared_ptr<const Distribution> scaled(double factor) const override {
    const double f = factor * factor;
    return std::make_shared<AshikhminShirley>(std::max(0.0, (nu_ + 2) / f - 2),
                                              std::max(0.0, (nv_ + 2) / f - 2));
  }
  bool is_isotropic() const override { return false; }
  double beyond(double) const override { return 0; }

private:
  /// Table in sqrt(n.k): g bends near grazing.
  static double cosine_of(double cell) { return (cell / cosines) * (cell / cosines); }

  /// int D max(h.k, 0) dw over (theta, phi); the azimuth by the trapezoid rule, exact for periods.
  [[nodiscard]] double projected_area(double n_k, double azimuth) const {
    const double sine = std::sqrt((1 - n_k) * (1 + n_k));
    constexpr int steps = 128;
    const double last = reach_rad();
    double sum = 0;
    for (int i = 0; i < steps; ++i) {
      const double phi = 2 * pi * (i + 0.5) / steps;
      const double c = std::cos(phi), s = std::sin(phi);
      const double m = nu_ * c * c + nv_ * s * s;
      const double along = sine * std::cos(phi - azimuth);
      // h.k = n_k cos + along sin > 0 up to an angle where it is cut.
      const double cut = along < 0 ? std::atan2(n_k, -along) : pi / 2;
      const double end = std::min({last, cut, 9 / std::sqrt(m + 2)});
      sum += gauss_integral<24>(0, end, [&](double theta) {
        const double ct = std::cos(theta), st = std::sin(theta);
        return kernel::power(ct, m) * st * (n_k * ct + along * st);
      });
    }
    return sum * 2 * pi / steps * std::sqrt((nu_ + 2) * (nv_ + 2)) / (2 * pi);
  }

  /// Cubic in both coordinates.
  [[nodiscard]] double table(double x, double y) const {
    const auto i = std::clamp<std::size_t>(static_cast<std::size_t>(x), 1, cosines - 2);
    const auto j = std::clamp<std::size_t>(static_cast<std::size_t>(y), 1, azimuths - 2);
    double rows[4];
    for (std::size_t k = 0; k < 4; ++k)
      rows[k] =
          kernel::cubic(&values_[(i - 1 + k) * (azimuths + 1) + j - 1], y - static_cast<double>(j));
    return kernel::cubic(rows, x - static_cast<double>(i));
  }

  double nu_, nv_;
  std::vector<double> values_;
};

} // namespace

const DistributionModel &distribution_ashikhmin_shirley() {
  static const DistributionModel model{
      "ashikhmin_shirley",
      "two exponents: brushed or woven surfaces",
      {{"nu", "exponent along the direction field", 0, 1e6}, {"nv", "exponent across it", 0, 1e6}},
      false,
      [](const DistributionChoice &c) -> std::shared_ptr<const Distribution> {
        return std::make_shared<AshikhminShirley>(c.parameters.at("nu"), c.parameters.at("nv"));
      }};
  return model;
}

} // namespace umov
