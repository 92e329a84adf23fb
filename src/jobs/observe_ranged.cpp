// An observation, exposure by exposure.

#include "jobs/job_journal.h"
#include "jobs/observed_object.h"
#include "jobs/result_folder.h"
#include "jobs/wanted_passes.h"

#include <algorithm>
#include <fmt/format.h>
#include <umov/jobs/ranged_job.h>

namespace umov::jobs {
namespace {

/// All that the rows depend on. Bands and zero points may come from files that the locked scenario
/// only names.
std::string identity_of(const Scenario &given, const ObservationPlan &plan,
                        const std::vector<ObservedObject> &objects, const std::string &device) {
  std::vector<InputFile> inputs;
  for (const ObservedObject &one : objects)
    inputs.insert(inputs.end(), one.inputs().begin(), one.inputs().end());
  std::string more = fmt::format("observe; bad {} old {}{}", plan.options.allow_bad_checksum,
                                 plan.options.allow_old_elements, device);
  for (std::size_t b = 0; b < plan.bands.bands.size(); ++b) {
    const Band &band = plan.bands.bands[b];
    more += fmt::format("; band {} {:.17g} zero {:.17g}", band.name, band.wavelength.nm(),
                        plan.bands.zero_flux[b]);
    if (band.curve)
      for (std::size_t k = 0; k < band.curve->wavelength_nm.size(); ++k)
        more +=
            fmt::format(" {:.17g}:{:.17g}", band.curve->wavelength_nm[k], band.curve->response[k]);
  }
  return job_text(given, inputs, more);
}

class RangedObservation final : public RangedJob {
public:
  /// The plan stays where it is: the objects refer to it.
  RangedObservation(std::unique_ptr<const ObservationPlan> plan,
                    std::vector<ObservedObject> objects, std::vector<std::size_t> layout,
                    std::string identity, std::vector<std::string> warnings)
      : plan_(std::move(plan)), objects_(std::move(objects)), layout_(std::move(layout)),
        identity_(std::move(identity)), warnings_(std::move(warnings)) {
    for (std::size_t k = 0; k < objects_.size(); ++k)
      total_ += exposures(k);
  }
  [[nodiscard]] std::string unit() const override { return "exposures"; }
  [[nodiscard]] std::size_t total() const override { return total_; }
  [[nodiscard]] std::size_t grain() const override {
    std::size_t nodes = 1;
    for (std::size_t k = 0; k < objects_.size(); ++k)
      nodes = std::max(nodes, layout_[2 * k + 1]);
    return plan_->scenario.light.bounces > 1 ? exposures_with_shared_paths(nodes) : 1;
  }
  [[nodiscard]] std::string identity() const override { return identity_; }
  [[nodiscard]] std::vector<std::size_t> layout() const override { return layout_; }
  [[nodiscard]] std::vector<std::string> tables() const override { return {"counts", "truth"}; }
  [[nodiscard]] std::vector<std::string> warnings() const override { return warnings_; }
  [[nodiscard]] std::vector<Tally> tallies() const override {
    return ObservationTally::words(plan_->scenario, total_);
  }
  [[nodiscard]] Result<void> keep() override {
    may_keep_ = true;
    return ready_ < objects_.size() ? objects_[ready_].keep_masks() : Result<void>();
  }
  Result<void> rows(IndexRange range, RangeSink &sink, const Monitor &monitor,
                    Diagnostics & /*told_at_the_begin*/) override {
    RecordedSink recorded;
    recorded.take_rows = [&](Table &&counts, Table &&truth) -> Result<void> {
      note_observation(counts, plan_->scenario, plan_->bands);
      note_observation(truth, plan_->scenario, plan_->bands);
      UMOV_TRY(sink.add(0, std::move(counts)));
      return sink.add(1, std::move(truth));
    };
    std::size_t first = 0;
    for (std::size_t k = 0; k < objects_.size(); first += exposures(k), ++k) {
      const IndexRange wanted = overlap(range, first, exposures(k));
      if (wanted.count == 0)
        continue;
      UMOV_TRY(make_ready(k, monitor));
      UMOV_TRY(objects_[k].record(wanted, monitor, recorded));
    }
    sink.tally(recorded.tally.counts());
    return {};
  }

private:
  [[nodiscard]] std::size_t exposures(std::size_t k) const { return layout_[2 * k]; }
  /// Exposures and light of one object; those of the object before go.
  Result<void> make_ready(std::size_t k, const Monitor &monitor) {
    if (k != ready_ && ready_ < objects_.size()) {
      if (may_keep_)
        UMOV_TRY(keep());
      objects_[ready_].let_go();
    }
    ready_ = k;
    Diagnostics told_at_the_begin;
    UMOV_TRY(objects_[k].prepare(monitor, told_at_the_begin));
    if (objects_[k].exposures() == exposures(k) && objects_[k].nodes() == layout_[2 * k + 1])
      return {};
    return fail(ErrorCode::BadInput,
                fmt::format("{} has {} exposures with light at {} times in each here, {} with {} "
                            "where the job was begun: another program or other files. Begin the "
                            "job anew.",
                            objects_[k].name(), objects_[k].exposures(), objects_[k].nodes(),
                            exposures(k), layout_[2 * k + 1]));
  }

  std::unique_ptr<const ObservationPlan> plan_;
  std::vector<ObservedObject> objects_;
  std::vector<std::size_t> layout_; ///< exposures and times in each, object by object
  std::string identity_;
  std::vector<std::string> warnings_;
  std::size_t total_ = 0;
  bool may_keep_ = false; ///< masks of an object before the next one's
  std::size_t ready_ = static_cast<std::size_t>(-1);
};

} // namespace

Result<std::unique_ptr<RangedJob>> ranged_observe(const Scenario &scenario,
                                                  const JobOptions &options,
                                                  const std::vector<std::size_t> &layout,
                                                  const Monitor &monitor,
                                                  Diagnostics &diagnostics) {
  UMOV_TRY(check_device_of_shards(options.device));
  if (scenario.observation && scenario.observation->makes_frames)
    return fail(
        ErrorCode::BadInput,
        "level = \"image\" makes frames, which are files of their own and no rows. Let each "
        "task do umov observe --shard K/N -o PART_K, or take level = \"aperture\".",
        scenario.place("observation.level"));
  UMOV_ASSIGN(device, device_text(options.device));
  Diagnostics told;
  UMOV_ASSIGN(made, plan_observation(scenario, options, told));
  auto plan = std::make_unique<const ObservationPlan>(std::move(made));
  const std::size_t count = plan->scenario.objects.size();
  std::vector<ObservedObject> objects;
  std::vector<std::size_t> found;
  for (std::size_t k = 0; k < count; ++k) {
    UMOV_ASSIGN(object, ObservedObject::load(*plan, static_cast<std::uint32_t>(k), monitor, told));
    if (layout.size() != 2 * count) {
      UMOV_TRY(object.prepare(monitor, told));
      found.insert(found.end(), {object.exposures(), object.nodes()});
      object.let_go();
    }
    objects.push_back(std::move(object));
  }
  for (const Warning &warning : told.warnings())
    diagnostics.warn(warning.message, warning.where);
  std::string identity = identity_of(scenario, *plan, objects, device);
  if (found.empty())
    found = layout;
  return std::make_unique<RangedObservation>(std::move(plan), std::move(objects), std::move(found),
                                             std::move(identity), messages_of(told));
}

} // namespace umov::jobs
