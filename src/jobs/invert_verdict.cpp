// What an answer is worth, in words and numbers.

#include "jobs/curve_limits.h"
#include "jobs/invert_tables.h"
#include "jobs/u_null_test.h"
#include "jobs/verdict_json.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <limits>
#include <nlohmann/json.hpp>
#include <umov/core/quantity.h>
#include <umov/core/text.h>
#include <umov/core/version.h>

namespace umov::jobs {

const char *name_of(Verdict verdict) {
  switch (verdict) {
  case Verdict::Determined:
    return "determined";
  case Verdict::Ambiguous:
    return "ambiguous";
  case Verdict::NoFit:
    return "no_fit";
  case Verdict::Undetermined:
    break;
  }
  return "undetermined";
}

namespace {

constexpr double far_deg = 10; // a single peak as wide as that is no attitude

} // namespace

std::string fit_words(double chi2, double dof) {
  return dof > 0 ? fmt::format("chi-square {:.4g} of {:.0f} degrees of freedom (chance {:.2g})",
                               chi2, dof, chi2_probability(chi2, dof))
                 : fmt::format("chi-square {:.4g} of no more numbers than there are unknowns: the "
                               "fit is no test of itself",
                               chi2);
}

std::string in_digits(double number) {
  return number < 99.5 ? fmt::format("{:.2g}", number) : fmt::format("{:.0f}", number);
}

Verdict verdict_of(const PoseAnswer &answer, const Families &families, double floor) {
  if (explains_nothing(answer, floor))
    return Verdict::NoFit;
  constexpr double wide = 0.01; // of all attitudes
  if (answer.is_broad || answer.share_of_so3 > wide || answer.modes.empty())
    return Verdict::Undetermined;
  constexpr double few = 20; // a set of 95 % wants more effective samples than that
  if (!answer.is_settled || answer.effective < few)
    return Verdict::Undetermined;
  if (!(families.heaviest > 0.95))
    return Verdict::Ambiguous;
  return families.spread_deg < far_deg ? Verdict::Determined : Verdict::Undetermined;
}

namespace {

/// Parts of the light as unknowns, in the order of CurveLikelihood::FittedLight::off.
void add_parts(const std::vector<PartKind> &parts, const BestLight &best, Judgement &out) {
  const auto add = [&](const std::string &name, double sd, const char *unit = "ln") {
    if (sd > 0)
      out.nuisances.push_back({name, unit, -10, 10, Prior::Normal, 0, sd});
  };
  for (const PartKind &part : parts)
    add("amount of the " + part.name, part.sd);
  for (const PartKind &part : parts)
    add("slopes of the " + part.name, part.slope_sd);
  for (const PartKind &part : parts)
    for (const char axis : {'X', 'Y', 'Z'})
      add(fmt::format("tilt of the {} about +{}", part.name, axis),
          part.tilts_with_last ? 0 : part.tilt_sd_rad * 180 / pi, "deg");
  out.fitted = best.parts;
}

/// A misfit far beyond the floor, which no material within its priors and no attitude explains.
void doubt_model(const PoseAnswer &answer, double floor, Judgement &out) {
  constexpr double other = 2.5, least = 0.005;
  const double times = answer.model_error / std::max(floor, least);
  if (!(times > other))
    return;
  out.notes.push_back(fmt::format("the best attitude misses the data by {}{:.2g} of I, the floor "
                                  "is {:.2g}: materials or shape are others than these, and the "
                                  "attitude is not sure",
                                  answer.is_model_error_more ? "more than " : "",
                                  answer.model_error, floor));
  if (out.verdict == Verdict::Determined)
    out.verdict = Verdict::Undetermined;
}

void doubt_fit(const PoseAnswer &answer, const CurveErrors &errors, Judgement &out) {
  const auto chance = chance_of_bad_fit(answer, errors);
  if (out.verdict != Verdict::Determined || !chance)
    return;
  out.verdict = Verdict::Undetermined;
  out.notes.push_back(fmt::format("the best fit misses the data by more than their errors (chance "
                                  "{:.1g}): one that fits may have been passed by, or errors and "
                                  "--floor are too small, so this one is not sure",
                                  *chance));
}

/// Why no attitude is told though each number of the search is sound.
void note_width(const PoseAnswer &answer, Judgement &out) {
  if (out.verdict != Verdict::Undetermined || !answer.is_settled)
    return;
  if (answer.is_broad || answer.modes.empty())
    out.notes.emplace_back(
        "the attitudes that explain the data are no few peaks: set95.ecsv and samples.ecsv hold "
        "them, modes.ecsv only where they lie closest");
  else if (out.families.heaviest > 0.95 && !(out.families.spread_deg < far_deg))
    out.notes.push_back(fmt::format("one attitude explains the data, but so do all within {} deg "
                                    "of it: what would narrow them are other directions or bands",
                                    in_digits(out.families.spread_deg)));
}

} // namespace

std::optional<double> chance_of_bad_fit(const PoseAnswer &answer, const CurveErrors &errors) {
  constexpr double unlikely = 1e-3;
  const double dof =
      static_cast<double>(answer.measurements) - static_cast<double>(answer.unknowns);
  if (!(dof > 0) || errors.outlier_share > 0)
    return {};
  const double chance = chi2_probability(answer.chi2, dof);
  return chance < unlikely ? std::optional(chance) : std::nullopt;
}

bool is_wide_alone(const PoseAnswer &answer, const ObservedCurve &curve,
                   const Judgement &judgement) {
  constexpr double few = 20, other = 2.5, least = 0.005; // as in the verdict
  const double floor = std::max(answer.errors.floor, least);
  const bool is_direct =
      judgement.is_between_fitted || judgement.light_between.value_or(0) < other * floor;
  return judgement.verdict == Verdict::Undetermined && answer.is_broad && answer.effective >= few &&
         is_direct && answer.model_error < other * floor &&
         !chance_of_bad_fit(answer, answer.errors) && !is_steady(curve, answer.errors);
}

Judgement judge(const PoseAnswer &answer, const CurveModel &searched, const CurveModel &whole,
                const CurveErrors &errors, const std::vector<BodySymmetry> &symmetries) {
  const ObservedCurve &curve = searched.curve();
  Judgement out;
  out.epochs = whole.curve().epochs.size();
  out.epochs_searched = curve.epochs.size();
  out.families = families_of(answer, symmetries);
  out.verdict = verdict_of(answer, out.families, errors.floor);
  // What a note says the data cannot tell is not told, however narrow a fit came out.
  if (out.verdict == Verdict::Determined && is_steady(curve, errors))
    out.verdict = Verdict::Undetermined;
  if (out.verdict == Verdict::Determined && curve.epochs.size() == 1)
    out.verdict = Verdict::Ambiguous;
  out.axis_spread_deg = axis_spread_deg(answer);
  const BestLight best = best_light(whole, answer);
  out.null_test = null_test_of(whole.curve(), best.light);
  out.nuisances = CurveLikelihood(curve, errors).nuisances();
  add_parts(whole.parts(), best, out);
  out.notes = limits_of(curve, errors, Asked::Attitude);
  doubt_model(answer, errors.floor, out);
  doubt_fit(answer, errors, out);
  note_width(answer, out);
  if (out.verdict == Verdict::Ambiguous && answer.modes.size() > 1)
    out.notes.emplace_back(
        "which passes would decide between these: umov invert plan with --modes");
  for (const BodySymmetry &s : symmetries)
    out.notes.push_back("no light tells the body from itself after " + s.text);
  note_null_test(out.null_test, out.notes);
  if (out.epochs_searched < out.epochs)
    out.notes.push_back(fmt::format("the search has {} epochs of {}: those with next to the "
                                    "same directions of Sun and observer are joined",
                                    out.epochs_searched, out.epochs));
  if (!answer.is_settled)
    out.notes.emplace_back("the search did not come to rest: a better attitude than these may be "
                           "near; a larger --grid or --floor may help");
  if (answer.evidences_apart > alike_evidences)
    out.notes.emplace_back(
        fmt::format("samples from other beginnings do not agree (the evidence of one is {:.2g} "
                    "times that of another): set95.ecsv may lack places that hold some of the "
                    "probability",
                    std::exp(answer.evidences_apart)));
  if (out.verdict == Verdict::Undetermined && answer.is_settled && answer.effective < 20)
    out.notes.emplace_back(fmt::format("the samples are worth {:.1f} of the posterior's own: too "
                                       "few to say how sure the attitude is",
                                       answer.effective));
  if (out.verdict != Verdict::NoFit)
    out.contributions = {contributions_to(answer, searched, 1), curve.bands};
  else
    out.notes.emplace_back("no attitude explains the data within their errors and --floor: is it "
                           "this object, does it stand still, are its materials right?");
  return out;
}

std::string json_of(const char *question, const PoseAnswer &answer, const Judgement &judgement,
                    const std::vector<BodySymmetry> &symmetries) {
  using nlohmann::ordered_json;
  ordered_json out;
  const double dof =
      static_cast<double>(answer.measurements) - static_cast<double>(answer.unknowns);
  out["program"] = "umov";
  out["version"] = version;
  out["question"] = question;
  out["verdict"] = name_of(judgement.verdict);
  out["chi2"] = answer.chi2;
  out["dof"] = dof;
  out["p_value"] = chi2_probability(answer.chi2, dof);
  out["floor"] = answer.errors.floor;
  out["model_error"] = answer.model_error;
  out["related_numbers"] = answer.related;
  out["log_evidence"] = answer.log_evidence;
  out["evidences_apart"] = answer.evidences_apart;
  out["families"] = judgement.families.count;
  out["heaviest"] = judgement.families.heaviest;
  out["spread_deg"] = judgement.families.spread_deg;
  out["share_of_so3"] = answer.share_of_so3;
  out["epochs"] = judgement.epochs;
  out["epochs_searched"] = judgement.epochs_searched;
  out["settled"] = answer.is_settled;
  out["effective_samples"] = answer.effective;
  if (judgement.light_between)
    out["light_between"] = *judgement.light_between;
  else
    out["light_between"] = nullptr;
  out["light_between_fitted"] = judgement.is_between_fitted;
  out["axis_spread_deg"] = judgement.axis_spread_deg;
  ordered_json modes = ordered_json::array();
  for (const PoseMode &mode : answer.modes) {
    const Quaternion q = mode.turning.attitude;
    modes.push_back({{"weight", mode.weight},
                     {"q", {q.w, q.x, q.y, q.z}},
                     {"sd_deg", mode.sd_rad() * 180 / pi},
                     {"chi2", mode.chi2},
                     {"scale", mode.scale}});
  }
  out["modes"] = modes;
  put_symmetries_and_null_test(symmetries, judgement.null_test, out);
  out["contributions"] = contributions_json(judgement.contributions);
  ordered_json unknowns = ordered_json::array();
  const std::size_t first = judgement.nuisances.size() - judgement.fitted.size();
  for (std::size_t k = 0; k < judgement.nuisances.size(); ++k) {
    const Parameter &p = judgement.nuisances[k];
    unknowns.push_back(
        {{"name", p.name}, {"unit", p.unit}, {"prior", name_of(p.prior)}, {"sd", p.sd}});
    if (k >= first) // of the best attitude
      unknowns.back()["value"] = p.sd * judgement.fitted[k - first];
  }
  out["nuisances"] = unknowns;
  out["notes"] = judgement.notes;
  return out.dump(1) + "\n";
}

namespace {

/// How far each axis of the body is known.
std::string axes_words(const Judgement &judgement) {
  std::string out = "; body axes:";
  constexpr double unknown_deg = 45;
  for (std::size_t k = 0; k < 3; ++k) {
    const double spread = judgement.axis_spread_deg[k];
    out += spread < unknown_deg ? fmt::format(" +{} to {:.2g} deg", "XYZ"[k], spread)
                                : fmt::format(" +{} not known", "XYZ"[k]);
    out += k < 2 ? "," : "";
  }
  return out;
}

/// What no chi-square tells: lobes that are a fifth off are fitted well by an attitude beside.
std::string what_it_rests_on(const Judgement &judgement) {
  const bool is_by_part = !judgement.fitted.empty();
  std::string out = is_by_part ? "- this holds for materials that are right to --slope-sd, "
                                 "--reflectance-sd and --haze-sd, for surfaces that are aligned to "
                                 "--tilt-sd, and for a shape that is right to --floor"
                               : "- this holds for materials and a shape that are right to --floor";
  if (judgement.light_between.value_or(0) > 0)
    out += fmt::format(
        "; light from surface to surface, {:.2g} of I in the median, {}", *judgement.light_between,
        judgement.is_between_fitted ? "is in the fit, to a tenth of it" : "is left out");
  if (!is_by_part)
    out += "; where materials are known to a tenth or a fifth, ask again with a --floor of 0.3";
  return out + "\n";
}

} // namespace

std::string summary_of(const PoseAnswer &answer, const Judgement &judgement) {
  const double dof =
      static_cast<double>(answer.measurements) - static_cast<double>(answer.unknowns);
  const Families &families = judgement.families;
  // Weights among fits that all miss the data are no probabilities of anything.
  std::string out =
      judgement.verdict == Verdict::NoFit
          ? std::string("no_fit: nothing is known of the attitude; the table has what misses the "
                        "data least\n")
          : fmt::format("{}: {}, twins of the body counted as one; the heaviest holds {:.3g} % of "
                        "the probability, within {} deg (root mean square). 95 % set: {} % of "
                        "all attitudes\n",
                        name_of(judgement.verdict), counted(families.count, "attitude"),
                        100 * families.heaviest, in_digits(families.spread_deg),
                        percent(answer.share_of_so3));
  out += fit_words(answer.chi2, dof);
  if (judgement.verdict != Verdict::NoFit)
    out += axes_words(judgement);
  out += "\n";
  for (const std::string &text : judgement.notes)
    out += "- " + text + "\n";
  if (judgement.verdict == Verdict::Determined)
    out += what_it_rests_on(judgement);
  return out;
}

} // namespace umov::jobs
