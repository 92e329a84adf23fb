#include <umov/jobs/invert.h>

#include "jobs/curve_questions.h"
#include "jobs/invert_between.h"
#include "jobs/invert_page.h"
#include "jobs/invert_tables.h"
#include "jobs/searched_curve.h"

#include <fmt/format.h>

namespace umov::jobs {

Result<Inversion> invert_pose(const Scenario &scenario, const InvertRequest &request,
                              const JobOptions &options, const Monitor &monitor,
                              Diagnostics &diagnostics) {
  UMOV_ASSIGN(ready, prepare(scenario, request, options, diagnostics, monitor.cancel));
  UMOV_TRY(take_coarse(ready, scenario, request, options, monitor.cancel));
  take_apart(ready, request, options, diagnostics, monitor.cancel);
  UMOV_ASSIGN(out,
              pose_answer(scenario, request, options, ready.observed, ready, monitor, diagnostics));
  keep_masks(ready);
  return std::move(out);
}

Result<Inversion> pose_answer(const Scenario &scenario, const InvertRequest &request,
                              const JobOptions &options, const ObservedLightCurve &observed,
                              const SearchedLight &ready, const Monitor &monitor,
                              Diagnostics &diagnostics) {
  const auto light = lighting_of(ready.light, options.threads, monitor);
  const auto quick_light = quick_lighting(ready, options.threads, monitor);
  const ObservedCurve searched =
      searched_curve(observed.curve, ready.light.model().scene(), request.errors);
  const auto last_light = searched_lighting(ready, options.threads, monitor);
  const CurveModel model(searched, last_light, observed.column, parts_of(ready));
  const CurveModel whole(observed.curve, last_light, observed.column, parts_of(ready));
  const CurveModel first(searched, first_lighting(ready, options.threads, monitor), observed.column,
                         parts_of(ready));
  const CurveModel quick(searched, quick_light, observed.column);
  UMOV_ASSIGN(answer, search_pose({model, first, quick},
                                  search_options(scenario, request, options, monitor)));
  const auto symmetries = find_symmetries(light, scenario.seed);
  Judgement judgement = judge(answer, model, whole, request.errors, symmetries);
  UMOV_TRY(judge_direct_light(scenario, request, ready, observed.curve, answer, options, monitor,
                              judgement));
  Inversion out;
  out.verdict = judgement.verdict;
  out.summary = summary_of(answer, judgement);
  out.json = json_of("pose", answer, judgement, symmetries);
  out.tables = {{"modes", modes_table(answer, false)},
                {"set95", set_table(answer)},
                {"samples", samples_table(answer, false)},
                {"twins", twins_table(answer, symmetries)},
                {"fit", fit_table(observed, whole, answer)},
                {"contributions", contributions_table(judgement.contributions)}};
  note_start(out.tables.front().table, body_words(ready.light.model().scene()), observed, answer,
             judgement);
  out.page = inversion_page("Which attitude: " + scenario.title, out.tables[4].table, answer,
                            out.verdict, judgement.contributions, out.summary);
  out.inputs = observed.inputs;
  out.seed = scenario.seed;
  out.light = light_used(ready, scenario, diagnostics);
  monitor.tell(fmt::format("{} poses lit", answer.poses_lit));
  return out;
}

std::vector<NamedTable> no_pose_tables() {
  const PoseAnswer none;
  return {{"modes", modes_table(none, false)},     {"set95", set_table(none)},
          {"samples", samples_table(none, false)}, {"twins", twins_table(none, {})},
          {"fit", fit_table({}, EndMember(), {})}, {"contributions", contributions_table({})}};
}

std::string text_of(const InvertRequest &request) {
  const CurveErrors &e = request.errors;
  return fmt::format(
      "grid {} method {} old {}; errors {:.17g} {:.17g} {:.17g} {:.17g} {:.17g} {} "
      "{:.17g} {:.17g} {}; materials {:.17g} {:.17g} {:.17g} tilt {:.17g} by group {} "
      "floor {:.17g}",
      request.grid, name_of(request.method), request.allow_old_elements, e.floor, e.floor_q,
      e.of_median(), e.zero_point_sd, e.scale_sd, e.has_clouds, e.outlier_share, e.outlier_factor,
      e.has_polarization, request.materials.slope, request.materials.reflectance,
      request.materials.haze, request.materials.tilt_deg, request.materials.is_by_group,
      request.largest_floor);
}

Result<void> write_inversion(const Inversion &inversion, const Scenario &scenario,
                             ManifestInput manifest, const Diagnostics &diagnostics,
                             RunFolder &folder) {
  const auto add = [&](const std::string &name, std::string bytes) {
    manifest.files.push_back(name);
    folder.add(name, std::move(bytes));
  };
  for (const NamedTable &one : inversion.tables)
    add(one.name + ".ecsv", to_ecsv(one.table));
  add("verdict.json", inversion.json);
  if (!inversion.state.empty())
    add("state.json", inversion.state);
  if (!inversion.page.empty())
    add("report.html", inversion.page);
  add("scenario.lock.toml", locked_scenario(scenario));
  std::string log = inversion.summary;
  for (const Warning &warning : diagnostics.warnings()) {
    log += "warning: " + warning.text() + "\n";
    manifest.warnings.push_back(warning.text());
  }
  add("log.txt", std::move(log));
  for (const InputFile &input : inversion.inputs)
    manifest.inputs.emplace_back(input.path, input.sha256);
  manifest.seed = inversion.seed;
  if (!inversion.light.object.empty()) // a library's light was made before
    manifest.light.push_back(inversion.light);
  folder.add("manifest.json", make_manifest(manifest));
  return folder.commit();
}

} // namespace umov::jobs
