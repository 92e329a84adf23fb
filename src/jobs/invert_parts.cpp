#include "jobs/invert_parts.h"

#include <algorithm>
#include <cmath>

namespace umov::jobs {
namespace {

/// One band, or all for their number.
ObservedCurve part(const ObservedCurve &curve, std::size_t band, bool has_polarization) {
  ObservedCurve out = curve;
  const auto is_other = [&](const auto &one) {
    return band < curve.bands.size() && one.band != band;
  };
  std::erase_if(out.samples, is_other);
  std::erase_if(out.counts, is_other);
  if (!has_polarization) {
    out.counts.clear(); // no analyser tells I alone
    for (ObservedSample &s : out.samples)
      s.q = s.u = std::nan("");
  }
  return out;
}

/// Analysers follow each other: what was reduced from them is of a body that stood still meanwhile.
bool is_in_sequence(const ObservedCurve &curve) {
  std::size_t exposures = 0; // counts stand in order of epochs and bands
  for (std::size_t k = 0; k < curve.counts.size(); ++k) {
    const ObservedCount &b = curve.counts[k], &a = curve.counts[k == 0 ? 0 : k - 1];
    exposures += k == 0 || a.epoch != b.epoch || a.band != b.band ? 1u : 0u;
  }
  return exposures > curve.samples.size();
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
    if (!is_in_sequence(curve))
      out.push_back({name, "I", part(curve, band, false)});
  }
  return out;
}

} // namespace umov::jobs
