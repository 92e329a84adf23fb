// Normal (Gaussian) slopes (Beckmann & Spizzichino 1963; Walter et al. 2007).

#include "kernel/microfacet.inl.h"
#include "surface/distribution_models.h"

#include <cmath>
#include <numbers>

namespace umov {
namespace {

class Beckmann final : public Distribution {
public:
  explicit Beckmann(double alpha) : alpha_(alpha) {}

  double density(Vec3<Facet> h) const override {
    return h.z > 0 ? kernel::beckmann(std::min(h.z, 1.0), alpha_) : 0;
  }
  double masking(Vec3<Facet> k) const override {
    return k.z > 0 ? kernel::beckmann_masking(std::min(k.z, 1.0), alpha_) : 0;
  }
  double width() const override { return alpha_ / std::numbers::sqrt2; }
  double half_width_rad() const override {
    // exp(-t2/a2) (1 + t2)^2 = 1/2 for t = tan(theta), by bisection; exists below a about 0.8.
    double low = 0, high = std::numbers::pi / 2;
    for (int i = 0; i < 60; ++i) {
      const double middle = (low + high) / 2;
      const double ratio =
          kernel::beckmann(std::cos(middle), alpha_) / kernel::beckmann(1.0, alpha_);
      (ratio > 0.5 ? low : high) = middle;
    }
    return low;
  }
  double reach_rad() const override { return std::atan(7 * alpha_); } // exp(-49)
  std::shared_ptr<const Distribution> scaled(double factor) const override {
    return std::make_shared<Beckmann>(alpha_ * factor);
  }
  double beyond(double cos_theta) const override {
    // int of 2 t exp(-t2/a2)/(a2 cos) dt: numerically, as sqrt(1 + t2) leaves no elementary form.
    return kernel::beckmann_beyond(std::clamp(cos_theta, 0.0, 1.0), alpha_);
  }
  std::optional<KernelForm> kernel_form() const override {
    return KernelForm{LobeKind::Beckmann, alpha_};
  }

private:
  double alpha_;
};

} // namespace

const DistributionModel &distribution_beckmann() {
  static const DistributionModel model{
      "beckmann",
      "normal slopes, exp(-tan^2/alpha^2)",
      {{"alpha", "roughness; the slope has a standard deviation of alpha/sqrt(2)", 1e-5, 4}},
      false,
      [](const DistributionChoice &c) -> std::shared_ptr<const Distribution> {
        return std::make_shared<Beckmann>(c.parameters.at("alpha"));
      }};
  return model;
}

} // namespace umov
