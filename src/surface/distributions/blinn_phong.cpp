// The paper's distribution: D = (m+2)/(2 pi) (h.n)^m (Blinn 1977, normalised as in Walter 2007).

#include "kernel/microfacet.inl.h"
#include "surface/distribution_models.h"
#include "surface/masking.h"

#include <cmath>
#include <numbers>
#include <umov/core/quantity.h>

namespace umov {
namespace {

class BlinnPhong final : public Distribution {
public:
  explicit BlinnPhong(double m)
      : m_(m), masking_([m](double c) { return kernel::blinn_phong(c, m); }, reach(m)) {}

  double density(Vec3<Facet> h) const override {
    return h.z > 0 ? kernel::blinn_phong(std::min(h.z, 1.0), m_) : 0;
  }
  double masking(Vec3<Facet> k) const override { return masking_(std::clamp(k.z, 0.0, 1.0)); }
  double width() const override { return 1 / std::sqrt(m_ + 2); }
  double half_width_rad() const override { return m_ > 0 ? std::acos(std::exp2(-1 / m_)) : pi / 2; }
  double reach_rad() const override { return reach(m_); }
  std::shared_ptr<const Distribution> scaled(double factor) const override {
    return std::make_shared<BlinnPhong>(std::max(0.0, (m_ + 2) / (factor * factor) - 2));
  }
  double beyond(double cos_theta) const override {
    return (m_ + 2) / (m_ + 1) * kernel::power(std::clamp(cos_theta, 0.0, 1.0), m_ + 1);
  }
  std::optional<KernelForm> kernel_form() const override {
    return KernelForm{LobeKind::BlinnPhong, m_};
  }

private:
  /// Nine standard deviations of the slope: no facet is turned further, to the last bit.
  static double reach(double m) { return std::min(pi / 2, 9 / std::sqrt(m + 2)); }
  double m_;
  Masking masking_;
};

} // namespace

const DistributionModel &distribution_blinn_phong() {
  static const DistributionModel model{
      "blinn_phong",
      "(h.n)^m: the paper's",
      {{"m", "exponent; the slope has a standard deviation of 1/sqrt(m + 2)", 0, 1e9}},
      false,
      [](const DistributionChoice &c) -> std::shared_ptr<const Distribution> {
        return std::make_shared<BlinnPhong>(c.parameters.at("m"));
      }};
  return model;
}

} // namespace umov
