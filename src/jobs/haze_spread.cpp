#include "jobs/haze_spread.h"

#include "jobs/wanted_passes.h"

#include <algorithm>
#include <fmt/format.h>

namespace umov::jobs {
namespace {

bool has_range(const Material &material) { return material.haze && material.haze->high > 0; }

Material at_end(Material material, bool is_high) {
  if (has_range(material))
    material.haze->share = is_high ? material.haze->high : material.haze->low;
  return material;
}

bool has_any_range(const Scene &scene) {
  const auto states = [](const Surface &surface) { return has_range(surface.material()); };
  return std::ranges::any_of(scene.front, states) || std::ranges::any_of(scene.back, states);
}

} // namespace

Result<void> add_haze_spread(ObjectRun &one, KeptBlocks blocks, const Monitor &monitor,
                             Diagnostics &diagnostics) {
  const Scene &scene = one.object.scene;
  if (!has_any_range(scene)) {
    diagnostics.warn(fmt::format("[materials] vary: no material of {} states a range of its haze. "
                                 "Those of the library do (umov material list); of your own: "
                                 "haze = {{ share = 0.02, range = [0.01, 0.05] }}.",
                                 one.request.object));
    return {};
  }
  for (const bool is_high : {false, true}) {
    UMOV_ASSIGN(varied,
                with_materials(scene, [is_high](const Material &material, const std::string &) {
                  return at_end(material, is_high);
                }));
    UMOV_ASSIGN(models, make_light_models(one.request, varied, monitor.cancel));
    KeptBlocks kept = blocks; // parts of their own beside those of the objects
    kept.part |= std::uint64_t{is_high ? 2u : 1u} << 32;
    const std::string what = std::string("haze at its ") + (is_high ? "most" : "least");
    UMOV_ASSIGN(
        other, compute_wanted(
                   one, models,
                   [&](std::size_t done, std::size_t total) { monitor.advance(what, done, total); },
                   monitor.cancel_flag(), kept));
    widen_spread(one.outcome.curve, other.curve);
    if (other.stopped) {
      one.outcome.stopped = other.stopped;
      return {};
    }
  }
  return {};
}

MagnitudeSpread magnitude_spread(const LightCurve &curve) {
  std::vector<double> widths;
  for (std::size_t k = 0; k < curve.spread.size(); ++k) {
    const Extent &magnitude = curve.spread[k].magnitude;
    if (magnitude.low <= magnitude.high && !has_magnitude_limit(curve.samples[k]))
      widths.push_back(magnitude.high - magnitude.low);
  }
  MagnitudeSpread out;
  out.samples = widths.size();
  if (widths.empty())
    return out;
  std::ranges::sort(widths);
  out.median = widths[widths.size() / 2];
  out.most = widths.back();
  return out;
}

std::string describe_spread(const LightCurve &curve) {
  const MagnitudeSpread spread = magnitude_spread(curve);
  if (spread.samples == 0)
    return "";
  return fmt::format("  over the ranges of haze: magnitudes change by {:.2f} in the median, by "
                     "{:.2f} at most\n",
                     spread.median, spread.most);
}

} // namespace umov::jobs
