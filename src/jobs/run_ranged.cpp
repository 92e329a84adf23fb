// A run, pass by pass.

#include "jobs/haze_spread.h"
#include "jobs/job_journal.h"
#include "jobs/wanted_passes.h"

#include <algorithm>
#include <fmt/format.h>
#include <umov/core/parallel.h>
#include <umov/jobs/ranged_job.h>

namespace umov::jobs {
namespace {

/// Passes of each object. An orbit that ends within the span ends the whole.
Result<std::vector<std::size_t>> count_passes(const std::vector<ObjectRun> &objects,
                                              unsigned threads, const Monitor &monitor) {
  std::vector<std::optional<Result<std::size_t>>> found(objects.size());
  parallel_for(objects.size(), threads, [&](std::size_t k) {
    LightCurveRequest alone = objects[k].request;
    alone.threads = 1; // objects are side by side
    const auto kept = kept_epochs(alone, monitor.cancel_flag());
    if (!kept)
      found[k] = tl::unexpected(kept.error());
    else if (kept->stopped)
      found[k] = tl::unexpected(*kept->stopped);
    else
      found[k] = kept->passes.size();
  });
  std::vector<std::size_t> out;
  for (const auto &one : found) {
    UMOV_TRY(*one);
    out.push_back(**one);
  }
  return out;
}

class RangedRun final : public RangedJob {
public:
  RangedRun(std::vector<ObjectRun> objects, const Scenario &scenario,
            std::vector<std::size_t> layout, std::string identity)
      : objects_(std::move(objects)), has_all_csv_digits_(scenario.has_all_csv_digits),
        varies_haze_(scenario.varies_haze), layout_(std::move(layout)),
        identity_(std::move(identity)) {
    for (const std::size_t passes : layout_)
      total_ += passes;
  }
  [[nodiscard]] std::string unit() const override { return "passes"; }
  [[nodiscard]] std::size_t total() const override { return total_; }
  [[nodiscard]] std::string identity() const override { return identity_; }
  [[nodiscard]] std::vector<std::size_t> layout() const override { return layout_; }
  [[nodiscard]] std::vector<std::string> tables() const override {
    return {"lightcurve", "passes"};
  }
  [[nodiscard]] Result<void> keep() override {
    may_keep_ = true;
    return models_.light ? models_.keep_masks() : Result<void>();
  }
  Result<void> rows(IndexRange range, RangeSink &sink, const Monitor &monitor,
                    Diagnostics &diagnostics) override {
    RunTables tables;
    std::size_t first = 0;
    for (std::size_t k = 0; k < objects_.size(); first += layout_[k], ++k) {
      const IndexRange wanted = overlap(range, first, layout_[k]);
      if (wanted.count == 0)
        continue;
      UMOV_TRY(light(k, wanted, monitor, diagnostics));
      append_tables(objects_[k], tables);
      objects_[k].outcome = {};
    }
    if (has_all_csv_digits_)
      tables.light_curve.clear_precision();
    UMOV_TRY(sink.add(0, std::move(tables.light_curve)));
    return sink.add(1, std::move(tables.passes));
  }

private:
  /// Light and epochs of one object; those of the object before go.
  Result<void> make_ready(std::size_t k, const Monitor &monitor) {
    if (k == ready_ && models_.light)
      return {};
    if (may_keep_)
      UMOV_TRY(keep());
    if (ready_ < objects_.size())
      objects_[ready_].kept.reset();
    UMOV_ASSIGN(kept, kept_epochs(objects_[k].request, monitor.cancel_flag()));
    if (kept.passes.size() != layout_[k])
      return fail(ErrorCode::BadInput,
                  fmt::format("{} has {} passes here and {} where the job was begun: another "
                              "program or other files. Begin the job anew.",
                              objects_[k].request.object, kept.passes.size(), layout_[k]));
    objects_[k].kept = std::make_shared<const KeptEpochs>(std::move(kept));
    UMOV_ASSIGN(models,
                make_light_models(objects_[k].request, objects_[k].object.scene, monitor.cancel));
    models_ = std::move(models);
    ready_ = k;
    return {};
  }
  Result<void> light(std::size_t k, IndexRange wanted, const Monitor &monitor,
                     Diagnostics &diagnostics) {
    UMOV_TRY(make_ready(k, monitor));
    ObjectRun &one = objects_[k];
    one.passes = wanted;
    UMOV_ASSIGN(outcome, compute_wanted(one, models_,
                                        [&](std::size_t done, std::size_t of) {
                                          monitor.advance("epochs", done, of);
                                        },
                                        monitor.cancel_flag(), {}));
    one.outcome = std::move(outcome);
    if (varies_haze_ && !one.outcome.stopped)
      UMOV_TRY(add_haze_spread(one, {}, monitor, diagnostics));
    return one.outcome.stopped ? Result<void>(tl::unexpected(*one.outcome.stopped))
                               : Result<void>();
  }

  std::vector<ObjectRun> objects_;
  bool has_all_csv_digits_, varies_haze_;
  std::vector<std::size_t> layout_; ///< passes of each object
  std::string identity_;
  std::size_t total_ = 0;
  bool may_keep_ = false; ///< masks of an object before the next one's
  LightModels models_;    ///< of the object that was asked for last
  std::size_t ready_ = static_cast<std::size_t>(-1);
};

} // namespace

Result<std::unique_ptr<RangedJob>> ranged_run(const Scenario &scenario, const JobOptions &options,
                                              const std::vector<std::size_t> &layout,
                                              const Monitor &monitor, Diagnostics &diagnostics) {
  UMOV_TRY(check_device_of_shards(options.device));
  UMOV_ASSIGN(objects, load_run(scenario, options, monitor, diagnostics));
  std::vector<InputFile> inputs;
  for (const ObjectRun &one : objects)
    inputs.insert(inputs.end(), one.object.inputs.begin(), one.object.inputs.end());
  UMOV_ASSIGN(device, device_text(options.device));
  std::string identity = job_text(scenario, inputs,
                                  fmt::format("run; bad {} old {}{}", options.allow_bad_checksum,
                                              options.allow_old_elements, device));
  std::vector<std::size_t> passes = layout;
  if (passes.size() != objects.size()) {
    UMOV_ASSIGN(counted, count_passes(objects, options.threads, monitor));
    passes = std::move(counted);
  }
  return std::make_unique<RangedRun>(std::move(objects), scenario, std::move(passes),
                                     std::move(identity));
}

} // namespace umov::jobs
