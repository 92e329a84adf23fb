#include <umov/jobs/passes.h>

#include "jobs/pass_searcher.h"
#include "jobs/standing.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <umov/core/files.h>
#include <umov/core/locks.h>
#include <umov/core/parallel.h>
#include <umov/core/text.h>
#include <umov/io/elements_file.h>
#include <umov/io/trajectory_file.h>
#include <umov/orbit/select.h>
#include <umov/time/earth_orientation.h>

namespace umov::jobs {
namespace {

constexpr double doubtful_days = 7, old_days = 30; ///< ages of elements
constexpr double span_days_max = 36525;            ///< a year mistyped, not a search

/// Of each object wanted, its best set for the span's begin.
Result<std::vector<ElementSet>> best_sets(const PassesRequest &request,
                                          std::vector<ElementSet> sets) {
  std::vector<int> wanted = request.norad;
  if (wanted.empty())
    for (const ElementSet &set : sets)
      wanted.push_back(set.norad_cat_id);
  std::sort(wanted.begin(), wanted.end());
  wanted.erase(std::unique(wanted.begin(), wanted.end()), wanted.end());
  // By number, so that each object is chosen from its own sets.
  std::stable_sort(sets.begin(), sets.end(), [](const ElementSet &a, const ElementSet &b) {
    return a.norad_cat_id < b.norad_cat_id;
  });
  std::vector<ElementSet> out;
  for (const int norad : wanted) {
    const auto first =
        std::partition_point(sets.begin(), sets.end(),
                             [norad](const ElementSet &set) { return set.norad_cat_id < norad; });
    const auto last = std::partition_point(
        first, sets.end(), [norad](const ElementSet &set) { return set.norad_cat_id <= norad; });
    UMOV_ASSIGN(set, choose_elements({first, last}, norad, request.start, request.orbit));
    out.push_back(set);
  }
  return out;
}

/// Orbits of the objects wanted whose elements are not too old for the span.
Result<std::vector<Trajectory>> choose(const PassesRequest &request, std::vector<ElementSet> sets,
                                       bool allow_old, Diagnostics &diagnostics) {
  UMOV_ASSIGN(chosen, best_sets(request, std::move(sets)));
  std::vector<Trajectory> out;
  std::size_t doubtful = 0;
  double oldest = 0; // of those that are taken
  std::vector<std::string> old;
  for (const ElementSet &set : chosen) {
    const double age = std::max(std::abs(clock_days_between(request.start, set.epoch)),
                                std::abs(clock_days_between(request.stop, set.epoch)));
    doubtful += age > doubtful_days ? 1u : 0u;
    if (age > old_days && !allow_old) {
      old.push_back(set.name.empty() ? fmt::format("{}", set.norad_cat_id) : printable(set.name));
      continue;
    }
    oldest = std::max(oldest, age);
    out.emplace_back(set);
  }
  if (out.empty())
    return fail(ErrorCode::BadInput,
                fmt::format("all elements are more than {:g} d from the span. Give newer ones or "
                            "pass --allow-old-elements (in Python allow_old_elements=True).",
                            old_days),
                {request.orbit});
  if (!old.empty())
    diagnostics.warn(fmt::format("{} left out, with elements more than {:g} d from the span: {}; "
                                 "--allow-old-elements takes them",
                                 counted(old.size(), "object"), old_days, listed(old, 5)),
                     {request.orbit});
  if (doubtful > old.size())
    diagnostics.warn(fmt::format("elements of {} are more than {:g} d from the span, the farthest "
                                 "{:.0f} d; {}",
                                 counted(doubtful - old.size(), "object"), doubtful_days, oldest,
                                 oldest > old_days
                                     ? "passes may be minutes off, and after months others than "
                                       "there were: the air decides where a satellite is by then"
                                     : "passes may be seconds off"),
                     {request.orbit});
  return out;
}

Result<std::vector<Trajectory>> read_orbits(const PassesRequest &request, const JobOptions &options,
                                            Diagnostics &diagnostics) {
  UMOV_ASSIGN(text, read_file(request.orbit));
  if (!ccsds::is_message(text)) {
    UMOV_ASSIGN(sets, read_elements(text, request.orbit,
                                    {options.allow_bad_checksum, request.keep_going}, diagnostics));
    return choose(request, std::move(sets), options.allow_old_elements, diagnostics);
  }
  TrajectoryRequest wanted;
  wanted.norad = request.norad.size() == 1 ? request.norad[0] : 0;
  wanted.first = request.start;
  wanted.last = request.stop;
  UMOV_ASSIGN(orbit, read_trajectory(text, request.orbit, wanted, diagnostics));
  return std::vector<Trajectory>{orbit};
}

/// The passes of one object, and the light of each where a model says what it is.
struct ObjectPasses {
  Result<SitePasses> geometry;
  std::vector<PassBrightness> light;
};
/// Empty where the job was stopped before the object's turn.
using Found = std::optional<ObjectPasses>;

ObjectPasses search_one(const PassesRequest &request, const Trajectory &orbit,
                        const PassModels &models, const std::atomic<bool> *cancel) {
  std::vector<PassBrightness> lights;
  PassSearch search{request.altitude_min, request.sun_altitude_max, request.shadow, {}, cancel};
  if (const PassLight *model = models.of(orbit.norad_cat_id()))
    search.on_pass = [&](const SitePass &,
                         std::span<const ObservingGeometry> samples) -> Result<void> {
      UMOV_ASSIGN(light, model->describe(orbit, request.site, request.shadow, models.band(),
                                         samples, cancel));
      lights.push_back(std::move(light));
      return {};
    };
  auto geometry = find_passes(orbit, request.site, request.start, request.stop, search);
  if (geometry)
    lights.resize(geometry->passes.size());
  return {std::move(geometry), std::move(lights)};
}

std::vector<Found> search_all(const PassesRequest &request, const std::vector<Trajectory> &orbits,
                              const PassModels &models, unsigned threads, const Monitor &monitor) {
  std::vector<Found> out(orbits.size());
  Mutex lock;
  std::size_t done = 0;
  monitor.advance("objects", 0, orbits.size());
  parallel_for(orbits.size(), threads, [&](std::size_t i) {
    if (monitor.is_cancelled())
      return;
    out[i] = search_one(request, orbits[i], models, monitor.cancel);
    const Result<SitePasses> &geometry = out[i]->geometry;
    if (!geometry && geometry.error().code == ErrorCode::Interrupted)
      return out[i].reset(); // as if it had not been begun
    const WriteLock guard(lock);
    monitor.advance("objects", ++done, orbits.size());
  });
  return out;
}

/// A scene that names its objects by number says nothing of others.
void warn_of_unknown(const std::vector<Trajectory> &orbits, const PassModels &models,
                     Diagnostics &diagnostics) {
  if (!models.is_by_number())
    return;
  std::size_t count = 0;
  std::string first;
  for (const Trajectory &orbit : orbits)
    if (models.of(orbit.norad_cat_id()) == nullptr && count++ == 0)
      first = orbit.id();
  if (count > 0)
    diagnostics.warn(
        fmt::format("--scene has no object of norad {}{}: no magnitudes. An [[object]] "
                    "without orbit.norad stands for all others.",
                    first, count > 1 ? fmt::format(" and {} more", count - 1) : ""));
}

/// What was not searched of one object's span, or "".
std::string problem_of(const Result<SitePasses> &found) {
  if (!found)
    return found.error().message;
  std::string out = found->end ? found->end->error.message : "";
  for (const OrbitGap &gap : found->gaps)
    out += fmt::format("{}the ephemeris does not cover {} to {}", out.empty() ? "" : "; ",
                       to_iso(gap.last), to_iso(gap.next));
  return out;
}

bool is_wanted(const PassesRequest &request, const SitePass &pass, const PassBrightness &light) {
  return (!request.is_visible_only || pass.visible_s > 0) &&
         (!request.magnitude_max || light.magnitude_min <= *request.magnitude_max);
}

/// Passes of all objects that are wanted, in order; warnings for the first objects that failed.
SearchTally gather(const PassesRequest &request, std::vector<Found> &&all, PassesResult &out,
                   Diagnostics &diagnostics) {
  constexpr std::size_t told_max = 10;
  SearchTally tally;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (!all[i])
      continue;
    ++tally.searched;
    Result<SitePasses> &geometry = all[i]->geometry;
    if (const std::string problem = problem_of(geometry); !problem.empty())
      if (tally.failed++ < told_max)
        diagnostics.warn(problem);
    if (!geometry)
      continue;
    for (std::size_t k = 0; k < geometry->passes.size(); ++k)
      if (SitePass &pass = geometry->passes[k]; is_wanted(request, pass, all[i]->light[k]))
        out.found.push_back({i, std::move(pass), std::move(all[i]->light[k])});
  }
  if (tally.failed > told_max)
    diagnostics.warn(fmt::format("{} more objects like these", tally.failed - told_max));
  std::stable_sort(out.found.begin(), out.found.end(),
                   [&request](const ObjectPass &a, const ObjectPass &b) {
                     return order_of(request, a) < order_of(request, b);
                   });
  return tally;
}

} // namespace

double order_of(const PassesRequest &request, const ObjectPass &one) {
  constexpr double last = 1e300; // and not infinity: shards keep it in their files
  if (request.order == PassOrder::Magnitude)
    return std::isnan(one.light.magnitude_min) ? last : one.light.magnitude_min;
  if (request.order == PassOrder::Altitude)
    return one.pass.visible_s > 0 ? -one.pass.visible_altitude_max.degrees() : last;
  return seconds_between(one.pass.rise.time, request.start);
}

std::string no_pass(const PassesRequest &request) {
  return fmt::format("no {}pass above {:g} deg{} in this span",
                     request.is_visible_only ? "visible " : "", request.altitude_min.degrees(),
                     request.magnitude_max
                         ? fmt::format(" as bright as magnitude {:g}", *request.magnitude_max)
                         : "");
}

Result<PassSearcher> PassSearcher::make(const PassesRequest &request, const JobOptions &options,
                                        Diagnostics &diagnostics, const std::atomic<bool> *cancel) {
  if (seconds_between(request.stop, request.start) < 0)
    return fail(ErrorCode::Usage, "--stop lies before --start");
  if (const double days = clock_days_between(request.stop, request.start); days > span_days_max)
    return fail(ErrorCode::Usage,
                fmt::format("{} to {} are {:.0f} years; passes are searched over 100 at most. Is "
                            "the year of --stop mistyped?",
                            to_iso(request.start), to_iso(request.stop), days / 365.25));
  const bool has_light = request.model.scene || request.model.body != PassModel::Body::None;
  if (!has_light && (request.magnitude_max || request.order == PassOrder::Magnitude))
    return fail(
        ErrorCode::Usage,
        fmt::format("{}: nothing is known of magnitudes. Say what the objects are: --scene, "
                    "or --model sphere --material paint_white (in Python: a Satellite)",
                    request.magnitude_max ? "--mag-max" : "--sort mag"));
  PassSearcher out;
  UMOV_ASSIGN(orbits, read_orbits(request, options, diagnostics));
  warn_if_beyond_leap_seconds(request.stop, diagnostics);
  warn_if_outside_eop(request.start, request.stop, diagnostics);
  UMOV_ASSIGN(models, PassModels::make(request.model, options, diagnostics, cancel));
  warn_of_unknown(orbits, models, diagnostics);
  out.request_ = request;
  out.threads_ = options.threads;
  out.orbits_ = std::move(orbits);
  out.models_ = std::move(models);
  return out;
}

FoundPasses PassSearcher::search(IndexRange range, const Monitor &monitor,
                                 Diagnostics &diagnostics) const {
  FoundPasses out;
  const auto first = orbits_.begin() + static_cast<std::ptrdiff_t>(range.first);
  out.result.orbits.assign(first, first + static_cast<std::ptrdiff_t>(range.count));
  out.result.model = models_.description();
  out.result.has_air = models_.has_air();
  out.result.magnitudes =
      request_.model.scene ? request_.model.scene->magnitudes : MagnitudeSystem::AB;
  out.tally = gather(request_, search_all(request_, out.result.orbits, models_, threads_, monitor),
                     out.result, diagnostics);
  if (out.tally.searched < range.count)
    out.result.stopped = Error{
        ErrorCode::Interrupted,
        fmt::format("stopped by the user after {} of {} objects", out.tally.searched, range.count),
        {}};
  return out;
}

Result<PassesResult> passes(const PassesRequest &request, const JobOptions &options,
                            const Monitor &monitor, Diagnostics &diagnostics) {
  UMOV_ASSIGN(searcher, PassSearcher::make(request, options, diagnostics, monitor.cancel));
  UMOV_ASSIGN(range, options.part.of(searcher.objects(), "objects"));
  FoundPasses found = searcher.search(range, monitor, diagnostics);
  PassesResult &out = found.result;
  UMOV_TRY(searcher.keep_masks());
  if (out.stopped)
    return std::move(out);
  if (found.tally.failed == out.orbits.size() && out.found.empty() && !out.orbits.empty())
    return fail(ErrorCode::Physics, "no pass before the orbit of every object ends",
                {request.orbit});
  const std::string standing =
      out.found.empty() && out.orbits.size() == 1
          ? where_it_stands(out.orbits[0], request.site, request.start, request.altitude_min)
          : "";
  if (out.found.empty())
    return fail(ErrorCode::Nothing, no_pass(request) + (standing.empty() ? "" : "." + standing));
  return std::move(out);
}

} // namespace umov::jobs
