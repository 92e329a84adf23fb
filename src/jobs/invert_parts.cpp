#include "jobs/invert_parts.h"

#include <algorithm>
#include <cmath>

namespace umov::jobs {
namespace {

/// One band, or all for their number.
ObservedCurve part(const ObservedCurve &curve, std::size_t band, bool has_polarization) {
  ObservedCurve out = curve;
  out.counts.clear(); // parts are fitted to what was reduced
  std::erase_if(out.samples, [&](const ObservedSample &s) {
    return band < curve.bands.size() && s.band != band;
  });
  if (!has_polarization)
    for (ObservedSample &s : out.samples)
      s.q = s.u = std::nan("");
  return out;
}

} // namespace

std::vector<DataPart> parts_of(const ObservedCurve &curve, bool has_polarization) {
  std::vector<DataPart> out;
  const std::size_t bands = curve.bands.size();
  for (std::size_t k = 0; k <= (bands > 1 ? bands : 0); ++k) {
    const std::size_t band = k == 0 ? bands : k - 1;
    const ObservedCurve all = part(curve, band, true);
    if (std::ranges::none_of(all.samples, [](const ObservedSample &s) { return s.i > 0; }))
      continue;
    const std::string name = k == 0 ? "all" : curve.bands[band];
    if (has_polarization &&
        std::ranges::any_of(all.samples, [](const ObservedSample &s) { return !std::isnan(s.q); }))
      out.push_back({name, "I,q,u", all});
    out.push_back({name, "I", part(curve, band, false)});
  }
  return out;
}

} // namespace umov::jobs
