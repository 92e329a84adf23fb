#include "jobs/identify_tables.h"

#include "jobs/curve_limits.h"
#include "jobs/invert_tables.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <umov/core/text.h>
#include <umov/core/version.h>

namespace umov::jobs {
namespace {

double dof_of(const PoseAnswer &answer) {
  return static_cast<double>(answer.measurements) - static_cast<double>(answer.unknowns);
}

const CandidateFit &best_of(const IdentityWords &words) {
  return words.answer->candidates[best_searched(*words.answer)];
}

const std::string &best_name(const IdentityWords &words) {
  return words.names[best_searched(*words.answer)];
}

/// That of the best fit of own light: tables are wrong by some per cent anyway.
std::optional<double> chance_of_bad_own_fit(const CandidateFit &best, const CurveErrors &errors) {
  return best.by == JudgedBy::Model ? chance_of_bad_fit(best.answer, errors) : std::nullopt;
}

/// How many objects a quick look alone left behind, which is less sure than a search.
std::string left_behind(const IdentityAnswer &answer) {
  const auto count = std::ranges::count_if(answer.candidates, [](const CandidateFit &fit) {
    return fit.by == JudgedBy::Look && std::isnan(fit.peak);
  });
  return count > 0 ? fmt::format("; by a quick look alone {} stayed behind",
                                 counted(static_cast<std::size_t>(count), "object"))
                   : "";
}

/// A probability in words; what is left of e^-700 is no number to tell anybody.
std::string chance(double probability) {
  constexpr double told = 1e-4;
  return probability > 0 && probability < told ? "< 0.01 %" : percent(probability) + " %";
}

/// How an object was judged, in a word.
const char *judged_by(const CandidateFit &fit) {
  return fit.is_unasked ? "unasked" : name_of(fit.by);
}

} // namespace

std::size_t best_searched(const IdentityAnswer &answer) {
  return *std::ranges::find_if(
      answer.order, [&](std::size_t k) { return answer.candidates[k].by != JudgedBy::Look; });
}

Table identity_table(const IdentityWords &words) {
  const IdentityAnswer &answer = *words.answer;
  std::vector<std::string> name, by;
  std::vector<double> probability, log_evidence, chi2, look;
  bool has_none = false;
  const auto add_none = [&] {
    has_none = true;
    name.emplace_back(none_of_these);
    by.emplace_back("kin");
    probability.push_back(answer.none);
    log_evidence.push_back(answer.none_log_evidence);
    chi2.push_back(std::nan(""));
    look.push_back(std::nan(""));
  };
  for (const std::size_t k : answer.order) {
    const CandidateFit &fit = answer.candidates[k];
    if (!has_none && answer.none > fit.probability)
      add_none();
    name.push_back(words.names[k]);
    by.emplace_back(judged_by(fit));
    probability.push_back(fit.probability);
    log_evidence.push_back(fit.log_evidence);
    chi2.push_back(fit.by == JudgedBy::Look ? std::nan("") : fit.answer.chi2);
    look.push_back(fit.look);
  }
  if (!has_none)
    add_none();
  Table out;
  out.add("name", "", "of the object in the library", std::move(name));
  out.add("probability", "",
          "they add up to 1; 0 for what was left out, but where it may still be the one",
          std::move(probability));
  out.add("by", "",
          "look: left behind by it; table: its signature; model: its own light; "
          "unasked: may be it, its own light was not asked; kin: see docs/theory/inverse.md",
          std::move(by));
  out.add("log_evidence", "", "ln of the evidence, up to one constant", std::move(log_evidence));
  out.add("chi2", "", "of its best attitude", std::move(chi2));
  out.add("log_look", "", "ln evidence of the quick look", std::move(look));
  return out;
}

Verdict verdict_of(const IdentityAnswer &answer, const ObservedCurve &curve,
                   const CurveErrors &errors) {
  constexpr double sure = 0.95;
  const CandidateFit &best = answer.candidates[best_searched(answer)];
  const bool is_open = answer.is_cut || answer.unasked > 0;
  if (!is_open && answer.unsettled == 0 && answer.none > sure && curve.epochs.size() > 1)
    return Verdict::NoFit;
  if (is_steady(curve, errors) || is_open || answer.none > best.probability ||
      chance_of_bad_own_fit(best, errors))
    return Verdict::Undetermined;
  // A table knows an object to some per cent: what is like it as closely takes its name.
  const bool has_own = best.by == JudgedBy::Model;
  return best.probability > sure && has_own && curve.epochs.size() > 1 ? Verdict::Determined
                                                                       : Verdict::Ambiguous;
}

std::vector<std::string> notes_of(const IdentityWords &words, const ObservedCurve &curve,
                                  const CurveErrors &errors) {
  std::vector<std::string> out = limits_of(curve, errors, Asked::Attitude);
  const CandidateFit &best = best_of(words);
  if (best.by == JudgedBy::Table)
    out.push_back(fmt::format(
        "{} was judged through the library's table, whose light is off by {} % between its "
        "directions: an object that differs from it by less cannot be told from it. Name its "
        "scenario (--objects) and its own light decides",
        printable(best_name(words)), percent(words.table_errors[best_searched(*words.answer)])));
  if (words.answer->is_cut)
    out.emplace_back("objects that were left out of the search may explain the data as well as "
                     "those that were searched: it does not tell that many apart");
  if (words.answer->unasked > 0)
    out.push_back(fmt::format(
        "none of the objects that were asked for their own light explains the data, and {} more "
        "whose scenarios are named were not asked, though their tables are not known to rule them "
        "out: that it is none of these is not sure. Name fewer (--objects), those not asked first",
        words.answer->unasked));
  if (words.verdict == Verdict::Undetermined && words.answer->unsettled > 0)
    out.push_back(
        fmt::format("the search of {} in its own light did not come to rest: a better fit "
                    "may be there, and it is not sure that it is none of these",
                    counted(words.answer->unsettled, "object")));
  const double dof = dof_of(best.answer);
  const auto by_chance = chance_of_bad_own_fit(best, errors);
  if (words.verdict == Verdict::Undetermined && by_chance)
    out.push_back(fmt::format("the best fit misses the data by more than their errors (chance "
                              "{:.1g}): a better one may have been passed by, or errors and "
                              "--floor are too small, so the name is not sure",
                              *by_chance));
  constexpr double unlikely = 1e-6;
  if (best.answer.chi2 > 2 * dof && chi2_probability(best.answer.chi2, dof) < unlikely)
    out.push_back(fmt::format("{} explains the data badly: chi-square {:.4g} of {:.0f} degrees of "
                              "freedom",
                              printable(best_name(words)), best.answer.chi2, dof));
  if (words.verdict == Verdict::NoFit)
    out.push_back(
        "no object of the library in any attitude explains the data as well as one that is like "
        "them but not among them" +
        left_behind(*words.answer));
  return out;
}

std::string summary_of(const IdentityWords &words) {
  const IdentityAnswer &answer = *words.answer;
  const auto count = static_cast<std::size_t>(std::ranges::count_if(
      answer.candidates, [](const CandidateFit &fit) { return fit.by != JudgedBy::Look; }));
  std::string out = fmt::format("{}: ", name_of(words.verdict));
  constexpr double told = 0.01;
  for (const std::size_t k : answer.order)
    if (answer.candidates[k].probability > told)
      out += fmt::format("{} {}, ", printable(words.names[k]),
                         chance(answer.candidates[k].probability));
  out += fmt::format("{} {}. {} looked at, {} searched\n", none_of_these, chance(answer.none),
                     counted(words.names.size(), "object"), count);
  const PoseAnswer &fit = best_of(words).answer;
  out += printable(best_name(words)) + ": " + fit_words(fit.chi2, dof_of(fit)) + "\n";
  for (const std::string &note : words.notes)
    out += "- " + note + "\n";
  return out;
}

/// What an object was judged by, as people say it.
static std::string words_of(const std::string &by) {
  return by == "model"     ? "judged by its own light"
         : by == "table"   ? "judged by the library's table"
         : by == "unasked" ? "not asked for its own light, and it may be the one"
         : by == "kin"     ? "judged by what is like an object of the library"
                           : "by a quick look alone";
}

std::string odds_of(const IdentityWords &words) {
  constexpr std::size_t most = 10;
  const Table table = identity_table(words);
  const auto &name = std::get<std::vector<std::string>>(table.find("name")->cells);
  const auto &by = std::get<std::vector<std::string>>(table.find("by")->cells);
  std::string out;
  for (std::size_t row = 0; row < std::min(most, name.size()); ++row)
    out += fmt::format("{}: {}, ln evidence {:.1f}, {}\n", printable(name[row]),
                       chance(table.number("probability", row)), table.number("log_evidence", row),
                       words_of(by[row]));
  if (name.size() > most)
    out += fmt::format("and {} less probable: identity.ecsv has all\n",
                       counted(name.size() - most, "object"));
  return out;
}

std::string json_of(const IdentityWords &words, const std::string &library) {
  using nlohmann::ordered_json;
  const IdentityAnswer &answer = *words.answer;
  const PoseAnswer &fit = best_of(words).answer;
  ordered_json out;
  out["program"] = "umov";
  out["version"] = version;
  out["question"] = "identity";
  out["verdict"] = name_of(words.verdict);
  out["best"] = best_name(words);
  out["probability"] = best_of(words).probability;
  out["none_of_these"] = answer.none;
  out["chi2"] = fit.chi2;
  out["dof"] = dof_of(fit);
  out["p_value"] = chi2_probability(fit.chi2, dof_of(fit));
  out["log_evidence"] = best_of(words).log_evidence;
  out["none_log_evidence"] = answer.none_log_evidence;
  out["objects"] = words.names.size();
  out["library_sha256"] = library;
  out["is_cut"] = answer.is_cut;
  out["unasked"] = answer.unasked;
  out["unsettled"] = answer.unsettled;
  if (words.light_between)
    out["light_between"] = *words.light_between;
  else
    out["light_between"] = nullptr;
  out["light_between_fitted"] = words.is_between_fitted;
  out["by"] = name_of(best_of(words).by);
  ordered_json rows = ordered_json::array();
  for (const std::size_t k : answer.order)
    if (answer.candidates[k].by != JudgedBy::Look)
      rows.push_back({{"name", words.names[k]},
                      {"probability", answer.candidates[k].probability},
                      {"log_evidence", answer.candidates[k].log_evidence},
                      {"by", judged_by(answer.candidates[k])}});
  out["searched"] = rows;
  out["notes"] = words.notes;
  return out.dump(1, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

} // namespace umov::jobs
