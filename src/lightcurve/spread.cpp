#include <umov/lightcurve/light_curve.h>

#include <algorithm>

namespace umov {
namespace {

void take(SampleSpread &spread, const LightCurveSample &sample) {
  spread.intensity.take(sample.intensity);
  spread.magnitude.take(sample.magnitude);
  spread.p.take(sample.p);
}

} // namespace

void widen_spread(LightCurve &curve, const LightCurve &other) {
  if (curve.spread.empty()) {
    curve.spread.resize(curve.samples.size());
    for (std::size_t k = 0; k < curve.samples.size(); ++k)
      take(curve.spread[k], curve.samples[k]);
  }
  const std::size_t reached = std::min(curve.samples.size(), other.samples.size());
  for (std::size_t k = 0; k < reached; ++k)
    take(curve.spread[k], other.samples[k]);
  std::fill(curve.spread.begin() + static_cast<std::ptrdiff_t>(reached), curve.spread.end(),
            SampleSpread{});
}

} // namespace umov
