#include "verb_invert.h"

#include "device_options.h"

#include <algorithm>
#include <fmt/format.h>
#include <umov/core/text.h>

namespace umov::cli {
namespace {

Result<jobs::Inversion> answer(InvertVerb &o, const InvertJob &job, Diagnostics &diagnostics) {
  const auto started = std::chrono::system_clock::now();
  UMOV_ASSIGN(scenario, read_scenario(o.scenario, o.keys()));
  std::optional<RunFolder> folder;
  if (!o.output.empty()) {
    UMOV_ASSIGN(opened, RunFolder::open(o.output, o.common.force));
    folder = std::move(opened);
  }
  settle(o);
  JobConsole console(o.common);
  UMOV_ASSIGN(found, job(scenario, o, console.monitor(o.common.verbose), diagnostics));
  if (folder)
    UMOV_TRY(jobs::write_inversion(found, scenario, manifest_of_command(o.common, started),
                                   diagnostics, *folder));
  return found;
}

Result<void> print(const jobs::Inversion &found, const InvertVerb &o) {
  if (o.common.json)
    return put("", found.json);
  if (o.common.quiet)
    return {};
  constexpr std::size_t most_rows = 20; // of a library of thousands
  const Table &first = found.tables.front().table;
  UMOV_TRY(put("", found.summary + to_text(first.part(0, std::min(first.rows(), most_rows)))));
  if (!o.output.empty())
    fmt::print("written to {}\n", printable(o.output));
  return {};
}

} // namespace

void settle(InvertVerb &o) {
  o.request.errors.has_polarization = !o.is_intensity_only;
  o.request.method = o.visibility == "rays"   ? LightMethod::Rays
                     : o.visibility == "auto" ? LightMethod::Auto
                                              : LightMethod::Masks;
}

void add_observations(CLI::App &verb, const std::shared_ptr<InvertVerb> &o) {
  CurveErrors &errors = o->request.errors;
  verb.add_option("observations", o->request.observations,
                  "Light curves (ECSV, CSV, FITS or TDM), of umov reduce, umov run or your own, or "
                  "counts of umov observe: one fit of all")
      ->required();
  verb.add_option("--outliers", errors.outlier_share, "Share of measurements that are wrong")
      ->check(CLI::Range(0.0, 0.5))
      ->capture_default_str();
  verb.add_flag("--intensity-only", o->is_intensity_only, "Leave q and u aside");
  add_model_options(verb, o);
}

void add_invert_options(CLI::App &verb, const std::shared_ptr<InvertVerb> &o) {
  add_observations(verb, o);
  verb.add_option("--grid", o->request.grid, "Attitudes that are looked at first")
      ->check(CLI::Range(1000, 5'000'000))
      ->capture_default_str();
}

void add_model_options(CLI::App &verb, const std::shared_ptr<InvertVerb> &o) {
  CurveErrors &errors = o->request.errors;
  verb.add_option("--scenario", o->scenario, "Object, materials, orbit, site and bands")
      ->required();
  verb.add_option("-o,--output", o->output, "Output folder");
  verb.add_option("--set", o->overrides, "KEY=VALUE over a key of the scenario");
  verb.add_option(
          "--floor", errors.floor,
          "Error of the model, in parts of I; half of it in q, u and (1 % at most) of the median I")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
  verb.add_option("--zero-point-sd", errors.zero_point_sd,
                  "How well the zero point of each band is known, relative")
      ->check(CLI::Range(1e-6, 100.0))
      ->capture_default_str();
  verb.add_option("--scale-sd", errors.scale_sd,
                  "How well the absolute brightness is known, relative; 0: not at all")
      ->check(CLI::Range(0.0, 100.0))
      ->capture_default_str();
  verb.add_flag("--clouds", errors.has_clouds, "Transparency is free at every epoch");
  verb.add_option("--visibility", o->visibility, "How hiding is decided: masks, auto or rays")
      ->check(CLI::IsMember({"masks", "auto", "rays"}))
      ->capture_default_str();
  verb.add_flag("--allow-old-elements", o->request.allow_old_elements,
                "Take elements over 30 days from the observations");
  verb.add_flag("--force", o->common.force, "Write into a folder that umov did not make");
  verb.add_flag("-v,--verbose", o->common.verbose, "Also say what was done");
  add_threads(verb, o->common);
  add_cache(verb, o->common);
  add_device(verb, o->common);
  add_common(verb, o->common, true);
}

void add_material_sds(CLI::App &verb, const std::shared_ptr<InvertVerb> &o) {
  jobs::MaterialErrors &errors = o->request.materials;
  const auto add = [&](const char *name, double &value, const char *text) {
    verb.add_option(name, value, text)->check(CLI::Range(0.0, 2.0))->capture_default_str();
  };
  add("--slope-sd", errors.slope,
      "How well the slopes of each material's lobe are known, in ln; 0: exactly");
  add("--reflectance-sd", errors.reflectance,
      "How well it is known what each lobe and each body reflects, in ln; 0: exactly");
  add("--haze-sd", errors.haze,
      "How well the haze of materials without a body is known, in ln; 0: exactly");
}

void add_material_errors(CLI::App &verb, const std::shared_ptr<InvertVerb> &o) {
  add_material_sds(verb, o);
  verb.add_option(
          "--tilt-sd", o->request.materials.tilt_deg,
          "How well the surfaces of each material are aligned to the body about each of its "
          "axes [deg]; 0: exactly; else it takes longer")
      ->check(CLI::Range(0.0, 2.0))
      ->capture_default_str();
  verb.add_flag("--by-group", o->request.materials.is_by_group,
                "What is not known of materials is of each group of the mesh by itself: areas and "
                "alignment of parts; takes longer");
  verb.add_option("--largest-floor", o->request.largest_floor,
                  "The floor grows with the misfit of the best attitude, up to this; 0: it stays")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
}

void answer_one(InvertVerb &o, const Exit &exit_with, const InvertJob &job) {
  watch_interrupts();
  Diagnostics diagnostics;
  const auto found = answer(o, job, diagnostics);
  report(diagnostics, o.common);
  if (!found)
    return exit_with(report(found.error()));
  const auto printed = print(*found, o);
  if (!printed)
    return exit_with(report(printed.error()));
  exit_with(found->verdict == jobs::Verdict::NoFit ? static_cast<int>(ErrorCode::Physics) : 0);
}

void run_invert(CLI::App &verb, const std::shared_ptr<InvertVerb> &o, const Exit &exit_with,
                const InvertJob &job) {
  verb.callback([o, exit_with, job] { answer_one(*o, exit_with, job); });
}

} // namespace umov::cli
