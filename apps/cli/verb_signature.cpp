#include "console.h"
#include "tables.h"
#include "verbs.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <optional>
#include <umov/core/files.h>
#include <umov/core/parallel.h>
#include <umov/io/scenario.h>
#include <umov/io/table.h>
#include <umov/lightcurve/poses.h>

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
  std::string source = "sun";
  std::vector<double> state{1, 0, 0, 0};
};

/// Radius of the Sun's disk seen from 1 au: a signature has no distance.
constexpr double solar_radius_rad = 0.2665 * pi / 180;

/// Stokes vector of the source per unit irradiance.
Result<Stokes<ScatteringPlane>> source_of(const SignatureOptions &o) {
  const Stokes<ScatteringPlane> s{o.state[0], o.state[1], o.state[2], o.state[3]};
  const double polarized = std::sqrt(s.q * s.q + s.u * s.u + s.v * s.v);
  if (o.source == "sun" && polarized > 0)
    return fail(ErrorCode::Usage, "--state goes with --source laser; sunlight is unpolarized");
  if (!(s.i > 0) || !(polarized <= s.i * (1 + 1e-12)))
    return fail(ErrorCode::Usage,
                fmt::format("--state {} {} {} {}: I > 0 and sqrt(Q2 + U2 + V2) <= I were expected",
                            s.i, s.q, s.u, s.v));
  return s * (1 / s.i);
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

Result<NumberedPoses> poses_of(const SignatureOptions &o, std::uint64_t seed) {
  if (!o.geometry.empty())
    return poses_from_table(o.geometry);
  NumberedPoses out;
  std::vector<Pose> &poses = out.poses;
  for (const double phase : o.phases_deg) {
    if (!(phase >= 0 && phase <= 180))
      return fail(ErrorCode::Usage, fmt::format("--phase {}: 0 to 180 was expected", phase));
    for (std::size_t i = 0; i < o.poses; ++i) {
      out.number.push_back(static_cast<std::int64_t>(poses.size()));
      poses.push_back(random_pose(seed, poses.size(), Angle::degrees(phase)));
    }
  }
  return out;
}

/// Where the model of an active source falls short (explicit rough surfaces, docs/theory/lobes.md).
constexpr const char *laser_limits =
    "One reflection keeps the degree of polarization; light between microfacets is depolarized or "
    "keeps the single-bounce form, while explicit rough surfaces (slope 0.6, backscatter) "
    "depolarize "
    "circular light about twice as fast as linear. For very rough metals near retro-reflection the "
    "double bounce is understated.";

/// Columns that grow by one row per pose and band.
struct SignatureColumns {
  std::vector<std::int64_t> pose;
  std::vector<std::string> band;
  std::vector<std::vector<double>> numbers{18};

  void add(std::int64_t number, const Pose &at, const Band &colour, const BandResult &result,
           bool is_dark) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const auto &s = result.stokes;
    const auto &e = result.half_width;
    const double scale = is_dark || !(s.i > 0) ? nan : 1 / s.i;
    const std::array<double, 18> row{angle_between(at.sun, at.observer) * 180 / pi,
                                     s.i,
                                     s.q,
                                     s.u,
                                     s.v,
                                     s.q * scale,
                                     s.u * scale,
                                     s.v * scale,
                                     e.i,
                                     e.q,
                                     e.u,
                                     e.v,
                                     at.sun.x,
                                     at.sun.y,
                                     at.sun.z,
                                     at.observer.x,
                                     at.observer.y,
                                     at.observer.z};
    pose.push_back(number);
    band.push_back(colour.name);
    for (std::size_t i = 0; i < row.size(); ++i)
      numbers[i].push_back(row[i]);
  }

  Table table() && {
    struct Head {
      const char *name, *unit, *text;
    };
    constexpr std::array<Head, 18> heads{{{"phase_angle", "deg", "Sun-object-observer, 0 = full"},
                                          {"intensity", "m2 / sr", "per unit solar irradiance"},
                                          {"stokes_q", "m2 / sr", "scattering frame"},
                                          {"stokes_u", "m2 / sr", "scattering frame"},
                                          {"stokes_v", "m2 / sr", "scattering frame"},
                                          {"q_scat", "", "Q/I, scattering frame"},
                                          {"u_scat", "", "U/I, scattering frame"},
                                          {"v", "", "V/I"},
                                          {"intensity_err", "m2 / sr", "numerical 95 % half-width"},
                                          {"stokes_q_err", "m2 / sr", "numerical 95 % half-width"},
                                          {"stokes_u_err", "m2 / sr", "numerical 95 % half-width"},
                                          {"stokes_v_err", "m2 / sr", "numerical 95 % half-width"},
                                          {"sun_x", "", "direction of the Sun, body frame"},
                                          {"sun_y", "", "direction of the Sun, body frame"},
                                          {"sun_z", "", "direction of the Sun, body frame"},
                                          {"obs_x", "", "direction of the observer, body frame"},
                                          {"obs_y", "", "direction of the observer, body frame"},
                                          {"obs_z", "", "direction of the observer, body frame"}}};
    Table out;
    out.add("pose", "", "number of the pose", std::move(pose));
    out.add("band", "", "band as in the scene", std::move(band));
    for (std::size_t i = 0; i < heads.size(); ++i)
      out.add(heads[i].name, heads[i].unit, heads[i].text, std::move(numbers[i]));
    note_conventions(out);
    return out;
  }
};

Result<void> run_signature(const SignatureOptions &o, const Common &common,
                           Diagnostics &diagnostics) {
  UMOV_TRY(check_output(o.output));
  UMOV_ASSIGN(scenario, read_scenario(o.scene, o.overrides));
  const std::uint64_t seed = o.has_seed ? o.seed : scenario.seed;
  UMOV_ASSIGN(source, source_of(o));
  UMOV_ASSIGN(numbered, poses_of(o, seed));
  std::vector<Pose> &poses = numbered.poses;
  const bool is_sun = o.source == "sun";
  for (Pose &pose : poses)
    pose.sun_radius_rad = is_sun && scenario.has_solar_disk ? solar_radius_rad : 0;
  UMOV_ASSIGN(object, load_object(scenario, {.allow_old_elements = true, .source_is_sun = is_sun},
                                  diagnostics));
  const Integrator integrator(object.scene);
  IntegrationOptions options;
  options.accuracy = o.accuracy > 0 ? o.accuracy : scenario.accuracy;
  options.seed = seed;
  options.source = source;
  SignatureColumns columns;
  ProgressBar bar("poses", common);
  constexpr std::size_t block = 512; // the grain of progress
  std::size_t done = 0;
  for (std::size_t begin = 0; begin < poses.size() && done == begin; begin += block) {
    const std::size_t count = std::min(block, poses.size() - begin);
    std::vector<std::optional<PoseResult>> results(count);
    parallel_for(count, static_cast<unsigned>(common.threads), [&](std::size_t i) {
      if (!interrupted()) // a pose may take seconds: a stop waits for those begun only
        results[i] = integrator.evaluate(poses[begin + i], options);
    });
    for (std::size_t i = 0; i < count && results[i]; ++i, ++done)
      for (std::size_t b = 0; b < object.scene.bands.size(); ++b)
        columns.add(numbered.number[done], poses[done], object.scene.bands[b], results[i]->bands[b],
                    results[i]->is_dark);
    bar.update(done, poses.size());
  }
  Table table = std::move(columns).table();
  table.note("source", is_sun ? (scenario.has_solar_disk ? "Sun, uniform disk of 0.2665 deg radius"
                                                         : "Sun, a point")
                              : fmt::format("laser, Stokes {} {} {} {} in the scattering frame",
                                            source.i, source.q, source.u, source.v));
  if (!is_sun)
    table.note("limits", laser_limits);
  if (done == poses.size())
    return put_table(o.output, table, common);
  return tl::unexpected(put_partial_table(
      o.output, std::move(table), common,
      {ErrorCode::Interrupted,
       fmt::format("stopped by the user after {} of {} poses", done, poses.size()),
       {}}));
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
  verb->add_option(
          "--source", o->source,
          "sun, or laser: a point source of any polarization; give its wavelength as the band")
      ->check(CLI::IsMember({"sun", "laser"}))
      ->capture_default_str();
  verb->add_option("--state", o->state,
                   "Laser: Stokes I Q U V of the incoming light in the scattering frame")
      ->expected(4);
  auto *seed = verb->add_option("--seed", o->seed, "Of the random poses; default: the scenario's")
                   ->check(CLI::Range(std::int64_t{0}, std::int64_t{1} << 53));
  verb->add_option("--set", o->overrides, "KEY=VALUE over a key of the scenario");
  verb->add_option("--accuracy", o->accuracy, "Relative 95 % half-width asked of I")
      ->check(CLI::Range(1e-6, 1.0));
  verb->add_option("-o,--output", o->output, "Table: .csv, .ecsv or .json by its suffix");
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
