#include <umov/light/engine.h>
#include <umov/light/light_sums.h>

namespace umov {
namespace {

EngineOptions engine_options(const SumsOptions &options) {
  EngineOptions out;
  if (options.accuracy)
    out.masks = masks_for(*options.accuracy);
  out.hypotheses = options.hypotheses;
  out.is_lazy = true; // whoever asks for few directions waits for few
  out.mask_cache = options.mask_cache;
  out.threads = options.threads;
  return out;
}

class EngineSums final : public LightSums {
public:
  EngineSums(const Scene &scene, const SumsOptions &options)
      : engine_(scene, engine_options(options)) {}

  Result<void> evaluate(std::span<const Pose> poses, AbundanceTable &out,
                        unsigned threads) const override {
    return engine_.abundances(poses, out, threads);
  }
  [[nodiscard]] Result<MaterialTables> tables_for(const Scene &materials) const override {
    return engine_.tables_for(materials);
  }
  void keep_masks() const override { engine_.keep_masks(); }

private:
  Engine engine_;
};

} // namespace

std::unique_ptr<LightSums> make_sums(const Scene &scene, const SumsOptions &options) {
  return std::make_unique<EngineSums>(scene, options);
}

} // namespace umov
