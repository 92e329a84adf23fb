// A perfect mirror: it shows the image of the source, so the source must have a size.

#include "surface/distribution_models.h"

namespace umov {
namespace {

class MirrorNormals final : public Distribution {
public:
  double density(Vec3<Facet>) const override { return 0; }
  double masking(Vec3<Facet> k) const override { return k.z > 0 ? 1 : 0; }
  double width() const override { return 0; }
  double half_width_rad() const override { return 0; }
  double reach_rad() const override { return 0; }
  std::shared_ptr<const Distribution> scaled(double) const override {
    return std::make_shared<MirrorNormals>();
  }
  bool is_mirror() const override { return true; }
  double beyond(double cos_theta) const override { return cos_theta >= 1 ? 1 : 0; }
};

} // namespace

const DistributionModel &distribution_mirror() {
  static const DistributionModel model{
      "mirror",
      "perfectly smooth; needs the Sun's disk",
      {},
      false,
      [](const DistributionChoice &) -> std::shared_ptr<const Distribution> {
        return std::make_shared<MirrorNormals>();
      }};
  return model;
}

} // namespace umov
