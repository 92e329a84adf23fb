#include "jobs/health_words.h"

#include "jobs/curve_limits.h"
#include "jobs/fit_figures.h"
#include "jobs/u_null_test.h"
#include "jobs/verdict_json.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <umov/core/version.h>

namespace umov::jobs {
namespace {

constexpr double whole = 1; // a change by all of a group
constexpr double alarm = 3; // standard deviations

bool is_visible(const HealthRow &row) { return row.change_err > 0 && row.detectable < whole; }

/// A part of a group lies between none and all of it; counted from a baseline it may also be less.
bool could_be(const HealthRow &row, bool has_baseline) {
  const double least = has_baseline ? -whole : 0;
  return row.change > least - alarm * row.change_err && row.change < whole + alarm * row.change_err;
}

const char *seen_of(const HealthRow &row, Verdict verdict) {
  if (verdict == Verdict::NoFit)
    return "no fit";
  if (!is_visible(row))
    return "not visible";
  return std::abs(row.sigma) > alarm ? "changed" : "no change";
}

/// No change, nor any single one, explains the data.
bool is_misfit(const Health &health) {
  double best = health.chi2;
  for (const HealthRow &row : health.rows)
    best = std::min(best, health.chi2 - row.chi2_gain);
  const double dof = static_cast<double>(health.measurements) - 2;
  constexpr double unlikely = 1e-6;
  return dof > 0 && best > 2 * dof && chi2_probability(best, dof) < unlikely;
}

/// A change without the digits that its error leaves open: what is left of 0 is 0.
double rounded(const HealthRow &row) {
  const double step = row.change_err / 100;
  return std::round(row.change / step) * step + 0.0;
}

} // namespace

Table health_table(const Health &health, Verdict verdict) {
  std::vector<std::string> name, seen;
  std::vector<double> change, error, sigma, detectable;
  for (const HealthRow &row : health.rows) {
    const bool has_light = row.change_err > 0;
    name.push_back(row.name);
    change.push_back(has_light ? row.change : std::nan(""));
    error.push_back(has_light ? row.change_err : std::nan(""));
    sigma.push_back(row.sigma);
    detectable.push_back(has_light ? row.detectable : std::nan(""));
    seen.emplace_back(seen_of(row, verdict));
  }
  Table out;
  out.add("parameter", "", "group and what it may be turning into", std::move(name));
  out.add("change", "", "part of the group that looks like it, the rest as in the scenario",
          std::move(change));
  out.add("change_err", "", "standard deviation", std::move(error));
  out.add("sigma", "", "change over its error", std::move(sigma));
  out.add("detectable", "", "smallest change that shows at 3 sigma", std::move(detectable));
  out.add("seen", "", "changed, no change, not visible in these observations, or no fit: not known",
          std::move(seen));
  note_conventions(out);
  return out;
}

Table parts_table(const std::vector<PartHealth> &parts) {
  std::vector<std::string> name, bands, measured;
  std::vector<double> change, error, sigma, detectable;
  for (const PartHealth &one : parts)
    for (const HealthRow &row : one.health.rows) {
      const bool has_light = row.change_err > 0;
      name.push_back(row.name);
      bands.push_back(one.part.bands);
      measured.push_back(one.part.measured);
      change.push_back(has_light ? row.change : std::nan(""));
      error.push_back(has_light ? row.change_err : std::nan(""));
      sigma.push_back(row.sigma);
      detectable.push_back(has_light ? row.detectable : std::nan(""));
    }
  Table out;
  out.add("parameter", "", "group and what it may be turning into", std::move(name));
  out.add("bands", "", "all, or one", std::move(bands));
  out.add("measured", "", "I, or I, q and u", std::move(measured));
  out.add("change", "", "by this part of the data alone", std::move(change));
  out.add("change_err", "", "standard deviation", std::move(error));
  out.add("sigma", "", "change over its error", std::move(sigma));
  out.add("detectable", "", "smallest change that shows at 3 sigma", std::move(detectable));
  note_conventions(out);
  return out;
}

std::string health_page(const std::string &title, const Table &fit, const Health &health,
                        const std::vector<PartHealth> &parts, const std::string &summary) {
  std::vector<PlotFigure> figures;
  add_data_figures(figures, fit);
  FittedNumbers numbers{{}, health.joint, health.joint_covariance};
  std::vector<std::string> lines = page_lines(summary);
  for (std::size_t k = 0; k < health.rows.size(); ++k) {
    const HealthRow &row = health.rows[k];
    numbers.name.push_back("change " + row.name);
    lines.push_back(is_visible(row)
                        ? fmt::format("{}: {:.3g} +- {:.2g} of the group; the smallest change that "
                                      "shows at 3 sigma is {:.2g}",
                                      row.name, rounded(row), row.change_err, row.detectable)
                        : row.name + ": not visible");
    std::vector<PartAnswer> answers;
    for (const PartHealth &one : parts)
      if (const HealthRow &said = one.health.rows[k]; said.change_err > 0)
        answers.push_back({one.part.name(), said.change, said.change_err});
    if (!answers.empty())
      figures.push_back(parts_figure("What each band and Stokes component says of " + row.name,
                                     "change " + row.name, answers));
  }
  add_error_figures(figures, numbers);
  const auto page = make_answer_page(title, figures, lines);
  return page ? *page : std::string();
}

std::string json_of(const Health &health, const NullTest &u, Verdict verdict,
                    const std::vector<std::string> &notes) {
  using nlohmann::ordered_json;
  ordered_json out;
  out["program"] = "umov";
  out["version"] = version;
  out["question"] = "health";
  out["verdict"] = name_of(verdict);
  out["chi2_without_change"] = health.chi2;
  out["measurements"] = health.measurements;
  ordered_json list = ordered_json::array();
  for (const HealthRow &row : health.rows)
    list.push_back({{"parameter", row.name},
                    {"change", row.change},
                    {"change_err", row.change_err},
                    {"sigma", row.sigma},
                    {"detectable", row.detectable},
                    {"chi2_gain", row.chi2_gain},
                    {"settled", row.is_settled},
                    {"visible", is_visible(row)}});
  out["health"] = list;
  put_null_test(u, out);
  out["notes"] = notes;
  return out.dump(1) + "\n";
}

Verdict verdict_of(const Health &health, const Health *baseline) {
  if (is_misfit(health) || (baseline != nullptr && is_misfit(*baseline)))
    return Verdict::NoFit;
  std::size_t changed = 0, impossible = 0;
  for (const HealthRow &row : health.rows)
    if (is_visible(row) && std::abs(row.sigma) > alarm) {
      ++changed;
      impossible += could_be(row, baseline != nullptr) ? 0u : 1u;
    }
  if (changed > 0)
    return changed == 1 && impossible == 0 ? Verdict::Determined : Verdict::Ambiguous;
  return std::ranges::any_of(health.rows, is_visible) ? Verdict::Determined : Verdict::Undetermined;
}

std::vector<std::string> notes_of(const Health &health, const Health *baseline, Verdict verdict,
                                  const NullTest &u, const NullTest &u_before,
                                  const ObservedCurve &curve, const CurveErrors &errors) {
  std::vector<std::string> out = limits_of(curve, errors, Asked::Part);
  std::size_t changed = 0;
  for (const HealthRow &row : health.rows) {
    if (verdict == Verdict::NoFit)
      break; // no row says anything
    if (!is_visible(row)) {
      out.push_back(row.name + ": not visible in these observations, whatever happened to it");
      continue;
    }
    if (!row.is_settled)
      out.push_back(fmt::format("{}: more of it than {:.3g} would leave rows that were measured "
                                "without light, and the data ask for more: the attitude may not "
                                "be the scenario's",
                                row.name, row.change));
    changed += std::abs(row.sigma) > alarm ? 1u : 0u;
    if (std::abs(row.sigma) > alarm && !could_be(row, baseline != nullptr))
      out.push_back(fmt::format("{}: a part of {:.3g} cannot be: something else has changed, or "
                                "the attitude is not the scenario's",
                                row.name, row.change));
  }
  if (changed > 1)
    out.emplace_back("each of several changes explains the data by itself: which one it is, these "
                     "observations do not tell");
  if (verdict == Verdict::NoFit && baseline != nullptr && is_misfit(*baseline))
    out.emplace_back("none of these changes explains the baseline within its errors and --floor: "
                     "changes cannot be counted from it");
  else if (verdict == Verdict::NoFit)
    out.emplace_back("none of these changes explains the data within their errors and --floor: is "
                     "the attitude right, and the object?");
  note_null_test(u, out);
  note_null_test(u_before, out, "the baseline: ");
  if (errors.has_clouds)
    out.emplace_back("--clouds is not looked at here: the sky is taken for clear");
  return out;
}

} // namespace umov::jobs
