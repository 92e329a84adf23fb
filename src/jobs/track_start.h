#pragma once
// Private: what a tracking begins with, and what it leaves for the next one.

#include "jobs/body_words.h"

#include <functional>
#include <umov/core/diagnostics.h>
#include <umov/core/quantity.h>
#include <umov/inverse/track.h>
#include <umov/jobs/invert.h>
#include <umov/time/epoch.h>

namespace umov::jobs {

inline constexpr double rad_per_deg = pi / 180;

/// Where a bank of filters stands.
struct TrackStart {
  std::vector<TrackMode> modes;
  Epoch<Utc> time{};      ///< of the modes, and of the last data that they rest on
  double median_i = 0;    ///< that floors are of
  double floor = 0;       ///< that the search rested on
  std::string searched;   ///< verdict of the search that it all began with
  TrackMemory memory;     ///< of the bank
  std::string missed_utc; ///< of the first of its misses
  std::vector<InputFile> inputs;
};
/// What the filters' unknowns are of.
struct TrackFrame {
  std::vector<std::string> bands;
  std::vector<PartKind> parts;
  CurveErrors errors;
  bool is_absolute = false; ///< of the light that is to be followed
  BodyWords body;           ///< that it is of
};

/// A start as it was read.
struct TrackStartFile {
  std::string path, text;
  std::string samples_path = {}, samples = {}; ///< beside modes.ecsv in a folder; may be empty
};
/// The state.json or modes.ecsv of an answer's folder, or such a file. Usage where nothing is
/// named, BadInput for a folder that has neither; before any work is done.
Result<TrackStartFile> open_track_start(const std::string &path);
/// What it says. Attitudes of `pose` hold until its data end, and their rate is 0 to `rate_sd`
/// [rad/s]; those of `spin` have turned until then. A search of fixed attitudes that is
/// undetermined by its width alone is taken up by its samples, where they are there. BadInput for
/// what is no such answer, one about another body or light of another unit, a state of other bands
/// or materials' errors, and one without an attitude to be followed. Warns of modes that do not say
/// what they are of.
Result<TrackStart> read_track_start(const TrackStartFile &file, const TrackFrame &frame,
                                    double rate_sd, Diagnostics &diagnostics);
/// Least and most of some lights.
struct LightRange {
  double least = 0, most = 0;
};
/// BadInput where light of no unit is a thousand times as bright as that of the start, or as faint,
/// and as all that its modes lead to expect, which is asked for then alone: a body may have been
/// dark so far. It is in another unit then.
Result<void> check_brightness(const TrackStartFile &file, const TrackFrame &frame,
                              double start_median, double median,
                              const std::function<Result<LightRange>()> &expected);
/// What a start says of the search before it, if a tracking with this verdict is one.
std::string searched_by(const TrackStart &state, Verdict verdict);
/// state.json: all digits, so that the next tracking goes on as if there had been no end.
std::string state_json(const TrackStart &state, const TrackFrame &frame, TrackLoss loss,
                       Verdict verdict);

} // namespace umov::jobs
