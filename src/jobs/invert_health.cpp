// What has changed on an object, and what would have shown.

#include "jobs/curve_limits.h"
#include "jobs/fit_figures.h"
#include "jobs/invert_group.h"
#include "jobs/invert_parts.h"
#include "jobs/invert_tables.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <optional>
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

/// Observations, and the light of the object as the scenario has it, drifted and turned.
struct DriftedLight {
  ObservedLightCurve observed;
  EndMember before;
  std::vector<LightChange> changes, unknowns;
  [[nodiscard]] Health check(const ObservedCurve &curve, const CurveErrors &errors) const {
    return check_health(curve, errors, before, changes, unknowns);
  }
};

Result<DriftedLight> light_of(const Scenario &scenario, const InvertRequest &request,
                              const HealthOptions &asked, const std::vector<Drift> &drifts,
                              const JobOptions &options, const Monitor &monitor,
                              Diagnostics &diagnostics, ManifestInput::Light &used) {
  std::vector<InputFile> inputs;
  UMOV_ASSIGN(files, read_observations(request.observations, inputs, diagnostics));
  UMOV_ASSIGN(own, observed_light_curve(scenario, files, request.allow_old_elements, diagnostics));
  DriftedLight out{std::move(own), {}, {}, {}};
  ObservedLightCurve &observed = out.observed;
  observed.inputs.insert(observed.inputs.end(), inputs.begin(), inputs.end());
  if (std::ranges::none_of(observed.curve.samples, [](const ObservedSample &s) { return s.i > 0; }))
    return fail(ErrorCode::BadInput,
                "no row has light above 0: changes show in I, and in q and u in parts of it",
                {request.observations.front()});
  GroupLight light(scenario, request, observed, options);
  const std::size_t steps = drifts.size() + 4;
  monitor.advance("light of the object", 0, steps);
  UMOV_ASSIGN(before, light.of("", "", monitor));
  out.before = std::move(before);
  for (const Drift &drift : drifts) {
    monitor.advance("light of the object", 1 + out.changes.size(), steps);
    UMOV_ASSIGN(after, light.of(drift.group, drift.material, monitor));
    out.changes.push_back({drift.name, std::move(after), 1, 0});
  }
  const double sd = asked.attitude_sd_deg * pi / 180;
  constexpr double difference = 2e-3; // [rad], as in the fits of attitudes
  const Vec3<Body> axes[] = {{difference, 0, 0}, {0, difference, 0}, {0, 0, difference}};
  for (const Vec3<Body> &turn : axes)
    if (sd > 0) {
      UMOV_ASSIGN(aside, light.of("", "", monitor, turn));
      out.unknowns.push_back({"attitude", std::move(aside), difference, sd});
    }
  used = light.used();
  return out;
}

/// Changes from what the baseline showed.
void count_from(const Health &baseline, Health &health) {
  for (std::size_t k = 0; k < health.rows.size(); ++k) {
    HealthRow &row = health.rows[k];
    if (!(row.change_err > 0 && baseline.rows[k].change_err > 0)) { // nothing to count from
      row.change = row.change_err = row.sigma = row.detectable = 0;
      continue;
    }
    row.change -= baseline.rows[k].change;
    row.change_err = std::hypot(row.change_err, baseline.rows[k].change_err);
    row.sigma = row.change_err > 0 ? row.change / row.change_err : 0;
    row.detectable = 3 * row.change_err;
  }
  for (std::size_t k = 0; k < health.joint.size(); ++k)
    health.joint[k] -= baseline.joint[k];
  for (std::size_t k = 0; k < health.joint_covariance.size(); ++k)
    health.joint_covariance[k] += baseline.joint_covariance[k];
}

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

/// What a part of the data says by itself, of the observations and of the baseline if there is one.
struct PartHealth {
  DataPart part;
  Health health;
};

std::vector<PartHealth> healths_of(const DriftedLight &light, const DriftedLight *baseline,
                                   const CurveErrors &errors) {
  std::vector<PartHealth> out;
  std::vector<DataPart> before;
  if (baseline != nullptr)
    before = parts_of(baseline->observed.curve, errors.has_polarization);
  for (const DataPart &part : parts_of(light.observed.curve, errors.has_polarization)) {
    PartHealth one{part, light.check(part.curve, errors)};
    if (baseline != nullptr) {
      const auto same = std::ranges::find(before, part.name(), &DataPart::name);
      if (same == before.end())
        continue; // nothing to count from
      count_from(baseline->check(same->curve, errors), one.health);
    }
    out.push_back(std::move(one));
  }
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
                                      row.name, row.change, row.change_err, row.detectable)
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
  const auto page = make_plot_page(title, figures, lines);
  return page ? *page : std::string();
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

/// No change, nor any single one, explains the data.
bool is_misfit(const Health &health) {
  double best = health.chi2;
  for (const HealthRow &row : health.rows)
    best = std::min(best, health.chi2 - row.chi2_gain);
  const double dof = static_cast<double>(health.measurements) - 2;
  constexpr double unlikely = 1e-6;
  return dof > 0 && best > 2 * dof && chi2_probability(best, dof) < unlikely;
}

/// One change explains the data; several do, or one that cannot be; none was needed, or could be
/// seen; nothing does. `baseline`: what it showed by itself, if there is one.
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
  if (errors.has_clouds)
    out.emplace_back("--clouds is not looked at here: the sky is taken for clear");
  return out;
}

} // namespace

Result<Inversion> invert_health(const Scenario &scenario, const InvertRequest &request,
                                const HealthOptions &asked, const JobOptions &options,
                                const Monitor &monitor, Diagnostics &diagnostics) {
  UMOV_ASSIGN(drifts, drifts_of(asked.drifts));
  Inversion out;
  UMOV_ASSIGN(light,
              light_of(scenario, request, asked, drifts, options, monitor, diagnostics, out.light));
  ObservedLightCurve &observed = light.observed;
  Health health = light.check(observed.curve, request.errors);
  std::optional<DriftedLight> old;
  std::optional<Health> before;
  tell_of_device(out.light.device, diagnostics);
  if (!asked.baseline.empty()) {
    InvertRequest earlier = request;
    earlier.observations = asked.baseline;
    ManifestInput::Light as_before;
    UMOV_ASSIGN(baseline, light_of(scenario, earlier, asked, drifts, options, monitor, diagnostics,
                                   as_before));
    old = std::move(baseline);
    before = old->check(old->observed.curve, request.errors);
    count_from(*before, health);
    observed.inputs.insert(observed.inputs.end(), old->observed.inputs.begin(),
                           old->observed.inputs.end());
  }
  const Health *const shown = before ? &*before : nullptr;
  out.verdict = verdict_of(health, shown);
  const auto notes = notes_of(health, shown, out.verdict, observed.curve, request.errors);
  out.summary =
      fmt::format("{}: chi-square {:.4g} of {} without any change\n", name_of(out.verdict),
                  health.chi2, counted(health.measurements, "measurement"));
  for (const std::string &text : notes)
    out.summary += "- " + text + "\n";
  out.json = json_of(health, out.verdict, notes);
  const auto parts = healths_of(light, old ? &*old : nullptr, request.errors);
  out.tables = {{"health", health_table(health, out.verdict)},
                {"parts", parts_table(parts)},
                {"fit", fit_table(observed, health.fitted, request.errors)}};
  out.page = health_page("What has changed on " + scenario.objects.front().name,
                         out.tables[2].table, health, parts, out.summary);
  out.inputs = observed.inputs;
  out.seed = scenario.seed;
  return out;
}

} // namespace umov::jobs
