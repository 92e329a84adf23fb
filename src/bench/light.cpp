// Rates and errors of the fast path.

#include <umov/bench/bench.h>

#include "bench/cases.h"
#include "bench/machine.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <map>
#include <umov/light/engine_audit.h>
#include <umov/light/instruction_set.h>
#include <umov/light/light_model.h>
#include <umov/light/poses.h>

namespace umov::bench {
namespace {

/// Random attitudes, phase angles even between 15 and 150 deg.
std::vector<Pose> bench_poses(std::uint64_t seed, std::size_t count) {
  std::vector<Pose> out;
  for (std::size_t i = 0; i < count; ++i) {
    const double share = std::fmod(0.5 + 0.6180339887498949 * static_cast<double>(i), 1.0);
    out.push_back(random_pose(seed, i, Angle::degrees(15 + 135 * share)));
    out.back().sun_radius_rad = sun_radius_at_1au_rad;
  }
  return out;
}

/// A body that turns by 0.1 deg from pose to pose, the Sun 60 deg off its axis, while the phase
/// angle goes from 15 to 150 deg.
std::vector<Pose> bench_series(std::size_t count) {
  const double height = std::cos(pi / 3), radius = std::sin(pi / 3);
  std::vector<Pose> out;
  for (std::size_t i = 0; i < count; ++i) {
    const double turn = static_cast<double>(i) * pi / 1800;
    const double phase =
        pi / 180 * (15 + 135 * static_cast<double>(i) / static_cast<double>(count));
    const Vec3<Body> sun{radius * std::cos(turn), radius * std::sin(turn), height};
    const Vec3<Body> aside{-std::sin(turn), std::cos(turn), 0};
    out.push_back({sun, normalized(std::cos(phase) * sun + std::sin(phase) * aside)});
    out.back().sun_radius_rad = sun_radius_at_1au_rad;
  }
  return out;
}

/// What one case measured.
struct BenchResult {
  EngineFacts facts;
  std::size_t bands = 0;
  std::string instruction_set;
  double rate = 0, latency_us = std::numeric_limits<double>::quiet_NaN();
  EngineErrors errors;
  bool has_errors = false;
  std::size_t batch = 0; ///< poses at a time
};

/// Seconds a pose; `evaluate` lights poses.
template <class Evaluate>
double best_time(const Evaluate &evaluate, const std::vector<Pose> &poses, double seconds) {
  StokesTable table;
  evaluate(poses, table); // caches warm
  double best = std::numeric_limits<double>::infinity();
  for (int k = 0; k < repetitions; ++k) {
    double spent = 0;
    std::size_t rounds = 0;
    while (spent < seconds / repetitions || rounds == 0) {
      const double begin = now_s();
      evaluate(poses, table);
      spent += now_s() - begin;
      ++rounds;
    }
    best = std::min(best, spent / static_cast<double>(rounds * poses.size()));
  }
  return best;
}

double latency(const Engine &engine, const std::vector<Pose> &poses) {
  StokesTable table;
  std::vector<double> times;
  for (const Pose &pose : poses) {
    const double begin = now_s();
    engine.evaluate({&pose, 1}, table, 1);
    times.push_back(now_s() - begin);
  }
  std::nth_element(times.begin(), times.begin() + static_cast<std::ptrdiff_t>(times.size() / 2),
                   times.end());
  return times[times.size() / 2];
}

/// Preparations of cases that differ in load or instruction set alone are shared.
class Bench {
public:
  Bench(const LightRequest &request, std::shared_ptr<const Cards> cards)
      : request_(request), cards_(std::move(cards)) {}

  Result<BenchResult> run(const BenchCase &one, Diagnostics &diagnostics) {
    BenchResult out;
    out.bands = one.bands;
    UMOV_TRY(prepare(one, diagnostics));
    out.facts = facts_;
    if (!restrict_engine(one.instruction_set))
      return fail(ErrorCode::Device, "this machine has no " + one.instruction_set);
    out.instruction_set = one.is_on_card ? name_of(*cards_) : engine_instruction_set();
    const auto evaluate = [&](std::span<const Pose> poses, StokesTable &table) {
      LightTask task;
      task.threads = one.threads;
      if (model_)
        (void)model_->evaluate(poses, {}, table, task);
      else
        (void)engine_->evaluate(poses, table, task);
    };
    // Paths between surfaces take a tenth of a second a pose.
    const bool is_slow = one.bounces > 1 && one.between == BetweenMethod::Paths;
    const auto probe = bench_poses(1, is_slow ? 4 : 64);
    const double guess = best_time(evaluate, probe, 0.01);
    constexpr double longest_s = 60;
    const auto count =
        one.batch > 0 ? std::min(one.batch, static_cast<std::size_t>(64 + longest_s / guess))
                      : static_cast<std::size_t>(std::clamp(request_.seconds / repetitions / guess,
                                                            is_slow ? 8.0 : 256.0, 300'000.0));
    const auto poses = one.is_series ? bench_series(count) : bench_poses(2, count);
    out.batch = count;
    if (one.is_single_pose)
      out.latency_us = 1e6 * latency(*engine_, poses);
    else
      out.rate = 1 / best_time(evaluate, poses, request_.seconds);
    if (one.has_errors && request_.geometries > 0) {
      const auto few = bench_poses(request_.seed, request_.geometries);
      look_at_reference(one, few);
      StokesTable table;
      evaluate(few, table);
      out.errors = compare_with_reference(table, reference_, one.bands / 2);
      out.has_errors = true;
    }
    restrict_engine("best");
    return out;
  }

private:
  /// The engine of a case, and the light model where the case goes through it.
  Result<void> prepare(const BenchCase &one, Diagnostics &diagnostics) {
    const std::string key =
        fmt::format("{} {} {} {} {} {} {} {} {} {} {} {}", one.mesh, one.facets, one.bands,
                    one.has_own_roughness, static_cast<int>(one.visibility), one.masks.points,
                    one.masks.narrow_cells, one.masks.refine_above, one.cluster_rad,
                    one.is_intensity_only, one.has_library_materials, one.is_default_path) +
        fmt::format(" {} {} {} {} {} {}", one.has_rough_metals, one.bounces, name_of(one.between),
                    one.is_for_many, static_cast<int>(one.normals), one.masks.wide_cells);
    if (key == key_ && (one.is_on_card || !is_on_card_))
      return take_cards(one);
    is_on_card_ = false;
    engine_.reset();
    model_.reset();
    UMOV_ASSIGN(scene, case_scene(one, diagnostics));
    scene_.emplace(std::move(scene));
    EngineOptions options;
    options.visibility = one.visibility;
    options.masks = one.masks;
    options.cluster_rad = one.cluster_rad;
    options.is_intensity_only = one.is_intensity_only;
    if (one.masks.refine_above > 0) // as LightMethod::Auto has it: no rays for what is dark
      for (const double light : typical_light(*scene_))
        options.floor_i.push_back(default_accuracy_floor(LightMethod::Auto) * light);
    if (one.is_default_path) {
      LightOptions light;
      light.bounces = one.bounces;
      light.between = one.between;
      if (one.is_for_many)
        light = for_many_poses(light);
      UMOV_ASSIGN(model, make_light(*scene_, {}, light));
      model_ = std::move(model);
      learn_model_facts(one);
    } else {
      engine_.emplace(*scene_, options);
      facts_ = engine_->facts();
    }
    key_ = key;
    return take_cards(one);
  }
  /// Masks are traced when poses ask for their directions: so many ask for nearly all.
  void learn_model_facts(const BenchCase &one) {
    const LightFacts &facts = model_->facts();
    facts_ = {};
    facts_.triangles = facts.triangles;
    facts_.classes = facts.classes;
    facts_.setup_s = facts.setup_s;
    if (one.bounces == 1) {
      const std::vector<Pose> poses = bench_poses(1, 5'000);
      StokesTable table;
      const auto seconds = [&] {
        const double begin = now_s();
        LightTask task;
        task.threads = 0; // as an engine prepares itself
        (void)model_->evaluate(poses, {}, table, task);
        return now_s() - begin;
      };
      const double with_masks = seconds();
      facts_.setup_s += std::max(0.0, with_masks - seconds());
    }
    facts_.mask_bytes = model_->mask_bytes();
  }
  /// The engine of a case that cards light; it cannot give them back.
  Result<void> take_cards(const BenchCase &one) {
    if (!one.is_on_card || is_on_card_)
      return {};
    UMOV_TRY(engine_->use_cards(cards_));
    is_on_card_ = true;
    return {};
  }

  /// Light of these poses by rays, once a scene.
  void look_at_reference(const BenchCase &one, const std::vector<Pose> &poses) {
    const std::string scene = fmt::format(
        "{} {} {} {} {} {} {}", one.mesh, one.facets, one.has_library_materials, one.bands,
        one.has_own_roughness, one.has_rough_metals, static_cast<int>(one.normals));
    if (scene == reference_of_)
      return;
    IntegrationOptions exact;
    exact.accuracy = 5e-4;
    reference_ = Integrator(*scene_).evaluate(poses, exact, 0);
    reference_of_ = scene;
  }

  const LightRequest &request_;
  std::shared_ptr<const Cards> cards_; ///< null: the processor alone
  bool is_on_card_ = false;            ///< of the engine
  std::string key_, reference_of_;
  std::optional<Scene> scene_;
  std::optional<Engine> engine_;
  std::unique_ptr<LightModel> model_; ///< null: the engine by itself
  EngineFacts facts_;                 ///< of either
  std::vector<PoseResult> reference_;
};

struct BenchTable {
  std::vector<std::string> name, mesh, set;
  std::vector<std::int64_t> triangles, classes, bands, threads, batch;
  std::map<std::string, std::vector<double>> numbers;

  void add(const BenchCase &one, const BenchResult &r) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    name.push_back(one.name);
    mesh.push_back(one.mesh);
    set.push_back(r.instruction_set);
    triangles.push_back(static_cast<std::int64_t>(r.facts.triangles));
    classes.push_back(static_cast<std::int64_t>(r.facts.classes));
    bands.push_back(static_cast<std::int64_t>(r.bands));
    threads.push_back(one.threads);
    batch.push_back(static_cast<std::int64_t>(r.batch));
    const auto or_nan = [&](double x) { return r.has_errors ? x : nan; };
    numbers["setup_s"].push_back(r.facts.setup_s);
    numbers["memory_mb"].push_back(static_cast<double>(r.facts.mask_bytes + r.facts.scene_bytes) /
                                   1e6);
    numbers["poses_per_s"].push_back(one.is_single_pose ? nan : r.rate);
    numbers["latency_us"].push_back(r.latency_us);
    numbers["i_err_median"].push_back(or_nan(r.errors.i_median));
    numbers["i_err_p90"].push_back(or_nan(r.errors.i_p90));
    numbers["i_err_p95"].push_back(or_nan(r.errors.i_p95));
    numbers["i_err_max"].push_back(or_nan(r.errors.i_max));
    numbers["q_err_p95"].push_back(or_nan(r.errors.q_p95));
    numbers["covered"].push_back(or_nan(r.errors.covered));
    numbers["estimate_median"].push_back(or_nan(r.errors.estimate_median));
  }

  Table table() && {
    Table out;
    out.add("case", "", "what was run", std::move(name));
    out.add("mesh", "", "mesh", std::move(mesh));
    out.add("triangles", "", "of the mesh", std::move(triangles));
    out.add("classes", "", "of equal normal and material: what a pose costs", std::move(classes));
    out.add("bands", "", "bands", std::move(bands));
    out.add("threads", "", "of the timed evaluation; 0: all cores", std::move(threads));
    out.add("batch", "", "poses asked for at a time", std::move(batch));
    out.add("instruction_set", "", "as Highway names it, or the cards", std::move(set));
    const auto move = [&](const char *key, const char *unit, const char *text) {
      out.add(key, unit, text, std::move(numbers[key]));
    };
    move("setup_s", "s", "preparation, all cores");
    move("memory_mb", "Mbyte", "masks, points and classes");
    move("poses_per_s", "1 / s", "best of five");
    move("latency_us", "us", "median of one pose alone");
    move("i_err_median", "", "|I/I_ref - 1|, poses above 1 % of the median light");
    move("i_err_p90", "", "the same, 90th percentile");
    move("i_err_p95", "", "the same, 95th percentile");
    move("i_err_max", "", "the same, worst");
    move("q_err_p95", "", "|Q/I - (Q/I)_ref|, 95th percentile");
    move("covered", "", "share of all poses within their half-widths");
    move("estimate_median", "", "half-width of I over I, median");
    return out;
  }
};

std::string outliers_text(const BenchCase &one, const BenchResult &r) {
  std::string text;
  for (const EngineOutlier &o : r.errors.outliers)
    text += fmt::format("  pose {}: {:.2g} (said {:.2g}, light {:.2g} of the median)", o.pose,
                        o.error, o.estimate, o.light);
  return fmt::format("{} {}, worst poses:{}", one.mesh, one.name, text);
}

std::vector<BenchCase> cases_of_processor(const LightRequest &request) {
  std::vector<BenchCase> out;
  for (const std::string &mesh : request.meshes)
    for (BenchCase &one : cases_for_mesh(mesh))
      out.push_back(std::move(one));
  return out.empty() ? standard_cases() : out;
}

/// Cards if they are asked for and there; null: the processor alone, which Auto says.
Result<std::shared_ptr<const Cards>> cards_of(const LightRequest &request,
                                              Diagnostics &diagnostics) {
  if (request.device.choice == DeviceChoice::Cpu) {
    if (!request.batches.empty())
      return fail(ErrorCode::Usage, "--batches goes with --device cuda or auto");
    return nullptr;
  }
  auto cards = open_cards(request.device);
  if (cards || request.device.choice == DeviceChoice::Cuda)
    return cards;
  diagnostics.warn("--device auto took the cpu: " + cards.error().message);
  return nullptr;
}

/// Those asked for that this machine can run.
Result<std::vector<BenchCase>> cases_of(const LightRequest &request, bool has_cards) {
  const std::vector<std::size_t> batches = request.batches.empty()
                                               ? std::vector<std::size_t>{1, 100, 10'000, 1'000'000}
                                               : request.batches;
  std::vector<BenchCase> out =
      has_cards ? card_cases(request.meshes, batches) : cases_of_processor(request);
  std::erase_if(out, [&](const BenchCase &one) {
    return one.name.find(request.only) == std::string::npos ||
           !restrict_engine(one.instruction_set);
  });
  restrict_engine("best");
  if (out.empty())
    return fail(ErrorCode::Usage, "--only " + request.only + ": no case has that in its name");
  return out;
}

} // namespace

Result<LightReport> light(const LightRequest &request, const jobs::Monitor &monitor,
                          Diagnostics &diagnostics) {
  const std::string load_before = load_average();
  UMOV_ASSIGN(cards, cards_of(request, diagnostics));
  UMOV_ASSIGN(cases, cases_of(request, cards != nullptr));
  Bench bench(request, std::move(cards));
  BenchTable rows;
  std::size_t done = 0;
  for (const BenchCase &one : cases) {
    if (monitor.is_cancelled())
      break;
    UMOV_ASSIGN(result, bench.run(one, diagnostics));
    rows.add(one, result);
    if (result.has_errors)
      monitor.tell(outliers_text(one, result));
    monitor.advance("cases", ++done, cases.size());
  }
  LightReport out{std::move(rows).table(), {}};
  add_machine(out.table, load_before);
  out.table.note("poses",
                 fmt::format("random attitudes, phase 15-150 deg, solar disk; errors from {} "
                             "of them (seed {}) against rays at 5e-4",
                             request.geometries, request.seed));
  if (done < cases.size())
    out.stopped = Error{ErrorCode::Interrupted,
                        fmt::format("stopped by the user after {} of {} cases", done, cases.size()),
                        {}};
  return out;
}

} // namespace umov::bench
