#pragma once
// Private: an object of an observation, made ready once, and any range of its exposures.

#include "jobs/observe_exposures.h"
#include "jobs/observe_tables.h"

#include <array>
#include <memory>
#include <umov/jobs/index_range.h>
#include <umov/jobs/observe.h>
#include <umov/jobs/tallies.h>
#include <umov/lightcurve/compute.h>

namespace umov::jobs {

/// What all objects of an observation have in common.
struct ObservationPlan {
  Scenario scenario; ///< with the bands of the observation
  ObservedBands bands;
  Programme programme;
  JobOptions options;
};
/// BadInput without [observation] and for what Programme refuses.
Result<ObservationPlan> plan_observation(const Scenario &scenario, const JobOptions &options,
                                         Diagnostics &diagnostics);

/// Exposures that are warned of, by their number.
class ObservationTally {
public:
  /// What is said of each kind; `scenario` names the keys that would help.
  static std::vector<Tally> words(const Scenario &scenario, std::size_t total);
  void add(const Recorded &recorded);
  /// Of each kind.
  [[nodiscard]] std::vector<std::size_t> counts() const { return {counts_.begin(), counts_.end()}; }
  /// With a channel that is full.
  [[nodiscard]] std::size_t saturated() const { return counts_[Saturated]; }

private:
  enum Kind : std::uint8_t {
    Cut,
    Roomless,
    Crowded,
    Lost,
    Glaring,
    Rolled,
    Flickering,
    Saturated,
    Kinds
  };
  std::array<std::size_t, Kinds> counts_{};
};

/// Where exposures go as they are recorded.
struct RecordedSink {
  ObservationTally tally;
  FrameSink take_frame; ///< none: frames are not kept
  std::function<Result<void>(Table &&counts, Table &&truth)> take_rows;
  std::size_t exposures = 0, frames = 0;
  double light_s = 0, counts_s = 0; ///< time that light and counts took
};

/// One object. What decides how its light is sampled is taken from all of its exposures, so that
/// each is the same whatever range it is asked for in.
class ObservedObject {
public:
  /// Reads its files. The plan outlives it.
  static Result<ObservedObject> load(const ObservationPlan &plan, std::uint32_t number,
                                     const Monitor &monitor, Diagnostics &diagnostics);

  /// Its name in the tables.
  [[nodiscard]] const std::string &name() const { return request_.object; }
  /// Files that it was read from.
  [[nodiscard]] const std::vector<InputFile> &inputs() const { return inputs_; }
  /// Finds its exposures, unless they are there: warns of those that are left out and of what its
  /// air and instrument can hardly be meant to be.
  Result<void> prepare(const Monitor &monitor, Diagnostics &diagnostics);
  /// Forgets exposures and light.
  void let_go() { ready_.reset(); }
  /// Its exposures, and the times in each at which there is light. Of one that is prepared.
  [[nodiscard]] std::size_t exposures() const;
  [[nodiscard]] std::size_t nodes() const;
  /// In words, what the scenario's own filters left out; "" for nothing.
  [[nodiscard]] const std::string &left_out() const;
  /// Records a range of its exposures, block by block. Of one that is prepared. Interrupted after a
  /// stop.
  Result<void> record(IndexRange range, const Monitor &monitor, RecordedSink &sink);
  /// Its light, made when it was first asked for; null where it never was.
  [[nodiscard]] const LightModels *light() const;
  /// LightModels::keep_masks, where there is light.
  [[nodiscard]] Result<void> keep_masks() const;

private:
  struct Ready;
  struct Forget {
    void operator()(Ready *ready) const;
  };
  ObservedObject(const ObservationPlan &plan, std::uint32_t number, LoadedObject loaded);
  [[nodiscard]] Result<void> make_ready(const Monitor &monitor);
  [[nodiscard]] Result<void> set_up(Diagnostics &diagnostics);
  [[nodiscard]] std::size_t block() const;
  [[nodiscard]] Result<void> record_block(IndexRange block, IndexRange wanted,
                                          const Monitor &monitor, RecordedSink &sink);
  const ObservationPlan *plan_;
  std::uint32_t number_;
  LoadedObject loaded_;
  LightCurveRequest request_;
  std::vector<InputFile> inputs_;
  std::vector<FieldStar> stars_;
  std::unique_ptr<Ready, Forget> ready_;
};

/// Exposures that are lit together where the light may touch several surfaces and shares its
/// paths, with so many times in each.
std::size_t exposures_with_shared_paths(std::size_t nodes);

} // namespace umov::jobs
