// What a tracking is worth, in words and numbers.

#include "jobs/curve_limits.h"
#include "jobs/track_tables.h"
#include "jobs/u_null_test.h"
#include "jobs/verdict_json.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <umov/core/text.h>
#include <umov/core/version.h>

namespace umov::jobs {
namespace {

/// The chance of innovations as large as these.
double chance_of(const PoseAnswer &answer) {
  return chi2_probability(answer.chi2, static_cast<double>(answer.measurements));
}

Verdict first_verdict(const TrackStart &now, const TrackHistory &history, const PoseAnswer &answer,
                      const Families &families) {
  const auto count = static_cast<double>(answer.measurements);
  constexpr double unlikely = 1e-6; // as of a search
  if (history.loss == TrackLoss::Misfit ||
      (count > 0 && chance_of(answer) < unlikely && answer.chi2 > 2 * count))
    return Verdict::NoFit;
  constexpr double far_deg = 10;
  if (history.loss == TrackLoss::Open || answer.measurements == 0 || now.memory.is_wide ||
      now.searched == name_of(Verdict::Undetermined) || !(families.spread_deg < far_deg))
    return Verdict::Undetermined;
  constexpr double sure = 0.95;
  return families.heaviest > sure ? Verdict::Determined : Verdict::Ambiguous;
}

void note_doubts(const TrackStart &now, const TrackHistory &history, const PoseAnswer &answer,
                 const CurveErrors &errors, Judgement &out) {
  if (history.loss == TrackLoss::Misfit)
    out.notes.push_back(
        fmt::format("lost at {}: the likeliest filter does not explain what came from then on; ask "
                    "umov invert pose or spin anew with those observations",
                    history.lost_utc));
  if (history.loss == TrackLoss::Open)
    out.notes.push_back(
        fmt::format("lost at {}: by then the attitude is open all around some axis; "
                    "ask umov invert pose or spin anew from there on",
                    history.lost_utc));
  if (now.memory.is_wide && history.loss == TrackLoss::None)
    out.notes.emplace_back(
        "the light bent more than filters have room for: what they say since then may be far off; "
        "search anew with the later observations");
  if (now.memory.was_spread && out.verdict == Verdict::Determined) {
    out.verdict = Verdict::Ambiguous;
    out.notes.emplace_back(
        "the attitude was open to more than 8 deg before some of the data, and was followed from a "
        "grid: a filter beside the true one can be led to a wrong place that fits. Ask umov invert "
        "pose or spin of all observations to be sure");
  }
  if (now.searched == name_of(Verdict::Undetermined))
    out.notes.emplace_back("the search that it began with was undetermined, as its own notes say: "
                           "attitudes that its modes leave out are not followed");
  if (answer.measurements == 0)
    out.notes.emplace_back("nothing was measured: the attitude is that of the start, turned on");
  constexpr double unlikely = 1e-3; // as of a search
  if (out.verdict != Verdict::Determined || errors.outlier_share > 0 ||
      !(chance_of(answer) < unlikely))
    return;
  out.verdict = Verdict::Undetermined;
  out.notes.push_back(fmt::format("what came was off from what was expected by more than errors "
                                  "and --rate-noise allow (chance {:.1g})",
                                  chance_of(answer)));
}

} // namespace

Judgement judge_track(const TrackStart &now, const TrackFrame &frame, const TrackHistory &history,
                      const PoseAnswer &answer, const ObservedCurve &curve, const EndMember &fitted,
                      const std::vector<BodySymmetry> &symmetries) {
  Judgement out;
  out.families = families_of(answer, symmetries);
  out.verdict = first_verdict(now, history, answer, out.families);
  out.axis_spread_deg = axis_spread_deg(answer);
  out.null_test = null_test_of(curve, fitted);
  if (out.verdict == Verdict::Determined && is_steady(curve, frame.errors))
    out.verdict = Verdict::Undetermined;
  note_doubts(now, history, answer, frame.errors, out);
  if (curve.epochs.size() > 1) // of one epoch the start decides
    for (std::string &limit : limits_of(curve, frame.errors, Asked::Attitude))
      out.notes.push_back(std::move(limit));
  for (const BodySymmetry &s : symmetries)
    out.notes.push_back("no light tells the body from itself after " + s.text);
  note_null_test(out.null_test, out.notes);
  return out;
}

std::string track_json(const TrackStart &now, const TrackHistory &history, const PoseAnswer &answer,
                       const Judgement &judgement, const std::vector<BodySymmetry> &symmetries) {
  using nlohmann::ordered_json;
  ordered_json out;
  out["program"] = "umov";
  out["version"] = version;
  out["question"] = "track";
  out["verdict"] = name_of(judgement.verdict);
  out["time_utc"] = to_iso_exact(now.time);
  out["epochs"] = history.epochs;
  out["epochs_before"] = history.before;
  out["lost_utc"] = history.lost_utc.empty() ? ordered_json() : ordered_json(history.lost_utc);
  out["chi2"] = answer.chi2;
  out["dof"] = answer.measurements;
  out["p_value"] = chance_of(answer);
  out["floor"] = answer.errors.floor;
  out["families"] = judgement.families.count;
  out["heaviest"] = judgement.families.heaviest;
  out["spread_deg"] = judgement.families.spread_deg;
  out["light_between"] =
      judgement.light_between ? ordered_json(*judgement.light_between) : ordered_json();
  out["light_between_fitted"] = judgement.is_between_fitted;
  out["axis_spread_deg"] = judgement.axis_spread_deg;
  ordered_json modes = ordered_json::array();
  for (std::size_t k = 0; k < answer.modes.size(); ++k) {
    const PoseMode &mode = answer.modes[k];
    const Quaternion q = mode.turning.attitude;
    const Vec3<Body> w = mode.turning.rate_rad_s * (1 / rad_per_deg);
    modes.push_back({{"number", now.modes[k].number},
                     {"weight", mode.weight},
                     {"q", {q.w, q.x, q.y, q.z}},
                     {"rate_deg_s", {w.x, w.y, w.z}},
                     {"sd_deg", mode.sd_rad() / rad_per_deg},
                     {"chi2", mode.chi2},
                     {"scale", mode.scale}});
  }
  out["modes"] = modes;
  out["events"] = history.events;
  put_symmetries_and_null_test(symmetries, judgement.null_test, out);
  out["notes"] = judgement.notes;
  return out.dump(1) + "\n";
}

std::string track_summary(const TrackStart &now, const TrackHistory &history,
                          const PoseAnswer &answer, const Judgement &judgement) {
  const Families &families = judgement.families;
  std::string out = fmt::format("{}: {} up to {}", name_of(judgement.verdict),
                                counted(history.epochs, "epoch"), to_iso(now.time));
  if (history.before > 0)
    out += fmt::format(" ({} not later than the start's own data)", history.before);
  if (judgement.verdict == Verdict::NoFit || answer.modes.empty()) {
    out += "; nothing is known of the attitude any more\n";
  } else {
    const Vec3<Body> w = answer.modes.front().turning.rate_rad_s * (1 / rad_per_deg);
    out += fmt::format("; {}, twins of the body counted as one; the heaviest holds {:.3g} % of the "
                       "probability, within {} deg (root mean square), and turns by ({:.3g}, "
                       "{:.3g}, {:.3g}) deg/s\n",
                       counted(families.count, "attitude"), 100 * families.heaviest,
                       in_digits(families.spread_deg), w.x, w.y, w.z);
  }
  out += fmt::format("chi-square of what came {:.4g} of {} (chance {:.2g})\n", answer.chi2,
                     counted(answer.measurements, "number"), chance_of(answer));
  for (const std::string &text : judgement.notes)
    out += "- " + text + "\n";
  if (judgement.verdict == Verdict::Determined)
    out += "- this holds for materials and a shape that are right to the options, and for a body "
           "that turns as --rate-noise says\n";
  return out;
}

} // namespace umov::jobs
