#include <umov/jobs/signature.h>

#include "jobs/job_journal.h"
#include "jobs/part_angles.h"
#include "jobs/signature_rows.h"
#include "jobs/temperatures.h"

#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <umov/core/files.h>
#include <umov/core/parallel.h>

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

/// Stokes vector of the source per unit irradiance.
Result<Stokes<ScatteringPlane>> source_of(const SignatureRequest &request) {
  const Stokes<ScatteringPlane> &s = request.state;
  const double polarized = std::sqrt(s.q * s.q + s.u * s.u + s.v * s.v);
  if (request.source != Source::Laser && polarized > 0)
    return fail(ErrorCode::Usage, "--state goes with --source laser");
  if (!(s.i > 0) || !(polarized <= s.i * (1 + 1e-12)))
    return fail(ErrorCode::Usage,
                fmt::format("--state {} {} {} {}: I > 0 and sqrt(Q2 + U2 + V2) <= I were expected",
                            s.i, s.q, s.u, s.v));
  return s * (1 / s.i);
}

/// What the options say against each other.
Result<void> check_request(const Scenario &scenario, const SignatureRequest &request,
                           LightMethod method) {
  if (scenario.objects.size() > 1)
    return fail(ErrorCode::BadInput,
                fmt::format("holds {} objects; a signature is of one. Keep one [[object]].",
                            scenario.objects.size()),
                {scenario.file});
  const bool has_masks = request.method == LightMethod::Masks || !request.mask_file.empty();
  if (request.source != Source::Sun && has_masks)
    return fail(ErrorCode::Usage, "masks are for sunlight; a laser takes rays, own heat paths");
  if ((request.source == Source::Thermal) != !request.temperatures.empty())
    return fail(ErrorCode::Usage, "--source thermal and --temperature go together");
  if (!request.mask_file.empty() && method == LightMethod::Rays)
    return fail(ErrorCode::Usage, "--masks goes with --visibility masks or auto");
  return {};
}

Result<std::unique_ptr<LightModel>> light_of(const Scene &scene, const std::vector<Joint> &joints,
                                             const SignatureRequest &request,
                                             const LightOptions &options) {
  if (request.source != Source::Thermal)
    return make_light(scene, joints, options);
  UMOV_ASSIGN(kelvin, temperatures_of(request.temperatures, scene.mesh));
  return make_thermal_light(scene, joints, kelvin, options);
}

/// What the header says of the source and of how hiding was decided.
void describe(const SignatureRequest &request, const Stokes<ScatteringPlane> &source, bool has_disk,
              const std::string &visibility, Table &table) {
  if (request.source == Source::Thermal) {
    table.note("source", "the body's own heat: " +
                             fmt::format("{}", fmt::join(request.temperatures, ", ")) + " K");
    table.note("method", visibility);
    return;
  }
  table.note("source", request.source == Source::Sun
                           ? (has_disk ? "Sun, uniform disk of 0.2665 deg radius" : "Sun, a point")
                           : fmt::format("laser, Stokes {} {} {} {} in the scattering frame",
                                         source.i, source.q, source.u, source.v));
  if (request.source == Source::Laser)
    table.note("limits", laser_limits);
  table.note("visibility", visibility);
}

/// Poses that are lit together. Light between surfaces is shared by the poses of a block, so that
/// its size must not depend on anything that may change.
std::size_t block_of(const LightFacts &facts, std::size_t bounces) {
  if (bounces > 1 || facts.method == LightMethod::Rays)
    return 512;
  return facts.method == LightMethod::Auto ? 4096 : 1u << 17;
}

/// What the request says goes over what the scenario says.
LightOptions light_asked_for(const Scenario &scenario, const SignatureRequest &request,
                             const Stokes<ScatteringPlane> &source, const JobOptions &options) {
  LightOptions out = light_options(scenario, options);
  out.method = request.method.value_or(out.method);
  out.accuracy = request.accuracy.value_or(out.accuracy);
  out.seed = request.seed.value_or(scenario.seed);
  out.source = source;
  out.mask_file = request.mask_file;
  return out;
}

/// What the rows depend on.
std::string job_of(const Scenario &scenario, const std::vector<InputFile> &inputs,
                   const PoseList &poses, const SignatureRequest &request,
                   const LightOptions &light) {
  const Stokes<ScatteringPlane> &s = light.source;
  return job_text(scenario, inputs,
                  fmt::format("signature of {}; source {} {} {} {} {} {}; method {}, accuracy {}, "
                              "seed {}",
                              poses.origin, static_cast<int>(request.source), s.i, s.q, s.u, s.v,
                              fmt::join(request.temperatures, ","), name_of(light.method),
                              light.accuracy, light.seed));
}

/// A block of poses from their numbers to rows.
class PoseBlocks {
public:
  PoseBlocks(const PoseList &poses, const LightModel &model, const PartAngles &parts, bool has_disk,
             Journal &journal, LightTask task)
      : poses_(poses), model_(model), parts_(parts), has_disk_(has_disk), journal_(journal),
        task_(task) {}

  /// False if the task was cancelled.
  bool light(Journal::Block block, std::size_t begin, std::size_t count) {
    take(begin, count);
    if (const auto kept = journal_.find(block);
        kept && from_bytes(*kept, results_) && results_.poses() == count)
      return true;
    if (!model_.evaluate(part_, parts_.of(part_), results_, task_))
      return false;
    journal_.keep(block, to_bytes(results_));
    return true;
  }
  [[nodiscard]] Table rows(bool is_emitted) const {
    return SignatureRows::of(numbers_, part_, model_.scene().bands, results_, task_.threads)
        .table(is_emitted);
  }

private:
  void take(std::size_t begin, std::size_t count) {
    part_.resize(count);
    numbers_.resize(count);
    parallel_for((count + 1023) / 1024, task_.threads, [&](std::size_t of) {
      for (std::size_t i = of * 1024; i < std::min(count, (of + 1) * 1024); ++i) {
        part_[i] = poses_.at(begin + i);
        part_[i].sun_radius_rad = has_disk_ ? sun_radius_at_1au_rad : 0;
        numbers_[i] = poses_.number(begin + i);
      }
    });
  }
  const PoseList &poses_;
  const LightModel &model_;
  const PartAngles &parts_;
  bool has_disk_;
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
  UMOV_ASSIGN(source, source_of(request));
  const LightOptions light = light_asked_for(scenario, request, source, options);
  UMOV_TRY(check_request(scenario, request, light.method));
  const bool is_sun = request.source == Source::Sun, is_emitted = request.source == Source::Thermal;
  UMOV_ASSIGN(
      object,
      load_object(scenario, 0, {.allow_old_elements = true, .source_is_sun = is_sun}, diagnostics));
  UMOV_ASSIGN(journal, open_journal(options, job_of(scenario, object.inputs, poses, request, light),
                                    monitor, diagnostics));
  const bool had_file = file_exists(request.mask_file);
  monitor.tell("preparing the scene ...");
  const PartAngles parts(scenario.objects.front().parts, is_sun, scenario.file, diagnostics);
  UMOV_ASSIGN(model, light_of(object.scene, parts.joints(), request, light));
  const bool has_disk = is_sun && scenario.has_solar_disk;
  const std::size_t block = block_of(model->facts(), light.bounces);
  LightTask task;
  task.threads = options.threads;
  task.cancel = monitor.cancel;
  PoseBlocks blocks(poses, *model, parts, has_disk, journal, task);
  std::size_t done = 0;
  while (done < poses.count && !monitor.is_cancelled()) {
    const std::size_t count = std::min(block, poses.count - done);
    if (!blocks.light({0, done / block}, done, count))
      break;
    Table table = blocks.rows(is_emitted);
    describe(request, source, has_disk, model->facts().visibility, table);
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
  UMOV_TRY(model->keep_masks()); // last: the rows are complete without it
  tell_of_masks(*model, request.mask_file, had_file, monitor);
  return {};
}

} // namespace umov::jobs
