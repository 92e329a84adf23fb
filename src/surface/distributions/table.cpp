// Normals as measured: D against the angle from the normal, linear in between.

#include "kernel/gauss.h"
#include "surface/distribution_models.h"
#include "surface/masking.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <umov/core/quantity.h>

namespace umov {
namespace {

/// Piecewise linear in theta, rescaled so that int D cos dw = 1.
class Curve {
public:
  Curve(const std::vector<double> &angle_rad, const std::vector<double> &density)
      : angle_(angle_rad), density_(density) {
    const double whole = integral(0, pi / 2, [](double theta) { return std::cos(theta); });
    for (double &d : density_)
      d /= whole;
  }
  [[nodiscard]] double operator()(double theta) const {
    if (theta >= angle_.back())
      return theta > angle_.back() ? 0 : density_.back();
    const auto next = std::upper_bound(angle_.begin() + 1, angle_.end() - 1, theta);
    const auto i = static_cast<std::size_t>(next - angle_.begin());
    const double t = (theta - angle_[i - 1]) / (angle_[i] - angle_[i - 1]);
    return (1 - t) * density_[i - 1] + t * density_[i];
  }
  /// 2 pi int of D sin(theta) weight(theta) between two angles, panel by panel.
  template <class F> [[nodiscard]] double integral(double from, double to, F weight) const {
    double sum = 0;
    for (std::size_t i = 1; i < angle_.size(); ++i) {
      const double a = std::max(from, angle_[i - 1]), b = std::min(to, angle_[i]);
      if (b > a)
        sum += gauss_integral<12>(
            a, b, [&](double theta) { return (*this)(theta)*std::sin(theta) * weight(theta); });
    }
    return 2 * pi * sum;
  }
  [[nodiscard]] const std::vector<double> &angles() const { return angle_; }
  [[nodiscard]] const std::vector<double> &densities() const { return density_; }

private:
  std::vector<double> angle_, density_;
};

std::vector<double> radians(const std::vector<double> &degrees) {
  std::vector<double> out;
  for (const double d : degrees)
    out.push_back(d * pi / 180);
  return out;
}

class TabulatedNormals final : public Distribution {
public:
  TabulatedNormals(const std::vector<double> &angle_rad, const std::vector<double> &density)
      : curve_(angle_rad, density),
        masking_([this](double c) { return curve_(std::acos(c)); }, curve_.angles().back()) {
    // Per-axis variance of the slope, with tan cut where it would run away.
    const double second = curve_.integral(0, 1.4, [](double theta) {
      const double t = std::tan(theta);
      return 0.5 * t * t * std::cos(theta);
    });
    // A table that is all noise at its foot must not look wide: never wider than its half width.
    width_ = std::min(std::sqrt(second), half_width_rad());
  }

  double density(Vec3<Facet> h) const override {
    return h.z > 0 ? curve_(std::acos(std::min(h.z, 1.0))) : 0;
  }
  double masking(Vec3<Facet> k) const override { return masking_(std::clamp(k.z, 0.0, 1.0)); }
  double width() const override { return width_; }
  double half_width_rad() const override {
    const double half = curve_(0) / 2;
    double theta = 0;
    while (theta < pi / 2 && curve_(theta) > half)
      theta += 1e-4;
    return theta;
  }
  double reach_rad() const override { return curve_.angles().back(); }
  std::shared_ptr<const Distribution> scaled(double factor) const override {
    std::vector<double> angle = curve_.angles(), density = curve_.densities();
    for (std::size_t i = 0; i < angle.size(); ++i) {
      // Density of slopes D cos^4 keeps its shape; the normalisation follows in the constructor.
      const double old = std::cos(angle[i]);
      angle[i] = angle[i] >= pi / 2 ? pi / 2 : std::atan(factor * std::tan(angle[i]));
      const double now = std::max(std::cos(angle[i]), 1e-9);
      density[i] *= angle[i] >= pi / 2 ? 1 : std::pow(old / now, 4);
    }
    return std::make_shared<TabulatedNormals>(angle, density);
  }
  double beyond(double cos_theta) const override {
    return curve_.integral(std::acos(std::clamp(cos_theta, 0.0, 1.0)), pi / 2,
                           [](double) { return 1.0; });
  }

private:
  Curve curve_;
  Masking masking_;
  double width_ = 0;
};

} // namespace

const DistributionModel &distribution_table() {
  static const DistributionModel model{
      "table",
      "density of normals against their angle, from a file",
      {},
      true,
      [](const DistributionChoice &c) -> std::shared_ptr<const Distribution> {
        return std::make_shared<TabulatedNormals>(radians(c.angle_deg), c.density);
      }};
  return model;
}

} // namespace umov
