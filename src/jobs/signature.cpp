#include <umov/jobs/signature.h>

#include "jobs/job_journal.h"
#include "jobs/signature_rows.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <umov/core/files.h>
#include <umov/core/parallel.h>
#include <umov/core/stop.h>
#include <umov/jobs/pose_light.h>
#include <umov/jobs/ranged_job.h>

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

std::string between_of(const LightModel &model, const LightOptions &options) {
  if (model.facts().is_convex)
    return "none: a convex body";
  if (options.between != BetweenMethod::Chains || !is_sunlight(options.source) ||
      !chains_draw_any(model.scene()))
    return name_of(BetweenMethod::Paths);
  return std::string(name_of(BetweenMethod::Chains)) + ", and paths for what they cannot tell" +
         (draws_reserve(options.poses_in_all) ? "" : " and where few of them are met");
}

/// What the header says of the source, of who lit (`device`) and of how hiding was decided.
void describe(const SignatureRequest &request, const PoseLight &light, const std::string &device,
              Table &table) {
  const std::string &visibility = light.model().facts().visibility;
  if (request.source == Source::Thermal) {
    table.note("source", "the body's own heat: " +
                             fmt::format("{}", fmt::join(request.temperatures, ", ")) + " K");
    table.note("method", visibility);
    return;
  }
  if (!device.empty())
    table.note("device", device);
  const Stokes<ScatteringPlane> &source = light.options().source;
  table.note("source", request.source == Source::Sun
                           ? (light.sun_radius_rad() > 0 ? "Sun, uniform disk of 0.2665 deg radius"
                                                         : "Sun, a point")
                           : fmt::format("laser, Stokes {} {} {} {} in the scattering frame",
                                         source.i, source.q, source.u, source.v));
  if (request.source == Source::Laser)
    table.note("limits", laser_limits);
  table.note("visibility", visibility);
  if (light.options().bounces > 1)
    table.note("between surfaces", between_of(light.model(), light.options()));
}

/// Chains cost seconds before the first pose, and are worth it where poses are many and do not tell
/// about each other.
BetweenMethod between_for(const PoseList &poses) {
  constexpr std::size_t many = 1000, looked_at = 1000;
  constexpr double far_rad = 0.1;
  if (poses.count < many)
    return BetweenMethod::Paths;
  std::size_t far = 0;
  const std::size_t count = std::min(poses.count, looked_at);
  for (std::size_t k = 1; k < count; ++k) {
    const Pose a = poses.at(k - 1), b = poses.at(k);
    far += angle_between(a.sun, b.sun) + angle_between(a.observer, b.observer) > far_rad ? 1U : 0U;
  }
  return 2 * far > count ? BetweenMethod::Chains : BetweenMethod::Paths;
}

/// The request with how light between surfaces is drawn: by all poses of the job, however it is
/// cut.
SignatureRequest decided(const Scenario &scenario, const PoseList &poses,
                         const SignatureRequest &request) {
  SignatureRequest out = request;
  const BetweenMethod between = request.between.value_or(scenario.light.between);
  out.between = between == BetweenMethod::Auto ? between_for(poses) : between;
  return out;
}

Result<PoseLight> light_for(const Scenario &scenario, const PoseList &poses,
                            const SignatureRequest &request, const JobOptions &options,
                            const Monitor &monitor, Diagnostics &diagnostics) {
  return PoseLight::make(scenario, decided(scenario, poses, request), options, diagnostics,
                         monitor.cancel, poses.count);
}

/// What the rows depend on.
std::string job_of(const Scenario &scenario, const PoseList &poses, const SignatureRequest &request,
                   const PoseLight &pose_light, const std::string &device) {
  const LightOptions &light = pose_light.options();
  const Stokes<ScatteringPlane> &s = light.source;
  return job_text(scenario, pose_light.inputs(),
                  fmt::format("signature of {}; source {} {} {} {} {} {}; method {}, accuracy {}, "
                              "seed {}, between {}{}",
                              poses.origin, static_cast<int>(request.source), s.i, s.q, s.u, s.v,
                              fmt::join(request.temperatures, ","), name_of(light.method),
                              light.accuracy, light.seed, name_of(light.between), device));
}

/// A block of poses from their numbers to rows.
class PoseBlocks {
public:
  PoseBlocks(const PoseList &poses, const PoseLight &light, Journal *journal, LightTask task)
      : poses_(poses), light_(light), journal_(journal), task_(task) {}

  /// Lights what a range has of the block that `at` lies in, all of it before `at` apart. Light
  /// between surfaces is shared by the poses of a block, which is then lit as a whole. False if the
  /// task was cancelled.
  bool light(std::size_t at, IndexRange range) {
    const std::size_t length = light_.block(), number = at / length;
    const std::size_t block_end = std::min((number + 1) * length, poses_.count);
    wanted_ = {at, std::min(range.end(), block_end) - at};
    lit_ = wanted_;
    if (light_.options().bounces > 1)
      lit_ = {number * length, block_end - number * length};
    take(lit_.first, lit_.count);
    const Journal::Block block{0, number};
    if (const auto kept = journal_ != nullptr ? journal_->find(block) : std::nullopt;
        kept && from_bytes(*kept, results_) && results_.poses() == lit_.count &&
        results_.bands == light_.model().scene().bands.size())
      return true;
    if (!evaluate())
      return false;
    if (journal_ != nullptr) {
      journal_->remark(block.part, light_.model().device());
      journal_->keep(block, to_bytes(results_));
    }
    return true;
  }
  /// Why the last block could not be lit: a card was lost.
  [[nodiscard]] const std::optional<Error> &lost() const { return lost_; }
  /// Who lit the blocks so far, those that were kept before among them.
  [[nodiscard]] std::string device() const {
    const std::string now = light_.model().device();
    return journal_ != nullptr ? lit_by(*journal_, 0, now) : now;
  }
  /// How many poses of the range were lit.
  [[nodiscard]] std::size_t count() const { return wanted_.count; }
  /// Their rows.
  [[nodiscard]] Table rows(const SignatureRequest &request) const {
    const auto &bands = light_.model().scene().bands;
    Table out = SignatureRows::of(numbers_, part_, bands, results_, task_.threads)
                    .table(request.source == Source::Thermal);
    describe(request, light_, device(), out);
    if (lit_.count == wanted_.count)
      return out;
    return out.part((wanted_.first - lit_.first) * bands.size(), wanted_.count * bands.size());
  }

private:
  bool evaluate() {
    bool is_lit = false;
    const auto done = without_failures([&]() -> Result<void> {
      is_lit = light_.evaluate(part_, results_, task_);
      return {};
    });
    if (!done)
      lost_ = done.error();
    return is_lit;
  }
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
  Journal *journal_;
  LightTask task_;
  std::optional<Error> lost_;
  IndexRange wanted_, lit_;
  StokesTable results_;
  std::vector<Pose> part_;
  std::vector<std::int64_t> numbers_;
};

LightTask task_of(const JobOptions &options, const Monitor &monitor) {
  LightTask task;
  task.threads = options.threads;
  task.cancel = monitor.cancel;
  return task;
}

Error stopped_after(std::size_t done, std::size_t total) {
  return {ErrorCode::Interrupted,
          fmt::format("stopped by the user after {} of {} poses", done, total),
          {}};
}

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

/// The poses of a signature, ready to be lit.
class RangedSignature final : public RangedJob {
public:
  RangedSignature(PoseList poses, SignatureRequest request, JobOptions options, PoseLight light,
                  std::string identity)
      : poses_(std::move(poses)), request_(std::move(request)), options_(std::move(options)),
        light_(std::move(light)), identity_(std::move(identity)) {}

  [[nodiscard]] std::string unit() const override { return "poses"; }
  [[nodiscard]] std::size_t total() const override { return poses_.count; }
  [[nodiscard]] std::size_t grain() const override {
    return std::min<std::size_t>(light_.block(), 4096);
  }
  [[nodiscard]] std::string identity() const override { return identity_; }
  [[nodiscard]] std::vector<std::string> tables() const override { return {"signature"}; }
  [[nodiscard]] Result<void> keep() override { return light_.model().keep_masks(); }
  Result<void> rows(IndexRange range, RangeSink &sink, const Monitor &monitor,
                    Diagnostics & /*diagnostics*/) override {
    PoseBlocks blocks(poses_, light_, nullptr, task_of(options_, monitor));
    for (std::size_t at = range.first; at < range.end(); at += blocks.count()) {
      if (monitor.is_cancelled() || !blocks.light(at, range))
        return tl::unexpected(blocks.lost().value_or(stopped_after(at - range.first, range.count)));
      UMOV_TRY(sink.add(0, blocks.rows(request_)));
      monitor.advance("poses", at + blocks.count() - range.first, range.count);
    }
    return {};
  }

private:
  PoseList poses_;
  SignatureRequest request_;
  JobOptions options_;
  PoseLight light_;
  std::string identity_;
};

} // namespace

Result<std::unique_ptr<RangedJob>>
ranged_signature(const Scenario &scenario, const PoseList &poses, const SignatureRequest &request,
                 const JobOptions &options, const Monitor &monitor, Diagnostics &diagnostics) {
  UMOV_TRY(PoseLight::check(scenario, request));
  UMOV_TRY(check_device_of_shards(options.device));
  UMOV_ASSIGN(light, light_for(scenario, poses, request, options, monitor, diagnostics));
  UMOV_ASSIGN(device, device_text(options.device));
  std::string identity = job_of(scenario, poses, request, light, device);
  return std::make_unique<RangedSignature>(poses, request, options, std::move(light),
                                           std::move(identity));
}

Result<void> signature(const Scenario &scenario, const PoseList &poses,
                       const SignatureRequest &request, TableSink &sink, const JobOptions &options,
                       const Monitor &monitor, Diagnostics &diagnostics) {
  UMOV_TRY(PoseLight::check(scenario, request));
  UMOV_ASSIGN(range, options.part.of(poses.count, "poses"));
  monitor.tell("preparing the scene ...");
  const bool had_file = file_exists(request.mask_file);
  UMOV_ASSIGN(light, light_for(scenario, poses, request, options, monitor, diagnostics));
  const LightModel &model = light.model();
  UMOV_ASSIGN(device, device_text(options.device));
  UMOV_ASSIGN(journal,
              open_journal(options,
                           job_of(scenario, poses, request, light, device) + options.part.text(),
                           monitor, diagnostics));
  PoseBlocks blocks(poses, light, &journal, task_of(options, monitor));
  std::size_t done = 0;
  std::string told; // in the header
  monitor.advance("poses", 0, range.count);
  while (done < range.count && !monitor.is_cancelled()) {
    if (!blocks.light(range.first + done, range))
      break;
    if (done == 0)
      told = blocks.device();
    UMOV_TRY(sink.add(blocks.rows(request)));
    done += blocks.count();
    monitor.advance("poses", done, range.count);
  }
  tell_of_device(model.device(), diagnostics);
  if (done > 0 && blocks.device() != told)
    UMOV_TRY(sink.note("device later", blocks.device()));
  if (journal.problem())
    diagnostics.warn(journal.problem()->text());
  if (done < range.count)
    return tl::unexpected(
        with_way_on(sink.stop(blocks.lost().value_or(stopped_after(done, range.count))), journal));
  UMOV_TRY(sink.finish());
  journal.finish();
  UMOV_TRY(model.keep_masks()); // last: the rows are complete without it
  tell_of_masks(model, request.mask_file, had_file, monitor);
  return {};
}

} // namespace umov::jobs
