#include "jobs/invert_light.h"

#include <algorithm>
#include <umov/light/point_budget.h>
#include <utility>

namespace umov::jobs {

Result<Prepared> prepare(const Scenario &scenario, const InvertRequest &request,
                         const JobOptions &options, Diagnostics &diagnostics,
                         const std::atomic<bool> *cancel) {
  std::vector<InputFile> inputs;
  UMOV_ASSIGN(files, read_observations(request.observations, request.errors.has_polarization,
                                       options.threads, inputs, diagnostics));
  UMOV_ASSIGN(observed, observed_light_curve(scenario, files, request.allow_old_elements,
                                             diagnostics, true, cancel));
  Diagnostics twice; // the object was read for its orbit: its warnings are known
  UMOV_ASSIGN(light, prepare_light(scenario, request, options, twice, cancel));
  for (InputFile &input : inputs)
    observed.inputs.push_back(std::move(input));
  return Prepared{std::move(light), std::move(observed)};
}

namespace {

/// The scenario without what goes between surfaces, which has tables of its own.
Scenario without_between(Scenario scenario) {
  scenario.light.bounces = 1;
  return scenario;
}

/// Light between surfaces for a table: none of a body that is convex.
Result<std::optional<FittedBetween>>
prepare_between(const Scenario &scenario, const InvertRequest &request, const SearchedLight &direct,
                const JobOptions &options, const std::atomic<bool> *cancel) {
  const LightModel &model = direct.light.model();
  if (scenario.light.bounces <= 1 || model.facts().is_convex)
    return std::nullopt;
  Scenario with = scenario;
  with.light.max_points = most_points::of_a_node;
  SignatureRequest rough;
  rough.method = request.method == LightMethod::Rays ? LightMethod::Rays : LightMethod::Masks;
  rough.accuracy = 0.05;
  rough.between = scenario.light.between;
  if (rough.between == BetweenMethod::Auto)
    rough.between = BetweenMethod::Chains;
  JobOptions by_processor = options; // cards trace no rays
  by_processor.device = {};
  UMOV_ASSIGN(whole, PoseLight::again(direct.light, with, rough, by_processor, cancel));
  if (rough.method == LightMethod::Masks && model.facts().method != LightMethod::Rays)
    whole.model().take_masks_of(direct.masks ? direct.masks->model() : model);
  const double sun_radius_rad = whole.sun_radius_rad();
  constexpr std::size_t fine = 24, coarse = 8; // 7.5 deg and 22.5 deg
  return FittedBetween{std::move(whole), std::make_shared<BetweenTable>(fine, sun_radius_rad),
                       std::make_shared<BetweenTable>(coarse, sun_radius_rad)};
}

} // namespace

Result<SearchedLight> prepare_light(const Scenario &scenario, const InvertRequest &request,
                                    const JobOptions &options, Diagnostics &diagnostics,
                                    const std::atomic<bool> *cancel) {
  const Scenario direct = without_between(scenario);
  SignatureRequest lit;
  lit.method = request.method;
  // Light need not be known better than the model is.
  constexpr double coarsest = 0.02;
  lit.accuracy = std::max(scenario.light.accuracy, std::min(request.errors.floor, coarsest));
  UMOV_ASSIGN(light, PoseLight::make(direct, lit, options, diagnostics, cancel));
  SearchedLight out{std::move(light), {}};
  // The exact light of a convex body is many times slower than sums without masks: the
  // search, like that of other bodies, has these.
  if (request.method == LightMethod::Auto &&
      (out.light.model().facts().method == LightMethod::Auto ||
       out.light.model().facts().is_convex)) {
    SignatureRequest rough;
    rough.method = LightMethod::Masks;
    rough.accuracy = lit.accuracy;
    rough.has_half_widths = false;
    UMOV_ASSIGN(masks, PoseLight::again(out.light, direct, rough, options, cancel));
    out.masks.emplace(std::move(masks));
    out.light.model().take_masks_of(out.masks->model());
  }
  UMOV_ASSIGN(between, prepare_between(scenario, request, out, options, cancel));
  out.between = std::move(between);
  return out;
}

Result<void> take_coarse(SearchedLight &ready, const Scenario &scenario,
                         const InvertRequest &request, const JobOptions &options,
                         const std::atomic<bool> *cancel) {
  constexpr std::size_t few = 100; // facets that look different ways are lit within a microsecond
  const LightModel &finer = (ready.masks ? *ready.masks : ready.light).model();
  if (request.method == LightMethod::Rays || finer.facts().classes < few)
    return {};
  SignatureRequest lit;
  lit.method = LightMethod::Masks;
  lit.accuracy = 0.05; // of what its masks are worth, at worst
  lit.is_for_search = true;
  lit.has_half_widths = false;
  UMOV_ASSIGN(coarse,
              PoseLight::again(ready.light, without_between(scenario), lit, options, cancel));
  ready.coarse.emplace(std::move(coarse));
  return {};
}

void take_apart(SearchedLight &ready, const InvertRequest &request, const JobOptions &options,
                Diagnostics &diagnostics, const std::atomic<bool> *cancel) {
  if (!request.materials.is_any()) {
    if (request.materials.is_by_group)
      diagnostics.warn(
          "--by-group has nothing to ask of each group: materials are taken for right, "
          "as all of --slope-sd, --reflectance-sd, --haze-sd and --tilt-sd are 0");
    return;
  }
  if (request.method != LightMethod::Rays)
    ready.parts = LightByPart::make((ready.masks ? *ready.masks : ready.light).model(),
                                    request.materials, options, cancel);
  if (!ready.parts && !is_stopped(cancel))
    diagnostics.warn("the light of this object cannot be taken apart by material (rays alone, "
                     "parts that turn, measured or brushed surfaces): "
                     "roughness, reflectance and alignment are taken for right");
}

std::vector<PartKind> parts_of(const SearchedLight &ready) {
  return ready.parts ? ready.parts->kinds() : std::vector<PartKind>();
}

namespace {

PoseLighting lighting_by_part(const LightByPart &parts, bool is_quick, unsigned threads,
                              const Monitor &monitor) {
  return [&parts, is_quick, threads, &monitor](std::span<const Pose> poses, StokesTable &out) {
    // Sums of a block take a hundred times its poses' bytes.
    constexpr std::size_t block = 1u << 13;
    StokesTable some;
    out = {};
    for (std::size_t begin = 0; begin < poses.size(); begin += block) {
      const auto now = poses.subspan(begin, std::min(block, poses.size() - begin));
      if (monitor.is_cancelled() || !parts.evaluate(now, some, threads, is_quick, monitor.cancel))
        return false;
      if (now.size() == poses.size()) {
        out = std::move(some);
        return true;
      }
      out.bands = some.bands;
      for (const auto column :
           {&StokesTable::i, &StokesTable::q, &StokesTable::u, &StokesTable::i_err})
        (out.*column).insert((out.*column).end(), (some.*column).begin(), (some.*column).end());
    }
    return true;
  };
}

// clang-tidy 14 loses sight of what a std::function holds where one is returned through another.
// NOLINTBEGIN(clang-analyzer-cplusplus.NewDeleteLeaks)

/// What nobody has asked a table for before, a minute's work now and then: told as it goes.
BetweenTable::Lighting lighting_between(const PoseLight &whole, unsigned threads,
                                        const Monitor &monitor) {
  return {lighting_of(whole, 1, monitor),
          [&monitor](std::size_t done, std::size_t total) {
            monitor.advance("light between surfaces", done, total);
          },
          threads};
}

/// Light without its half-widths.
PoseLighting as_it_is(const PoseLight &light, unsigned threads, const Monitor &monitor) {
  return
      [lit = lighting_of(light, threads, monitor)](std::span<const Pose> poses, StokesTable &out) {
        const bool is_whole = lit(poses, out);
        out.i_err.clear();
        return is_whole;
      };
}

/// Masks as they are, without half-widths.
PoseLighting by_masks(const SearchedLight &ready, unsigned threads, const Monitor &monitor) {
  return ready.masks ? as_it_is(*ready.masks, threads, monitor)
                     : lighting_of(ready.light, threads, monitor);
}

/// The same with the parts that there are.
PoseLighting parts_by_masks(const SearchedLight &ready, unsigned threads, const Monitor &monitor) {
  return ready.parts ? lighting_by_part(*ready.parts, true, threads, monitor)
                     : by_masks(ready, threads, monitor);
}

/// What goes between surfaces beside it, if the scenario asks for that.
PoseLighting with_between(const SearchedLight &ready, PoseLighting direct,
                          std::shared_ptr<BetweenTable> FittedBetween::*table, unsigned threads,
                          const Monitor &monitor) {
  if (!ready.between)
    return direct;
  return BetweenTable::beside(std::move(direct),
                              lighting_between(ready.between->whole, threads, monitor),
                              (*ready.between).*table);
}

} // namespace

PoseLighting searched_lighting(const SearchedLight &ready, unsigned threads,
                               const Monitor &monitor) {
  return with_between(ready,
                      ready.parts ? lighting_by_part(*ready.parts, false, threads, monitor)
                                  : lighting_of(ready.light, threads, monitor),
                      &FittedBetween::fine, threads, monitor);
}

PoseLighting whole_lighting(const SearchedLight &ready, unsigned threads, const Monitor &monitor) {
  return with_between(ready, lighting_of(ready.light, threads, monitor), &FittedBetween::fine,
                      threads, monitor);
}

PoseLighting followed_lighting(const SearchedLight &ready, unsigned threads,
                               const Monitor &monitor) {
  return with_between(ready, parts_by_masks(ready, threads, monitor), &FittedBetween::fine, threads,
                      monitor);
}

PoseLighting first_lighting(const SearchedLight &ready, unsigned threads, const Monitor &monitor) {
  return with_between(ready, parts_by_masks(ready, threads, monitor), &FittedBetween::coarse,
                      threads, monitor);
}

PoseLighting quick_lighting(const SearchedLight &ready, unsigned threads, const Monitor &monitor) {
  return with_between(ready,
                      ready.coarse ? as_it_is(*ready.coarse, threads, monitor)
                                   : by_masks(ready, threads, monitor),
                      &FittedBetween::coarse, threads, monitor);
}
// NOLINTEND(clang-analyzer-cplusplus.NewDeleteLeaks)

PoseLighting lighting_of(const PoseLight &light, unsigned threads, const Monitor &monitor) {
  return [&light, threads, &monitor](std::span<const Pose> poses, StokesTable &out) {
    LightTask task;
    task.threads = threads;
    task.cancel = monitor.cancel;
    return !monitor.is_cancelled() && light.evaluate(poses, out, task);
  };
}

ManifestInput::Light light_used(const SearchedLight &ready, const Scenario &scenario,
                                Diagnostics &diagnostics) {
  const LightModel &model = ready.light.model();
  std::string device = model.device();
  for (const auto *of : {&ready.masks, &ready.coarse})
    if (*of && !device.starts_with("cpu"))
      if (std::string rough = (*of)->model().device(); rough.starts_with("cpu"))
        device = std::move(rough);
  tell_of_device(device, diagnostics);
  const LightFacts &facts = model.facts();
  return {scenario.objects.front().name, name_of(facts.method), facts.visibility,
          model.instruction_set(), device};
}

void keep_masks(const SearchedLight &ready) {
  (void)ready.light.model().keep_masks();
  for (const auto *rough : {&ready.masks, &ready.coarse})
    if (*rough)
      (void)(*rough)->model().keep_masks();
  if (ready.parts)
    ready.parts->keep_masks();
}

SearchOptions search_options(const Scenario &scenario, const InvertRequest &request,
                             const JobOptions &options, const Monitor &monitor) {
  SearchOptions out;
  out.errors = request.errors;
  out.largest_floor = request.largest_floor;
  out.grid = request.grid;
  out.seed = scenario.seed;
  out.threads = options.threads;
  out.progress = [&monitor](const char *what, std::size_t done, std::size_t total) {
    monitor.advance(what, done, total);
  };
  return out;
}

} // namespace umov::jobs
