// Long tails: GGX (Trowbridge & Reitz 1975; Walter et al. 2007).

#include "kernel/microfacet.inl.h"
#include "surface/distribution_models.h"

#include <cmath>
#include <numbers>

namespace umov {
namespace {

class Ggx final : public Distribution {
public:
  explicit Ggx(double alpha) : alpha_(alpha) {}

  double density(Vec3<Facet> h) const override {
    return h.z > 0 ? kernel::ggx(std::min(h.z, 1.0), alpha_) : 0;
  }
  double masking(Vec3<Facet> k) const override {
    return k.z > 0 ? kernel::ggx_masking(std::min(k.z, 1.0), alpha_) : 0;
  }
  /// Its variance is infinite: that of the core, as a Beckmann of the same alpha has.
  double width() const override { return alpha_ / std::numbers::sqrt2; }
  double half_width_rad() const override {
    // (cos^2 (a2 - 1) + 1)^2 = 2 a4.
    const double a2 = alpha_ * alpha_;
    const double c2 = a2 == 1 ? 0 : (std::numbers::sqrt2 * a2 - 1) / (a2 - 1);
    return c2 > 0 && c2 < 1 ? std::acos(std::sqrt(c2)) : std::numbers::pi / 2;
  }
  double reach_rad() const override { return std::numbers::pi / 2; }
  std::shared_ptr<const Distribution> scaled(double factor) const override {
    return std::make_shared<Ggx>(alpha_ * factor);
  }
  double beyond(double cos_theta) const override {
    return kernel::ggx_beyond(std::clamp(cos_theta, 0.0, 1.0), alpha_);
  }
  std::optional<KernelForm> kernel_form() const override {
    return KernelForm{LobeKind::Ggx, alpha_};
  }

private:
  double alpha_;
};

} // namespace

const DistributionModel &distribution_ggx() {
  static const DistributionModel model{
      "ggx",
      "long tails (Trowbridge-Reitz)",
      {{"alpha", "roughness: slope at which the density of slopes falls to a quarter", 1e-5, 4}},
      false,
      [](const DistributionChoice &c) -> std::shared_ptr<const Distribution> {
        return std::make_shared<Ggx>(c.parameters.at("alpha"));
      }};
  return model;
}

} // namespace umov
