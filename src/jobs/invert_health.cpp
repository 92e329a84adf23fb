// What has changed on an object, and what would have shown.

#include "jobs/health_words.h"
#include "jobs/invert_group.h"
#include "jobs/invert_tables.h"
#include "jobs/u_null_test.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <optional>
#include <umov/core/text.h>

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
  GroupLight::Kept kept; ///< for the same object at other times
  [[nodiscard]] Health check(const ObservedCurve &curve, const CurveErrors &errors) const {
    return check_health(curve, errors, before, changes, unknowns);
  }
};

Result<DriftedLight> light_of(const Scenario &scenario, const InvertRequest &request,
                              const HealthOptions &asked, const std::vector<Drift> &drifts,
                              const JobOptions &options, const Monitor &monitor,
                              Diagnostics &diagnostics, ManifestInput::Light &used,
                              const GroupLight::Kept &earlier = {}) {
  std::vector<InputFile> inputs;
  UMOV_ASSIGN(files, read_observations(request.observations, request.errors.has_polarization,
                                       options.threads, inputs, diagnostics));
  UMOV_ASSIGN(own, observed_light_curve(scenario, files, request.allow_old_elements, diagnostics,
                                        true, monitor.cancel));
  DriftedLight out{std::move(own), {}, {}, {}, {}};
  ObservedLightCurve &observed = out.observed;
  observed.inputs.insert(observed.inputs.end(), inputs.begin(), inputs.end());
  if (std::ranges::none_of(observed.curve.samples, [](const ObservedSample &s) { return s.i > 0; }))
    return fail(ErrorCode::BadInput,
                "no row has light above 0: changes show in I, and in q and u in parts of it",
                {request.observations.front()});
  const GroupMaterial as_it_is;
  std::vector<GroupMaterial> all{as_it_is};
  for (const Drift &drift : drifts)
    all.push_back({drift.group, drift.material});
  GroupLight light(scenario, request, observed, options, all);
  light.take(earlier);
  const std::size_t steps = drifts.size() + 4;
  monitor.advance("light of the object", 0, steps);
  UMOV_ASSIGN(before, light.of(as_it_is, monitor));
  out.before = std::move(before);
  for (const Drift &drift : drifts) {
    monitor.advance("light of the object", 1 + out.changes.size(), steps);
    UMOV_ASSIGN(after, light.of({drift.group, drift.material}, monitor));
    out.changes.push_back({drift.name, std::move(after), 1, 0});
  }
  const double sd = asked.attitude_sd_deg * pi / 180;
  constexpr double difference = 2e-3; // [rad], as in the fits of attitudes
  const Vec3<Body> axes[] = {{difference, 0, 0}, {0, difference, 0}, {0, 0, difference}};
  for (const Vec3<Body> &turn : axes)
    if (sd > 0) {
      UMOV_ASSIGN(aside, light.of(as_it_is, monitor, turn));
      out.unknowns.push_back({"attitude", std::move(aside), difference, sd});
    }
  used = light.used();
  out.kept = light.kept();
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
                                   as_before, light.kept));
    old = std::move(baseline);
    before = old->check(old->observed.curve, request.errors);
    count_from(*before, health);
    observed.inputs.insert(observed.inputs.end(), old->observed.inputs.begin(),
                           old->observed.inputs.end());
  }
  const Health *const shown = before ? &*before : nullptr;
  out.verdict = verdict_of(health, shown);
  const NullTest u = null_test_of(observed.curve, health.fitted);
  const NullTest u_before = old ? null_test_of(old->observed.curve, before->fitted) : NullTest{};
  const auto notes =
      notes_of(health, shown, out.verdict, u, u_before, observed.curve, request.errors);
  out.summary =
      fmt::format("{}: chi-square {:.4g} of {} without any change\n", name_of(out.verdict),
                  health.chi2, counted(health.measurements, "measurement"));
  for (const std::string &text : notes)
    out.summary += "- " + text + "\n";
  out.json = json_of(health, u, out.verdict, notes);
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
