#include <umov/jobs/signature.h>

#include "jobs/job_journal.h"
#include "jobs/signature_rows.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <umov/core/files.h>
#include <umov/core/parallel.h>
#include <umov/jobs/pose_light.h>

namespace umov::jobs {
namespace {

using Source = SignatureRequest::Source;

/// Where the model of an active source falls short (explicit rough surfaces, docs/theory/lobes.md).
constexpr const char *laser_limits =
    "One reflection keeps the degree of polarization; light between microfacets is depolarized or "
    "keeps the single-bounce form, while explicit rough surfaces (slope 0.6, backscatter) "
    "depolarize "
    "circular light about twice as fast as linear. For very rough metals near retro-reflection the "
    "double bounce is understated.";

/// What the header says of the source and of how hiding was decided.
void describe(const SignatureRequest &request, const PoseLight &light, Table &table) {
  const std::string &visibility = light.model().facts().visibility;
  if (request.source == Source::Thermal) {
    table.note("source", "the body's own heat: " +
                             fmt::format("{}", fmt::join(request.temperatures, ", ")) + " K");
    table.note("method", visibility);
    return;
  }
  const Stokes<ScatteringPlane> &source = light.options().source;
  table.note("source", request.source == Source::Sun
                           ? (light.sun_radius_rad() > 0 ? "Sun, uniform disk of 0.2665 deg radius"
                                                         : "Sun, a point")
                           : fmt::format("laser, Stokes {} {} {} {} in the scattering frame",
                                         source.i, source.q, source.u, source.v));
  if (request.source == Source::Laser)
    table.note("limits", laser_limits);
  table.note("visibility", visibility);
}

/// What the rows depend on.
std::string job_of(const Scenario &scenario, const PoseList &poses, const SignatureRequest &request,
                   const PoseLight &pose_light) {
  const LightOptions &light = pose_light.options();
  const Stokes<ScatteringPlane> &s = light.source;
  return job_text(scenario, pose_light.inputs(),
                  fmt::format("signature of {}; source {} {} {} {} {} {}; method {}, accuracy {}, "
                              "seed {}",
                              poses.origin, static_cast<int>(request.source), s.i, s.q, s.u, s.v,
                              fmt::join(request.temperatures, ","), name_of(light.method),
                              light.accuracy, light.seed));
}

/// A block of poses from their numbers to rows.
class PoseBlocks {
public:
  PoseBlocks(const PoseList &poses, const PoseLight &light, Journal &journal, LightTask task)
      : poses_(poses), light_(light), journal_(journal), task_(task) {}

  /// False if the task was cancelled.
  bool light(Journal::Block block, std::size_t begin, std::size_t count) {
    take(begin, count);
    if (const auto kept = journal_.find(block);
        kept && from_bytes(*kept, results_) && results_.poses() == count)
      return true;
    if (!light_.evaluate(part_, results_, task_))
      return false;
    journal_.keep(block, to_bytes(results_));
    return true;
  }
  [[nodiscard]] Table rows(bool is_emitted) const {
    return SignatureRows::of(numbers_, part_, light_.model().scene().bands, results_, task_.threads)
        .table(is_emitted);
  }

private:
  void take(std::size_t begin, std::size_t count) {
    part_.resize(count);
    numbers_.resize(count);
    parallel_for((count + 1023) / 1024, task_.threads, [&](std::size_t of) {
      for (std::size_t i = of * 1024; i < std::min(count, (of + 1) * 1024); ++i) {
        part_[i] = poses_.at(begin + i);
        part_[i].sun_radius_rad = light_.sun_radius_rad();
        numbers_[i] = poses_.number(begin + i);
      }
    });
  }
  const PoseList &poses_;
  const PoseLight &light_;
  Journal &journal_;
  LightTask task_;
  StokesTable results_;
  std::vector<Pose> part_;
  std::vector<std::int64_t> numbers_;
};

/// What the log says of the masks in the end.
void tell_of_masks(const LightModel &model, const std::filesystem::path &file, bool had_file,
                   const Monitor &monitor) {
  const LightFacts &facts = model.facts();
  if (model.mask_bytes() > 0)
    monitor.tell(fmt::format("{} triangles in {} classes, {:.0f} MB of masks", facts.triangles,
                             facts.classes, static_cast<double>(model.mask_bytes()) / 1e6));
  if (!file.empty() && !had_file)
    monitor.tell(facts.is_convex
                     ? "a convex body needs no masks: nothing is kept in " + file.string()
                     : "masks are kept in " + file.string());
}

} // namespace

Result<void> signature(const Scenario &scenario, const PoseList &poses,
                       const SignatureRequest &request, TableSink &sink, const JobOptions &options,
                       const Monitor &monitor, Diagnostics &diagnostics) {
  UMOV_TRY(PoseLight::check(scenario, request));
  monitor.tell("preparing the scene ...");
  const bool had_file = file_exists(request.mask_file);
  UMOV_ASSIGN(light, PoseLight::make(scenario, request, options, diagnostics));
  const LightModel &model = light.model();
  UMOV_ASSIGN(journal,
              open_journal(options, job_of(scenario, poses, request, light), monitor, diagnostics));
  const std::size_t block = light.block();
  LightTask task;
  task.threads = options.threads;
  task.cancel = monitor.cancel;
  PoseBlocks blocks(poses, light, journal, task);
  std::size_t done = 0;
  monitor.advance("poses", 0, poses.count);
  while (done < poses.count && !monitor.is_cancelled()) {
    const std::size_t count = std::min(block, poses.count - done);
    if (!blocks.light({0, done / block}, done, count))
      break;
    Table table = blocks.rows(request.source == Source::Thermal);
    describe(request, light, table);
    UMOV_TRY(sink.add(std::move(table)));
    done += count;
    monitor.advance("poses", done, poses.count);
  }
  if (journal.problem())
    diagnostics.warn(journal.problem()->text());
  if (done < poses.count)
    return tl::unexpected(with_way_on(
        sink.stop({ErrorCode::Interrupted,
                   fmt::format("stopped by the user after {} of {} poses", done, poses.count),
                   {}}),
        journal));
  UMOV_TRY(sink.finish());
  journal.finish();
  UMOV_TRY(model.keep_masks()); // last: the rows are complete without it
  tell_of_masks(model, request.mask_file, had_file, monitor);
  return {};
}

} // namespace umov::jobs
