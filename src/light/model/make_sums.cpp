#include "light/fast/cards.h"
#include "light/model/models.h"

#include <umov/light/light_sums.h>

namespace umov {
namespace {

EngineOptions engine_options(const Scene &scene, const SumsOptions &options,
                             const std::atomic<bool> *cancel) {
  EngineOptions out;
  if (options.accuracy)
    out.masks = masks_for(*options.accuracy);
  else if (options.accuracy_floor > 0)
    for (const double light : typical_light(scene, cancel))
      out.floor_i.push_back(options.accuracy_floor * light);
  out.is_for_many_poses = options.is_for_many_poses;
  out.hypotheses = options.hypotheses;
  out.is_lazy = true; // whoever asks for few directions waits for few
  out.mask_cache = options.mask_cache;
  out.threads = options.threads;
  return out;
}

class EngineSums final : public LightSums {
public:
  EngineSums(const Scene &scene, const SumsOptions &options, const std::atomic<bool> *cancel)
      : engine_(scene, engine_options(scene, options, cancel), cancel) {}
  Result<void> take_device(const DeviceOptions &device) {
    UMOV_ASSIGN(taken, take_cards(engine_, device));
    device_ = std::move(taken);
    return {};
  }

  Result<void> evaluate(std::span<const Pose> poses, AbundanceTable &out, unsigned threads,
                        const std::atomic<bool> *cancel) const override {
    return engine_.abundances(poses, out, threads, cancel);
  }
  [[nodiscard]] Result<MaterialTables> tables_for(const Scene &materials) const override {
    return engine_.tables_for(materials);
  }
  void keep_masks() const override { engine_.keep_masks(); }
  void take_masks_of(const LightModel &elder) const override {
    const auto *const other = dynamic_cast<const MasksLight *>(&elder);
    if (other != nullptr && other->engine() != nullptr)
      engine_.take_masks_of(*other->engine());
  }
  [[nodiscard]] std::string device() const override { return device_now(engine_, device_); }
  [[nodiscard]] std::string lit_by() const override { return engine_.lit_by(); }

private:
  Engine engine_;
  std::string device_;
};

} // namespace

Result<std::unique_ptr<LightSums>> make_sums(const Scene &scene, const SumsOptions &options,
                                             const std::atomic<bool> *cancel) {
  return without_failures([&]() -> Result<std::unique_ptr<LightSums>> {
    auto out = std::make_unique<EngineSums>(scene, options, cancel);
    UMOV_TRY(out->take_device(options.device));
    return out;
  });
}

} // namespace umov
