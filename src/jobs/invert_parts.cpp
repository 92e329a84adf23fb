#include "jobs/invert_parts.h"

#include "jobs/counts_in_sequence.h"

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

} // namespace

std::vector<DataPart> parts_of(const ObservedCurve &curve, bool has_polarization) {
  std::vector<DataPart> out;
  const std::size_t bands = curve.bands.size();
  // What is reduced from analysers that follow each other is of a body that stood still meanwhile.
  const bool is_in_sequence = !counts_in_sequence(curve).empty();
  for (std::size_t k = 0; k <= (bands > 1 ? bands : 0); ++k) {
    const std::size_t band = k == 0 ? bands : k - 1;
    const ObservedCurve all = part(curve, band, true);
    if (std::ranges::none_of(all.samples, [](const ObservedSample &s) { return s.i > 0; }))
      continue;
    const std::string name = k == 0 ? "all" : curve.bands[band];
    if (has_polarization &&
        std::ranges::any_of(all.samples, [](const ObservedSample &s) { return !std::isnan(s.q); }))
      out.push_back({name, "I,q,u", all});
    if (!is_in_sequence)
      out.push_back({name, "I", part(curve, band, false)});
  }
  return out;
}

} // namespace umov::jobs
