// What has changed on an object, and what would have shown.

#include "jobs/invert_group.h"
#include "jobs/invert_tables.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <umov/core/text.h>
#include <umov/core/version.h>
#include <umov/inverse/health.h>

namespace umov::jobs {
namespace {

/// A group and what it may be turning into.
struct Drift {
  std::string name, group, material;
};

Result<std::vector<Drift>> drifts_of(const std::vector<std::string> &words) {
  std::vector<Drift> out;
  for (const std::string &word : words) {
    const std::size_t equal = word.find('=');
    if (equal == word.npos || equal == 0 || equal + 1 == word.size())
      return fail(ErrorCode::Usage,
                  fmt::format("--drift {}: GROUP=MATERIAL was expected, as array_front=paint_white",
                              printable(word)));
    if (std::ranges::any_of(out, [&](const Drift &d) { return d.name == word; }))
      return fail(ErrorCode::Usage,
                  fmt::format("--drift {} stands twice; name each once", printable(word)));
    out.push_back({word, word.substr(0, equal), word.substr(equal + 1)});
  }
  return out;
}

/// Observations held against the object as the scenario has it.
Result<Health> health_of(const Scenario &scenario, const InvertRequest &request,
                         const HealthOptions &asked, const std::vector<Drift> &drifts,
                         const JobOptions &options, const Monitor &monitor,
                         Diagnostics &diagnostics, ObservedLightCurve &observed,
                         ManifestInput::Light &used) {
  std::vector<InputFile> inputs;
  UMOV_ASSIGN(files, read_observations(request.observations, inputs, diagnostics));
  UMOV_ASSIGN(own, observed_light_curve(scenario, files, request.allow_old_elements, diagnostics));
  observed = std::move(own);
  observed.inputs.insert(observed.inputs.end(), inputs.begin(), inputs.end());
  if (std::ranges::none_of(observed.curve.samples, [](const ObservedSample &s) { return s.i > 0; }))
    return fail(ErrorCode::BadInput,
                "no row has light above 0: changes show in I, and in q and u in parts of it",
                {request.observations.front()});
  GroupLight light(scenario, request, observed, options);
  const std::size_t steps = drifts.size() + 4;
  monitor.advance("light of the object", 0, steps);
  UMOV_ASSIGN(before, light.of("", "", monitor));
  std::vector<LightChange> changes, unknowns;
  for (const Drift &drift : drifts) {
    monitor.advance("light of the object", 1 + changes.size(), steps);
    UMOV_ASSIGN(after, light.of(drift.group, drift.material, monitor));
    changes.push_back({drift.name, std::move(after), 1, 0});
  }
  const double sd = asked.attitude_sd_deg * pi / 180;
  constexpr double difference = 2e-3; // [rad], as in the fits of attitudes
  const Vec3<Body> axes[] = {{difference, 0, 0}, {0, difference, 0}, {0, 0, difference}};
  for (const Vec3<Body> &turn : axes)
    if (sd > 0) {
      UMOV_ASSIGN(aside, light.of("", "", monitor, turn));
      unknowns.push_back({"attitude", std::move(aside), difference, sd});
    }
  used = light.used();
  return check_health(observed.curve, request.errors, before, changes, unknowns);
}

/// Changes from what the baseline showed.
void count_from(const Health &baseline, Health &health) {
  for (std::size_t k = 0; k < health.rows.size(); ++k) {
    HealthRow &row = health.rows[k];
    row.change -= baseline.rows[k].change;
    row.change_err = std::hypot(row.change_err, baseline.rows[k].change_err);
    row.sigma = row.change_err > 0 ? row.change / row.change_err : 0;
    row.detectable = 3 * row.change_err;
  }
}

constexpr double whole = 1; // a change by all of a group
constexpr double alarm = 3; // standard deviations

bool is_visible(const HealthRow &row) { return row.change_err > 0 && row.detectable < whole; }

Table health_table(const Health &health) {
  std::vector<std::string> name, seen;
  std::vector<double> change, error, sigma, detectable;
  for (const HealthRow &row : health.rows) {
    const bool has_light = row.change_err > 0;
    name.push_back(row.name);
    change.push_back(has_light ? row.change : std::nan(""));
    error.push_back(has_light ? row.change_err : std::nan(""));
    sigma.push_back(row.sigma);
    detectable.push_back(has_light ? row.detectable : std::nan(""));
    seen.emplace_back(!is_visible(row)              ? "not visible"
                      : std::abs(row.sigma) > alarm ? "changed"
                                                    : "no change");
  }
  Table out;
  out.add("parameter", "", "group and what it may be turning into", std::move(name));
  out.add("change", "", "part of the group that looks like it, the rest as in the scenario",
          std::move(change));
  out.add("change_err", "", "standard deviation", std::move(error));
  out.add("sigma", "", "change over its error", std::move(sigma));
  out.add("detectable", "", "smallest change that shows at 3 sigma", std::move(detectable));
  out.add("seen", "", "changed, no change, or not visible in these observations", std::move(seen));
  note_conventions(out);
  return out;
}

std::string json_of(const Health &health, Verdict verdict, const std::vector<std::string> &notes) {
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
                    {"visible", is_visible(row)}});
  out["health"] = list;
  out["notes"] = notes;
  return out.dump(1) + "\n";
}

/// One change explains the data; several do; none was needed, or could be seen; nothing does.
Verdict verdict_of(const Health &health) {
  double best = health.chi2;
  std::size_t changed = 0;
  for (const HealthRow &row : health.rows) {
    best = std::min(best, health.chi2 - row.chi2_gain);
    changed += is_visible(row) && std::abs(row.sigma) > alarm ? 1u : 0u;
  }
  const double dof = static_cast<double>(health.measurements) - 2;
  constexpr double unlikely = 1e-6;
  if (dof > 0 && best > 2 * dof && chi2_probability(best, dof) < unlikely)
    return Verdict::NoFit;
  if (changed > 0)
    return changed == 1 ? Verdict::Determined : Verdict::Ambiguous;
  return std::ranges::any_of(health.rows, is_visible) ? Verdict::Determined : Verdict::Undetermined;
}

std::vector<std::string> notes_of(const Health &health, Verdict verdict, const ObservedCurve &curve,
                                  const CurveErrors &errors) {
  std::vector<std::string> out = limits_of(curve);
  for (const HealthRow &row : health.rows)
    if (!is_visible(row))
      out.push_back(row.name + ": not visible in these observations, whatever happened to it");
    else if (std::abs(row.sigma) > alarm && (row.change < 0 || row.change > whole))
      out.push_back(fmt::format("{}: a part of {:.3g} cannot be: something else has changed, or "
                                "the attitude is not the scenario's",
                                row.name, row.change));
  if (verdict == Verdict::Ambiguous)
    out.emplace_back("each of several changes explains the data by itself: which one it is, these "
                     "observations do not tell");
  if (verdict == Verdict::NoFit)
    out.emplace_back("none of these changes explains the data within their errors and --floor: is "
                     "the attitude right, and the object?");
  if (errors.has_clouds)
    out.emplace_back("--clouds is not looked at here: the sky is taken for clear");
  return out;
}

} // namespace

Result<Inversion> invert_health(const Scenario &scenario, const InvertRequest &request,
                                const HealthOptions &asked, const JobOptions &options,
                                const Monitor &monitor, Diagnostics &diagnostics) {
  UMOV_ASSIGN(drifts, drifts_of(asked.drifts));
  ObservedLightCurve observed;
  Inversion out;
  UMOV_ASSIGN(health, health_of(scenario, request, asked, drifts, options, monitor, diagnostics,
                                observed, out.light));
  tell_of_device(out.light.device, diagnostics);
  if (!asked.baseline.empty()) {
    InvertRequest before = request;
    before.observations = asked.baseline;
    ObservedLightCurve old;
    ManifestInput::Light as_before;
    UMOV_ASSIGN(baseline, health_of(scenario, before, asked, drifts, options, monitor, diagnostics,
                                    old, as_before));
    count_from(baseline, health);
    observed.inputs.insert(observed.inputs.end(), old.inputs.begin(), old.inputs.end());
  }
  out.verdict = verdict_of(health);
  const auto notes = notes_of(health, out.verdict, observed.curve, request.errors);
  out.summary =
      fmt::format("{}: chi-square {:.4g} of {} without any change\n", name_of(out.verdict),
                  health.chi2, counted(health.measurements, "measurement"));
  for (const std::string &text : notes)
    out.summary += "- " + text + "\n";
  out.json = json_of(health, out.verdict, notes);
  out.tables = {{"health", health_table(health)}};
  out.inputs = observed.inputs;
  out.seed = scenario.seed;
  return out;
}

} // namespace umov::jobs
