#pragma once
// Distributions of microfacet normals.

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <umov/core/result.h>
#include <umov/core/vec3.h>
#include <umov/kernel/lobe.h>
#include <vector>

namespace umov {

/// Which distribution, and its numbers, as a user names them.
struct DistributionChoice {
  std::string model = "blinn_phong";
  std::map<std::string, double> parameters{{"m", 200}};
  std::vector<double> angle_deg, density; ///< of the model "table": from 0, increasing, to 90 deg
  std::string file = {};                  ///< where they come from
  bool operator==(const DistributionChoice &) const = default;
};
/// Blinn-Phong with exponent m.
DistributionChoice blinn_phong(double m);

/// A distribution that the facet kernels know (src/kernel/facet.inl.h), with its one number.
struct KernelForm {
  LobeKind kind;
  double shape; ///< m of Blinn-Phong, alpha of the others
};

/// Density of normals D(h) [1/sr] and its exact masking, in the frame Facet: z the normal, x the
/// direction field (brushing, weave) made perpendicular to it, y = z cross x. D is facet area per
/// macroscopic area and solid angle: int D (h.n) dw = 1 (Walter et al. 2007). Pure and thread safe.
class Distribution {
public:
  Distribution() = default;
  Distribution(const Distribution &) = delete;
  Distribution &operator=(const Distribution &) = delete;
  virtual ~Distribution() = default;

  /// D(h) for a unit vector; 0 below the horizon.
  [[nodiscard]] virtual double density(Vec3<Facet> h) const = 0;
  /// P(k), the visible share of the projected area in a direction above the horizon: (n.k) over
  /// int D max(h.k, 0) dw (Smith's G1 of the same D).
  [[nodiscard]] virtual double masking(Vec3<Facet> k) const = 0;
  /// Standard deviation of the slope along the narrowest axis: how finely normals must be sampled.
  [[nodiscard]] virtual double width() const = 0;
  /// Angle from the normal at which D falls to one half [rad].
  [[nodiscard]] virtual double half_width_rad() const = 0;
  /// Angle beyond which D counts for nothing [rad].
  [[nodiscard]] virtual double reach_rad() const = 0;
  /// The same distribution with all slopes multiplied by a factor.
  [[nodiscard]] virtual std::shared_ptr<const Distribution> scaled(double factor) const = 0;
  /// D depends on the angle to the normal alone.
  [[nodiscard]] virtual bool is_isotropic() const { return true; }
  /// A perfect mirror: density is 0 everywhere and only `beyond` tells of it.
  [[nodiscard]] virtual bool is_mirror() const { return false; }
  /// int of D sin(theta) dtheta from theta to 90 deg, times 2 pi: for isotropic ones.
  [[nodiscard]] virtual double beyond(double cos_theta) const = 0;
  /// Which of the forms that the facet kernels know it is; empty: they call `density` facet by
  /// facet, which is slower.
  [[nodiscard]] virtual std::optional<KernelForm> kernel_form() const { return {}; }
};

/// A number that a model takes.
struct DistributionParameter {
  const char *name, *text;
  double low, high;
};

/// One file of src/surface/distributions: everything that the program knows of a model.
struct DistributionModel {
  const char *name, *text;
  std::vector<DistributionParameter> parameters;
  bool takes_table = false;
  std::shared_ptr<const Distribution> (*make)(const DistributionChoice &);
};

/// All models, in alphabetical order.
const std::vector<const DistributionModel *> &distribution_models();
/// BadInput for an unknown model, a missing, unknown or impossible number, or a table that is none.
Result<std::shared_ptr<const Distribution>> make_distribution(const DistributionChoice &choice);

} // namespace umov
