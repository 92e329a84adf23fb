#pragma once
// Which epochs of a span an observer keeps, and how they group into passes.

#include <atomic>
#include <optional>
#include <umov/observation/track.h>
#include <vector>

namespace umov {

/// Which epochs are kept.
struct EpochFilter {
  Angle altitude_min = Angle::degrees(0); ///< altitude of the object at least this
  std::optional<Angle> sun_altitude_max;  ///< Sun at the site at most this high
  bool sunlit = true;                     ///< only where some of the solar disk is visible
};

/// One passage above `altitude_min`.
struct Pass {
  std::string id;                          ///< NORAD number dash culmination time
  Epoch<Utc> rise{}, culmination{}, set{}; ///< to the step, except the culmination (refined)
  Angle culmination_altitude;
  bool is_open_at_start = false, is_open_at_end = false; ///< goes on beyond its epochs
  std::size_t rows = 0;                                  ///< epochs kept by the filter
};

/// A stretch of time in even steps, or epochs of one's own.
struct EpochSpan {
  Epoch<Utc> start{}, stop{};
  double step_s = 1; ///< > 0; `stop` is included and may equal `start`
  /// Instead of the steps, in order of time; `start` and `stop` are the first and the last.
  std::vector<Epoch<Utc>> own = {};
};

/// The epochs of a span that pass a filter, in order, with their passes.
struct KeptEpochs {
  std::vector<ObservingGeometry> geometry;
  std::vector<std::size_t> pass;  ///< per epoch, into passes
  std::vector<Pass> passes;       ///< those with at least one kept epoch
  std::size_t passes_seen = 0;    ///< above the altitude limit, kept or not
  std::size_t epochs_in_gaps = 0; ///< that an ephemeris with gaps does not cover: no rows
  std::size_t in_light_sky = 0;   ///< above the altitude limit, but with the Sun too high
  std::size_t in_shadow = 0;      ///< the same in a dark sky, but without sunlight
  std::optional<Error> stopped;   ///< Physics: where the orbit ends; the epochs before it are there
  std::size_t before_end = 0;     ///< epochs of the grid that the orbit reaches, where it ends
};

/// How many epochs a span has; BadInput if step <= 0, stop < start, own ones are not in order, or
/// more than 10 million.
Result<std::size_t> epoch_count(const EpochSpan &span);
/// One of them, by its number from 0.
Epoch<Utc> epoch_of(const EpochSpan &span, std::size_t index);
/// They themselves: start, start + step, ... up to `stop`. BadInput as epoch_count; Interrupted if
/// `cancel` became true.
Result<std::vector<Epoch<Utc>>> time_grid(const EpochSpan &span,
                                          const std::atomic<bool> *cancel = nullptr);

/// Propagates and observes a span. Interrupted if `cancel` became true; BadInput as time_grid.
Result<KeptEpochs> keep_epochs(const Track &track, const EpochSpan &span, const EpochFilter &only,
                               unsigned threads, const std::atomic<bool> &cancel);

/// First pass after `from` that the filter would keep, looked for over `days`, along each pass in
/// steps of 20 s from its rise; for the message when a span has none. Empty if there is none before
/// the orbit ends.
struct NextPass {
  Epoch<Utc> first_row{};
  Angle altitude_max;
};
/// Looks for it as told above.
std::optional<NextPass> find_next_pass(const Track &track, const EpochFilter &only, Epoch<Utc> from,
                                       double days);

/// Name of a pass: the object's id, a dash and the time of culmination ("20580-20180121T051155Z").
std::string pass_id(const Trajectory &orbit, Epoch<Utc> culmination);

} // namespace umov
