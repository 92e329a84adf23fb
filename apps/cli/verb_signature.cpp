#include "console.h"
#include "signature_rows.h"
#include "tables.h"
#include "verbs.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <future>
#include <optional>
#include <set>
#include <umov/core/files.h>
#include <umov/core/parallel.h>
#include <umov/io/scenario.h>
#include <umov/io/table_stream.h>
#include <umov/light/engine.h>
#include <umov/light/poses.h>
#include <umov/light/thermal.h>

namespace umov::cli {
namespace {

struct SignatureOptions {
  std::string scene, geometry, output;
  std::vector<std::string> overrides;
  std::vector<double> phases_deg;
  std::size_t poses = 0;
  std::uint64_t seed = 0;
  bool has_seed = false;
  double accuracy = 0;
  std::string visibility = "auto";
  std::string masks; ///< file to keep them in
  std::string source = "sun";
  std::vector<double> state{1, 0, 0, 0};
  std::vector<std::string> temperatures; ///< K, or group=K
};

/// Radius of the Sun's disk seen from 1 au: a signature has no distance.
constexpr double solar_radius_rad = 0.2665 * pi / 180;

/// Stokes vector of the source per unit irradiance.
Result<Stokes<ScatteringPlane>> source_of(const SignatureOptions &o) {
  const Stokes<ScatteringPlane> s{o.state[0], o.state[1], o.state[2], o.state[3]};
  const double polarized = std::sqrt(s.q * s.q + s.u * s.u + s.v * s.v);
  if (o.source != "laser" && polarized > 0)
    return fail(ErrorCode::Usage, "--state goes with --source laser");
  if (!(s.i > 0) || !(polarized <= s.i * (1 + 1e-12)))
    return fail(ErrorCode::Usage,
                fmt::format("--state {} {} {} {}: I > 0 and sqrt(Q2 + U2 + V2) <= I were expected",
                            s.i, s.q, s.u, s.v));
  return s * (1 / s.i);
}

/// [K] of each mesh group, from "300" for all and "panels=340" for one.
Result<std::vector<double>> temperatures_of(const SignatureOptions &o, const Mesh &mesh) {
  std::vector<double> out(mesh.groups.size(), std::numeric_limits<double>::quiet_NaN());
  std::set<std::string> told;
  for (const std::string &text : o.temperatures) {
    const std::size_t equals = text.rfind('=');
    const std::string group = equals == std::string::npos ? "" : text.substr(0, equals);
    const std::string number = equals == std::string::npos ? text : text.substr(equals + 1);
    double kelvin = 0;
    const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), kelvin);
    if (error != std::errc() || end != number.data() + number.size() || !(kelvin >= 0) ||
        !std::isfinite(kelvin) || equals == 0)
      return fail(ErrorCode::Usage,
                  fmt::format("--temperature {}: K of all, or GROUP=K, was expected", text));
    const auto found = std::find(mesh.groups.begin(), mesh.groups.end(), group);
    if (!group.empty() && found == mesh.groups.end())
      return fail(ErrorCode::Usage, fmt::format("--temperature {}: the mesh has the groups {}",
                                                text, fmt::join(mesh.groups, ", ")));
    if (!told.insert(group).second)
      return fail(ErrorCode::Usage,
                  fmt::format("--temperature {}: that was said before; once was expected", text));
    for (std::size_t g = 0; g < out.size(); ++g)
      if (group.empty() ? std::isnan(out[g]) : mesh.groups[g] == group)
        out[g] = kelvin;
  }
  for (std::size_t g = 0; g < out.size(); ++g)
    if (std::isnan(out[g]))
      return fail(ErrorCode::Usage,
                  fmt::format("--source thermal: how warm is \"{}\"? Give --temperature K for all "
                              "groups, or {}=K",
                              mesh.groups[g], mesh.groups[g]));
  return out;
}

/// A direction of any length but 0, from three columns.
Result<Vec3<Body>> direction_from(const Table &table, const std::string &name, std::size_t row,
                                  const Where &where) {
  const Vec3<Body> v{table.number(name + "_x", row), table.number(name + "_y", row),
                     table.number(name + "_z", row)};
  const double largest = std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
  if (!(largest > 0))
    return fail(ErrorCode::BadInput,
                fmt::format("{0}_x, {0}_y, {0}_z are 0; a direction was expected", name), where);
  int exponent = 0; // squares of very long or short vectors would leave the range of a double
  std::frexp(largest, &exponent);
  return normalized(Vec3<Body>{std::ldexp(v.x, -exponent), std::ldexp(v.y, -exponent),
                               std::ldexp(v.z, -exponent)});
}

/// Poses and the numbers that they have in the output.
struct NumberedPoses {
  std::vector<Pose> poses;
  std::vector<std::int64_t> number;
};

/// Rows in turn with the same number in a column "pose" are one pose: so a table that
/// `umov signature` wrote, with a row per band, gives its poses back.
Result<NumberedPoses> poses_from_table(const std::string &path) {
  UMOV_ASSIGN(text, read_file(path));
  UMOV_ASSIGN(table, read_csv(text, path, {"sun_x", "sun_y", "sun_z", "obs_x", "obs_y", "obs_z"},
                              {"pose"}));
  const bool has_pose = table.find("pose") != nullptr;
  NumberedPoses out;
  std::vector<Pose> &poses = out.poses;
  for (std::size_t i = 0; i < table.rows(); ++i) {
    const Where where{path, static_cast<std::size_t>(table.number("line", i))};
    UMOV_ASSIGN(sun, direction_from(table, "sun", i, where));
    UMOV_ASSIGN(observer, direction_from(table, "obs", i, where));
    if (has_pose && i > 0 && table.number("pose", i) == table.number("pose", i - 1)) {
      if (norm(poses.back().sun - sun) + norm(poses.back().observer - observer) > 1e-9)
        return fail(ErrorCode::BadInput,
                    fmt::format("pose {:g} has two different directions; number the poses anew or "
                                "leave the column pose out",
                                table.number("pose", i)),
                    where);
      continue;
    }
    out.number.push_back(has_pose ? static_cast<std::int64_t>(table.number("pose", i))
                                  : static_cast<std::int64_t>(poses.size()));
    poses.push_back({sun, observer});
  }
  return out;
}

/// Poses by number.
struct PoseSource {
  std::size_t count = 0;
  std::function<Pose(std::size_t)> at;
  std::function<std::int64_t(std::size_t)> number;
};

Result<void> check_phases(const SignatureOptions &o) {
  for (const double phase : o.phases_deg)
    if (!(phase >= 0 && phase <= 180))
      return fail(ErrorCode::Usage, fmt::format("--phase {}: 0 to 180 was expected", phase));
  return {};
}

/// How hiding was decided, for the header.
std::string engine_method(const EngineFacts &facts, const EngineOptions &options) {
  if (facts.is_convex)
    return "none: the mesh is convex";
  return fmt::format(
      "direction masks, {} points, {} and {} directions; rays where the half-width "
      "of I exceeds {:g} of it",
      options.masks.points, (options.masks.narrow_cells + 1) * (options.masks.narrow_cells + 1),
      (options.masks.wide_cells + 1) * (options.masks.wide_cells + 1), options.masks.refine_above);
}

/// Where the model of an active source falls short (explicit rough surfaces, docs/theory/lobes.md).
constexpr const char *laser_limits =
    "One reflection keeps the degree of polarization; light between microfacets is depolarized or "
    "keeps the single-bounce form, while explicit rough surfaces (slope 0.6, backscatter) "
    "depolarize "
    "circular light about twice as fast as linear. For very rough metals near retro-reflection the "
    "double bounce is understated.";

/// What all ways to compute have in common.
struct SignatureJob {
  const SignatureOptions &options;
  const Common &common;
  const Scenario &scenario;
  const LoadedObject &object;
  Stokes<ScatteringPlane> source;
  std::uint64_t seed = 0;
  double accuracy = 0;
  bool is_sun = true;

  [[nodiscard]] bool is_thermal() const { return options.source == "thermal"; }
  [[nodiscard]] unsigned threads() const { return static_cast<unsigned>(common.threads); }
  [[nodiscard]] double sun_radius() const {
    return is_sun && scenario.has_solar_disk ? solar_radius_rad : 0;
  }
  [[nodiscard]] IntegrationOptions integration() const {
    IntegrationOptions out;
    out.accuracy = accuracy;
    out.bounces = scenario.bounces;
    if (out.bounces > 1)
      out.max_points = 1u << 19;
    out.seed = seed;
    out.source = source;
    return out;
  }
  void describe(Table &table, const std::string &method) const {
    if (is_thermal()) {
      table.note("source", "the body's own heat: " +
                               fmt::format("{}", fmt::join(options.temperatures, ", ")) + " K");
      table.note("method", method);
      return;
    }
    table.note("source", is_sun
                             ? (scenario.has_solar_disk ? "Sun, uniform disk of 0.2665 deg radius"
                                                        : "Sun, a point")
                             : fmt::format("laser, Stokes {} {} {} {} in the scattering frame",
                                           source.i, source.q, source.u, source.v));
    if (!is_sun)
      table.note("limits", laser_limits);
    table.note("visibility", method);
  }
};

/// Pose by pose with rays, to the accuracy asked.
Result<void> run_with_rays(const SignatureJob &job, NumberedPoses numbered) {
  std::vector<Pose> &poses = numbered.poses;
  for (Pose &pose : poses)
    pose.sun_radius_rad = job.sun_radius();
  const Integrator integrator(job.object.scene);
  const IntegrationOptions options = job.integration();
  std::optional<ThermalEmission> emission;
  if (job.is_thermal()) {
    UMOV_ASSIGN(kelvin, temperatures_of(job.options, job.object.scene.mesh));
    UMOV_ASSIGN(made, ThermalEmission::make(job.object.scene, kelvin));
    emission = std::move(made);
  }
  SignatureRows rows;
  ProgressBar bar("poses", job.common);
  constexpr std::size_t block = 512; // the grain of progress
  std::size_t done = 0;
  const auto add = [&](const std::vector<BandResult> &bands, bool is_dark) {
    for (std::size_t b = 0; b < bands.size(); ++b)
      rows.add(numbered.number[done], poses[done], job.object.scene.bands[b].name, bands[b],
               is_dark);
    ++done;
  };
  for (std::size_t begin = 0; begin < poses.size() && done == begin; begin += block) {
    const std::vector<Pose> part(
        poses.begin() + static_cast<std::ptrdiff_t>(begin),
        poses.begin() + static_cast<std::ptrdiff_t>(std::min(begin + block, poses.size())));
    if (emission) {
      for (const IndirectLight &result :
           integrator.thermal(part, *emission, options, job.threads(), &interrupted()))
        add(result.bands, std::none_of(result.bands.begin(), result.bands.end(),
                                       [](const BandResult &band) { return band.stokes.i > 0; }));
    } else {
      for (const PoseResult &result :
           integrator.evaluate(part, options, job.threads(), &interrupted()))
        add(result.bands, result.is_dark);
    }
    bar.update(done, poses.size());
  }
  Table table = std::move(rows).table(job.is_thermal());
  job.describe(table, job.is_thermal()         ? "paths"
                      : integrator.is_convex() ? "none: the mesh is convex"
                                               : "rays");
  if (done == poses.size())
    return put_table(job.options.output, table, job.common);
  return tl::unexpected(put_partial_table(
      job.options.output, std::move(table), job.common,
      {ErrorCode::Interrupted,
       fmt::format("stopped by the user after {} of {} poses", done, poses.size()),
       {}}));
}

/// Before minutes are spent on what could not be kept.
Result<void> check_mask_file(const std::string &file) {
  namespace fs = std::filesystem;
  const fs::path target(file);
  const fs::path folder = target.has_parent_path() ? target.parent_path() : fs::path(".");
  std::error_code code;
  if (!file.empty() && fs::is_directory(target, code))
    return fail(ErrorCode::Device, "this is a folder; the name of a file was expected", {file});
  if (!file.empty() && !fs::is_directory(folder, code))
    return fail(ErrorCode::Device, "no such folder. Make the folder first or choose another one.",
                {folder.string()});
  return {};
}

/// Prepared, with masks from the file that the user names; made and kept there if there is none.
Result<Engine> engine_for(const SignatureJob &job, const EngineOptions &options) {
  const std::string &file = job.options.masks;
  if (!file.empty() && std::filesystem::exists(file))
    return Engine::with_masks(file, job.object.scene, options);
  Engine out(job.object.scene, options);
  if (!file.empty() && out.facts().is_convex) {
    note(job.common, "a convex body needs no masks: nothing is kept in " + file);
  } else if (!file.empty()) {
    UMOV_TRY(out.save_masks(file));
    note(job.common, "masks are kept in " + file);
  }
  return out;
}

/// Adds light between surfaces to the direct light of a block; false if it was stopped.
bool add_indirect(const Integrator &integrator, const SignatureJob &job,
                  const std::vector<Pose> &poses, StokesTable &to) {
  const auto light =
      integrator.indirect(poses, to.i, job.integration(), job.threads(), &interrupted());
  for (std::size_t k = 0; k < light.size(); ++k)
    for (std::size_t b = 0; b < to.bands; ++b) {
      const std::size_t at = k * to.bands + b;
      const auto &[more, half_width] = light[k].bands[b];
      to.i[at] += more.i;
      to.q[at] += more.q;
      to.u[at] += more.u;
      to.v[at] += more.v;
      to.i_err[at] = std::hypot(to.i_err[at], half_width.i);
      to.q_err[at] = std::hypot(to.q_err[at], half_width.q);
      to.u_err[at] = std::hypot(to.u_err[at], half_width.u);
      to.v_err[at] = std::hypot(to.v_err[at], half_width.v);
      if (more.i > 0)
        to.is_dark[k] = 0;
    }
  return light.size() == poses.size();
}

/// Block by block with the prepared scene; files of rows are written as they come.
Result<void> run_with_engine(const SignatureJob &job, const PoseSource &source) {
  EngineOptions options;
  options.masks = masks_for(job.accuracy);
  options.threads = job.threads();
  note(job.common, "preparing the scene ...");
  UMOV_ASSIGN(engine, engine_for(job, options));
  const EngineFacts &facts = engine.facts();
  note(job.common,
       fmt::format("{} triangles in {} classes, {:.0f} MB of masks, {:.1f} s", facts.triangles,
                   facts.classes, static_cast<double>(facts.mask_bytes) / 1e6, facts.setup_s));
  ProgressBar bar("poses", job.common);
  std::optional<TableStream> stream;
  const bool is_streamed_file = !job.options.output.empty() && is_streamed(job.options.output);
  std::future<Result<void>> writing; // ends before what it writes to
  Table whole;                       // of what is not streamed
  // Many: neighbours in direction share their masks. Light between surfaces takes longer.
  const bool has_more = job.scenario.bounces > 1 && !facts.is_convex;
  const std::size_t block = has_more ? 1024 : 1u << 17;
  std::optional<Integrator> between;
  if (has_more)
    between.emplace(job.object.scene);
  std::size_t done = 0;
  StokesTable results;
  std::vector<Pose> poses;
  std::vector<std::int64_t> numbers;
  while (done < source.count && !interrupted()) {
    const std::size_t count = std::min(block, source.count - done);
    poses.resize(count);
    numbers.resize(count);
    parallel_for((count + 1023) / 1024, job.threads(), [&](std::size_t task) {
      for (std::size_t i = task * 1024; i < std::min(count, (task + 1) * 1024); ++i) {
        poses[i] = source.at(done + i);
        poses[i].sun_radius_rad = job.sun_radius();
        numbers[i] = source.number(done + i);
      }
    });
    engine.evaluate(poses, results, job.threads());
    if (between && !add_indirect(*between, job, poses, results))
      break;
    Table table =
        SignatureRows::of(numbers, poses, job.object.scene.bands, results, job.threads()).table();
    job.describe(table, engine_method(facts, options));
    if (is_streamed_file && !stream) {
      UMOV_ASSIGN(opened, TableStream::open(job.options.output, table, job.threads()));
      stream.emplace(std::move(opened));
    } else if (stream) { // the disk works while the next block is computed
      if (writing.valid())
        UMOV_TRY(writing.get());
      writing = std::async(std::launch::async | std::launch::deferred,
                           [&stream, rows = std::move(table)] { return stream->append(rows); });
    } else {
      whole.append(std::move(table));
    }
    done += count;
    bar.update(done, source.count);
  }
  if (writing.valid())
    UMOV_TRY(writing.get());
  if (done == source.count)
    return stream ? stream->commit() : put_table(job.options.output, whole, job.common);
  Error stopped{ErrorCode::Interrupted,
                fmt::format("stopped by the user after {} of {} poses", done, source.count),
                {}};
  if (!stream)
    return tl::unexpected(
        put_partial_table(job.options.output, std::move(whole), job.common, stopped));
  UMOV_ASSIGN(kept, stream->commit_partial(stopped.message));
  stopped.message += ". The finished rows are in " + kept.string() + ".";
  return tl::unexpected(stopped);
}

/// Fewer poses than this take longer to prepare than to trace.
constexpr std::size_t engine_from = 5000;

Result<void> run_signature(const SignatureOptions &o, const Common &common,
                           Diagnostics &diagnostics) {
  UMOV_TRY(check_output(o.output));
  UMOV_TRY(check_mask_file(o.masks));
  UMOV_ASSIGN(scenario, read_scenario(o.scene, o.overrides));
  if (scenario.objects.size() > 1)
    return fail(ErrorCode::BadInput,
                fmt::format("holds {} objects; a signature is of one. Keep one [[object]].",
                            scenario.objects.size()),
                {o.scene});
  if (!scenario.objects.front().parts.empty())
    diagnostics.warn("parts stand as in the mesh: without a time nothing turns", {o.scene});
  const std::uint64_t seed = o.has_seed ? o.seed : scenario.seed;
  UMOV_ASSIGN(source, source_of(o));
  UMOV_TRY(check_phases(o));
  const bool is_sun = o.source == "sun";
  if (!is_sun && (o.visibility == "masks" || !o.masks.empty()))
    return fail(ErrorCode::Usage, "masks are for sunlight; a laser takes rays, own heat paths");
  if ((o.source == "thermal") != !o.temperatures.empty())
    return fail(ErrorCode::Usage, "--source thermal and --temperature go together");
  const std::size_t random = o.poses * o.phases_deg.size();
  if (!o.masks.empty() && o.visibility == "rays")
    return fail(ErrorCode::Usage, "--masks goes with --visibility masks or auto");
  const bool has_engine = is_sun && (!o.masks.empty() || o.visibility == "masks" ||
                                     (o.visibility == "auto" && random >= engine_from &&
                                      (o.accuracy > 0 ? o.accuracy : scenario.accuracy) >= 1e-3));
  NumberedPoses numbered;
  if (!o.geometry.empty()) {
    UMOV_ASSIGN(table, poses_from_table(o.geometry));
    numbered = std::move(table);
  }
  UMOV_ASSIGN(
      object,
      load_object(scenario, 0, {.allow_old_elements = true, .source_is_sun = is_sun}, diagnostics));
  const SignatureJob job{o,
                         common,
                         scenario,
                         object,
                         source,
                         seed,
                         o.accuracy > 0 ? o.accuracy : scenario.accuracy,
                         is_sun};
  const PoseSource poses{
      o.geometry.empty() ? random : numbered.poses.size(),
      [&](std::size_t i) {
        return o.geometry.empty() ? random_pose(seed, i, Angle::degrees(o.phases_deg[i / o.poses]))
                                  : numbered.poses[i];
      },
      [&](std::size_t i) {
        return o.geometry.empty() ? static_cast<std::int64_t>(i) : numbered.number[i];
      }};
  if (has_engine)
    return run_with_engine(job, poses);
  if (o.geometry.empty())
    for (std::size_t i = 0; i < poses.count; ++i) {
      numbered.number.push_back(static_cast<std::int64_t>(i));
      numbered.poses.push_back(poses.at(i));
    }
  return run_with_rays(job, std::move(numbered));
}

} // namespace

void add_signature(CLI::App &app, const Exit &exit_with) {
  auto *verb =
      app.add_subcommand("signature", "Stokes of an object for directions, without an orbit");
  auto o = std::make_shared<SignatureOptions>();
  auto common = std::make_shared<Common>();
  verb->add_option("scene", o->scene, "Scenario file; orbit, time and observer are not used")
      ->required();
  auto *geometry =
      verb->add_option("--geometry", o->geometry,
                       "CSV with columns sun_x sun_y sun_z obs_x obs_y obs_z, body frame; with a "
                       "column pose, rows in turn of one number are one pose and keep it");
  auto *poses = verb->add_option("--poses", o->poses, "Random poses for each phase angle")
                    ->check(CLI::Range(1, 10'000'000));
  auto *phase =
      verb->add_option("--phase", o->phases_deg, "Phase angles [deg], separated by commas")
          ->delimiter(',');
  geometry->excludes(poses)->excludes(phase);
  poses->needs(phase);
  phase->needs(poses);
  verb->add_option("--source", o->source,
                   "sun, laser: a point source of any polarization, or thermal: the body's own "
                   "heat; give the "
                   "wavelength of the last two as the band")
      ->check(CLI::IsMember({"sun", "laser", "thermal"}))
      ->capture_default_str();
  verb->add_option("--state", o->state,
                   "Laser: Stokes I Q U V of the incoming light in the scattering frame")
      ->expected(4);
  verb->add_option("--temperature", o->temperatures,
                   "Thermal: K of the whole body, or GROUP=K of a part; may stand several times")
      ->allow_extra_args(false);
  auto *seed = verb->add_option("--seed", o->seed, "Of the random poses; default: the scenario's")
                   ->check(CLI::Range(std::int64_t{0}, std::int64_t{1} << 53));
  verb->add_option("--set", o->overrides, "KEY=VALUE over a key of the scenario");
  verb->add_option("--accuracy", o->accuracy, "Relative 95 % half-width asked of I")
      ->check(CLI::Range(1e-6, 1.0));
  verb->add_option("--visibility", o->visibility,
                   "rays: each pose to the accuracy asked; masks: looked up between directions "
                   "traced beforehand, hundreds of times faster, typical error as asked, each row "
                   "with its own; auto: masks for 5000 random poses or more")
      ->check(CLI::IsMember({"auto", "rays", "masks"}))
      ->capture_default_str();
  verb->add_option("--masks", o->masks,
                   "File to keep the masks in: read if it exists, made if not. For one mesh, its "
                   "material groups and one accuracy");
  verb->add_option("-o,--output", o->output, "Table: .csv, .ecsv, .fits or .json by its suffix");
  add_threads(*verb, *common);
  add_common(*verb, *common, true);
  verb->callback([o, common, exit_with, seed, geometry, poses] {
    if ((geometry->count() == 0 || o->geometry.empty()) && poses->count() == 0) {
      exit_with(report(Error{ErrorCode::Usage,
                             "say for which directions: --geometry TABLE, or --poses N --phase DEG",
                             {}}));
      return;
    }
    o->has_seed = seed->count() > 0;
    watch_interrupts();
    Diagnostics diagnostics;
    const auto done = run_signature(*o, *common, diagnostics);
    report(diagnostics, *common);
    exit_with(done ? 0 : report(done.error()));
  });
}

} // namespace umov::cli
