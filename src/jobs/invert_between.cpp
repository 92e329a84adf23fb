#include "jobs/invert_between.h"

#include "jobs/invert_tables.h"
#include <umov/core/median.h>

#include <algorithm>
#include <fmt/format.h>
#include <umov/inverse/curve_model.h>
#include <utility>
#include <vector>

namespace umov::jobs {
namespace {

Result<const PoseLight *> whole_light(const SearchedLight &ready, const Scenario &scenario,
                                      const JobOptions &options, const Monitor &monitor) {
  WholeLight &whole = *ready.whole;
  const std::lock_guard lock(whole.making);
  if (!whole.light) {
    Scenario with = scenario;
    with.light.bounces = 3;
    SignatureRequest rough;
    rough.method = LightMethod::Rays;
    rough.accuracy = 0.1;
    rough.between = BetweenMethod::Paths; // of a dozen poses
    JobOptions by_processor = options;    // cards trace no rays
    by_processor.device = {};
    UMOV_ASSIGN(made, PoseLight::again(ready.light, with, rough, by_processor, monitor.cancel));
    whole.light.emplace(std::move(made));
  }
  return &*whole.light;
}

/// Some of the epochs, even over all.
std::vector<Pose> some_poses(const ObservedCurve &curve, const Turning &at) {
  constexpr std::size_t most = 12;
  const std::size_t count = std::min(curve.epochs.size(), most);
  std::vector<Pose> out;
  for (std::size_t k = 0; k < count; ++k)
    out.push_back(pose_at(at, curve.epochs[(2 * k + 1) * curve.epochs.size() / (2 * count)]));
  return out;
}

} // namespace

Result<double> share_between(const Scenario &scenario, const SearchedLight &ready,
                             const ObservedCurve &curve, const Turning &at,
                             const JobOptions &options, const Monitor &monitor) {
  if (ready.light.model().facts().is_convex)
    return 0.0;
  const std::vector<Pose> poses = some_poses(curve, at);
  LightTask task;
  task.threads = options.threads;
  task.cancel = monitor.cancel;
  StokesTable all, direct;
  bool is_lit = !monitor.is_cancelled() && ready.light.evaluate(poses, direct, task);
  if (ready.between) { // its table has these poses by now
    is_lit = is_lit && whole_lighting(ready, options.threads, monitor)(poses, all);
  } else {
    UMOV_ASSIGN(whole, whole_light(ready, scenario, options, monitor));
    is_lit = is_lit && whole->evaluate(poses, all, task);
  }
  if (!is_lit)
    return fail(ErrorCode::Interrupted, "stopped by the user; nothing was written");
  std::vector<double> shares;
  for (std::size_t k = 0; k < all.i.size(); ++k)
    if (all.i[k] > 0)
      shares.push_back(std::clamp(1 - direct.i[k] / all.i[k], 0.0, 1.0));
  if (shares.empty())
    return 0.0;
  return median_of(std::move(shares));
}

/// What light between surfaces may be without a word.
static double allowed_between(double floor) { return std::max(floor, 0.005); }

bool is_too_much_between(double share, double floor) {
  constexpr double much = 2.5; // as of what the best attitude misses
  return share > much * allowed_between(floor);
}

void doubt_direct_light(double share, double floor, std::string_view meaning, Verdict &verdict,
                        std::vector<std::string> &notes) {
  if (!(share > allowed_between(floor)))
    return;
  notes.push_back(fmt::format(
      "light from surface to surface, which this fit leaves out, would be {:.2g} of I in the best "
      "attitude (in the median): more than --floor {:.2g}, so {}; with render.bounces = 4 in the "
      "object's scenario it is in the fit",
      share, floor, meaning));
  if (is_too_much_between(share, floor) && verdict == Verdict::Determined)
    verdict = Verdict::Undetermined;
}

Result<void> judge_direct_light(const Scenario &scenario, const InvertRequest &request,
                                const SearchedLight &ready, const ObservedCurve &curve,
                                const PoseAnswer &answer, const JobOptions &options,
                                const Monitor &monitor, Judgement &out) {
  if (answer.modes.empty())
    return {};
  UMOV_ASSIGN(
      share, share_between(scenario, ready, curve, answer.modes.front().turning, options, monitor));
  out.light_between = share;
  out.is_between_fitted = ready.between.has_value();
  if (!out.is_between_fitted)
    doubt_direct_light(share, request.errors.floor,
                       out.verdict == Verdict::NoFit ? "that no attitude fits may be its doing"
                                                     : "the set may lie beside the truth",
                       out.verdict, out.notes);
  return {};
}

} // namespace umov::jobs
