#pragma once
// Private: a tracking as tables, words and a page.

#include "jobs/invert_tables.h"
#include "jobs/track_start.h"

#include <optional>

namespace umov::jobs {

/// A filter after an epoch.
struct TrackRow {
  std::string time_utc;
  TrackMode mode;
  double chi2 = 0; ///< of its innovation; NaN: nothing was measured
  std::size_t measurements = 0;
};
/// A tracking from its start to its end.
struct TrackHistory {
  std::vector<TrackRow> rows;         ///< heaviest first at each epoch
  std::vector<std::string> events;    ///< modes that were dropped or joined, with the time
  std::size_t epochs = 0, before = 0; ///< followed; not later than the start's own data
  std::string lost_utc;               ///< of the first epoch that was not explained; "": none was
  TrackLoss loss = TrackLoss::None;
  std::size_t poses_lit = 0;
  std::vector<double> step_ms; ///< of the clock, each epoch: told, and no part of the answer
};

/// Share of the probability, and gain of all bands in the mean.
double weight_of(const TrackMode &mode);
double scale_of(const TrackMode &mode, const TrackFrame &frame);

/// The bank's modes as those of a search: attitudes at the last epoch, with samples of the same
/// covariance (the points of each filter).
PoseAnswer answer_of(const TrackStart &now, const TrackFrame &frame);

/// track.ecsv.
Table track_table(const TrackHistory &history, const TrackFrame &frame);
/// What the answer is worth.
Judgement judge_track(const TrackStart &now, const TrackFrame &frame, const TrackHistory &history,
                      const PoseAnswer &answer, const ObservedCurve &curve, const EndMember &fitted,
                      const std::vector<BodySymmetry> &symmetries);
std::string track_json(const TrackStart &now, const TrackHistory &history, const PoseAnswer &answer,
                       const Judgement &judgement, const std::vector<BodySymmetry> &symmetries);
std::string track_summary(const TrackStart &now, const TrackHistory &history,
                          const PoseAnswer &answer, const Judgement &judgement);
/// Data and fit, the heaviest attitude and its rate against time, weights, innovations. Empty where
/// this build makes none.
std::string track_page(const std::string &title, const Table &fit, const Table &track,
                       const std::string &summary);

} // namespace umov::jobs
