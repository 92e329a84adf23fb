#include <umov/light/engine_audit.h>

#include <algorithm>
#include <cmath>

namespace umov {
namespace {

double quantile(std::vector<double> &sorted, double share) {
  if (sorted.empty())
    return 0;
  const auto at = static_cast<std::size_t>(share * static_cast<double>(sorted.size()));
  return sorted[std::min(at, sorted.size() - 1)];
}

} // namespace

EngineErrors compare_with_reference(const StokesTable &fast,
                                    const std::vector<PoseResult> &reference, std::size_t band) {
  EngineErrors out;
  std::vector<double> light;
  for (const PoseResult &r : reference)
    if (!r.is_dark)
      light.push_back(r.bands[band].stokes.i);
  std::sort(light.begin(), light.end());
  const double median = quantile(light, 0.5);
  std::vector<double> i, q, estimate;
  std::size_t lit = 0, covered = 0;
  for (std::size_t k = 0; k < reference.size(); ++k) {
    const BandResult &wanted = reference[k].bands[band], found = fast.at(k, band);
    if (reference[k].is_dark && fast.is_dark[k] != 0)
      continue;
    const double apart = std::abs(found.stokes.i - wanted.stokes.i);
    ++lit;
    covered += apart <= found.half_width.i + wanted.half_width.i ? 1u : 0u;
    if (!(wanted.stokes.i > 0))
      continue;
    out.outliers.push_back({k, apart / wanted.stokes.i, found.half_width.i / wanted.stokes.i,
                            median > 0 ? wanted.stokes.i / median : 0});
    if (!(wanted.stokes.i > EngineErrors::dim * median))
      continue;
    i.push_back(apart / wanted.stokes.i);
    q.push_back(found.stokes.i > 0
                    ? std::abs(found.stokes.q / found.stokes.i - wanted.stokes.q / wanted.stokes.i)
                    : 1);
    estimate.push_back(found.half_width.i / wanted.stokes.i);
  }
  for (auto *list : {&i, &q, &estimate})
    std::sort(list->begin(), list->end());
  std::sort(out.outliers.begin(), out.outliers.end(),
            [](const EngineOutlier &a, const EngineOutlier &b) { return a.error > b.error; });
  out.outliers.resize(std::min<std::size_t>(out.outliers.size(), 5));
  out.poses = i.size();
  out.i_median = quantile(i, 0.5);
  out.i_p90 = quantile(i, 0.90);
  out.i_p95 = quantile(i, 0.95);
  out.i_max = quantile(i, 1);
  out.q_median = quantile(q, 0.5);
  out.q_p95 = quantile(q, 0.95);
  out.q_max = quantile(q, 1);
  out.covered = lit > 0 ? static_cast<double>(covered) / static_cast<double>(lit) : 1;
  out.estimate_median = quantile(estimate, 0.5);
  return out;
}

} // namespace umov
