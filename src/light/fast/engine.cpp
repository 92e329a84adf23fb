#include <umov/light/engine.h>

#include "light/fast/abundance_state.h"
#include "light/fast/mask_cache.h"
#include "light/fast/patches.h"
#include "light/fast/pose_data.h"
#include "light/fast/pose_order.h"
#include "light/fast/state.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>
#include <umov/core/parallel.h>
#include <umov/shape/topology.h>

namespace umov {
namespace {

constexpr std::size_t ordered_from = 2048; ///< fewer poses are not worth sorting
double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Poses that one thread takes at a time.
constexpr std::size_t poses_per_task_min = 64, poses_per_task_max = 16'384;

} // namespace

MaskQuality masks_for(double accuracy) {
  MaskQuality out = accuracy >= 0.004 ? fast_masks : fine_masks;
  out.refine_above = 0;
  return out;
}

Engine::State::Workspace::Workspace(const State &of) {
  if (of.occluder)
    tracer.emplace(of.refine_points, *of.occluder);
}

std::size_t Engine::State::terms_max() const {
  std::size_t most = 0;
  for (const backend::SlotTerms &terms : compiled.data.slots)
    most = std::max<std::size_t>(most, terms.lobe_count + terms.product_count);
  return most;
}

void Engine::State::prepare(const Pose &pose, Prepared &out) const {
  out.cos_phase = cos_phase(pose);
  prepare_pose(pose, out.cos_phase, compiled.data.lobes, compiled.has_u, hiding(), out.pose);
  if (!options.is_double)
    round_pose(out.pose, out.single);
  if (masks)
    backend::prefetch(*hiding(), out.pose.small_sun, out.pose.small_observer, out.pose.large_sun,
                      out.pose.large_observer);
}

template <class Body>
void Engine::State::for_each(std::span<const Pose> poses, const LightTask &task, const Body &body,
                             const FromCards &from_cards) const {
  std::vector<std::uint32_t> order(poses.size());
  if (masks && poses.size() >= ordered_from) {
    const std::size_t cells = mask_size().small_cells, directions = (cells + 1) * (cells + 1);
    order = order_for_masks(poses, directions, masks->bytes() / directions, task.threads);
  } else
    std::iota(order.begin(), order.end(), 0u);
  const ReadLock held = hold_masks(poses, task);
  const std::size_t on_card =
      on_cards && !on_cards->is_left ? for_each_on_cards(poses, order, task, body, from_cards) : 0;
  const std::size_t left = poses.size() - on_card;
  if (on_cards) {
    on_cards->lit += on_card;
    on_cards->left_to_processor += left;
  }
  const std::size_t size = std::clamp(left / (std::size_t{4} * resolve_threads(task.threads)) + 1,
                                      poses_per_task_min, poses_per_task_max);
  parallel_for((left + size - 1) / size, task.threads, [&](std::size_t part) {
    if (is_stopped(task.cancel)) // masks may be lacking
      return;
    Workspace work(*this);
    const std::size_t begin = on_card + part * size, end = std::min(poses.size(), begin + size);
    prepare(poses[order[begin]], work.prepared[0]);
    for (std::size_t k = begin; k < end && !is_stopped(task.cancel); ++k) {
      if (k + 1 < end)
        prepare(poses[order[k + 1]], work.prepared[(k + 1 - begin) % 2]);
      body(order[k], poses[order[k]], work.prepared[(k - begin) % 2], work);
    }
  });
}

/// Rays and facets without a kernel need the pose on the processor too.
bool Engine::State::needs_pose_beside_cards(const LightTask &task) const {
  return may_mend() || task.has_glints || !on_cards->general.empty();
}

template <class Body>
std::size_t Engine::State::for_each_on_cards(std::span<const Pose> poses,
                                             std::span<const std::uint32_t> order,
                                             const LightTask &task, const Body &body,
                                             const FromCards &from_cards) const {
  if (is_stopped(task.cancel)) // masks may be lacking
    return poses.size();
  const WriteLock alone(on_cards->one_at_a_time);
  if (on_cards->is_left) // by the thread that was waited for
    return 0;
  // By all threads: cards take a pose in less time than one thread copies it.
  std::vector<backend::PoseDirections> directions(order.size());
  constexpr std::size_t block = 4096;
  parallel_for((order.size() + block - 1) / block, task.threads, [&](std::size_t part) {
    for (std::size_t k = part * block; k < std::min(order.size(), (part + 1) * block); ++k) {
      const Pose &pose = poses[order[k]];
      directions[k] = {pose.sun, pose.observer, pose.sun_radius_rad, cos_phase(pose),
                       has_scattering_plane(pose)};
    }
  });
  const bool is_beside = needs_pose_beside_cards(task);
  std::size_t finished = 0;
  const auto finish = [&](std::size_t first, std::size_t count, const backend::CardRows &rows) {
    parallel_for((count + poses_per_task_min - 1) / poses_per_task_min, task.threads,
                 [&](std::size_t part) {
                   const std::size_t begin = part * poses_per_task_min,
                                     end = std::min(count, begin + poses_per_task_min);
                   if (from_cards.take) {
                     for (std::size_t k = begin; k < end; ++k)
                       from_cards.take(order[first + k], rows, k);
                     return;
                   }
                   Workspace work(*this);
                   Prepared &at = work.prepared[0];
                   at.card_sums = &rows;
                   for (std::size_t k = begin; k < end && !is_stopped(task.cancel); ++k) {
                     const std::uint32_t row = order[first + k];
                     if (is_beside)
                       prepare(poses[row], at);
                     at.cos_phase = directions[first + k].cos_phase;
                     at.row_of_card = k;
                     body(row, poses[row], at, work);
                   }
                 });
    finished = first + count;
  };
  auto done = on_cards->loops->put_masks(hiding(), masks ? masks->version() : 0);
  if (done)
    done = on_cards->loops->run(directions, from_cards.wants, task.cancel, finish);
  if (done)
    return poses.size();
  if (!on_cards->may_be_left || !on_cards->loops->lacks_memory())
    give_up(done.error());
  on_cards->why_left = done.error().message;
  on_cards->is_left = true;
  return finished;
}

bool Engine::State::has_masks() const {
  return options.visibility == Visibility::Masks && !facts.is_convex;
}

MaskSize Engine::State::mask_size() const {
  const auto even = [](std::size_t cells) { return std::max<std::size_t>(cells / 2 * 2, 2); };
  return {even(options.masks.narrow_cells), even(options.masks.wide_cells)};
}

/// Everything but the masks.
namespace {

/// All of a few bands; of the many wavelengths of a curve the heaviest and others spread over it.
std::vector<std::uint32_t> some_bands(std::size_t count) {
  constexpr std::size_t enough = 6;
  std::vector<std::uint32_t> out;
  const std::size_t wanted = std::min(count, enough);
  for (std::size_t n = 0; n < wanted; ++n)
    out.push_back(static_cast<std::uint32_t>(
        n == 0 ? 0 : 1 + (n - 1) * (count - 2) / std::max<std::size_t>(1, wanted - 2)));
  return out;
}

/// Slope of the narrowest lobe; of a measured surface none is known.
double width_of(const Surface &surface) {
  return surface.material().measured ? 0 : surface.width();
}

/// How unlike the normals of each slot may be that are joined.
std::vector<double> tolerances_of(const Scene &scene, const EngineOptions &options) {
  std::vector<double> out(2 * scene.mesh.groups.size(), options.cluster_rad);
  for (std::uint32_t slot = 0; slot < out.size() && options.cluster_of_lobe > 0; ++slot)
    out[slot] = std::min(options.cluster_rad,
                         options.cluster_of_lobe * width_of(surface_of_slot(scene, slot)));
  return out;
}

} // namespace

Engine::State::State(const Scene &of, const EngineOptions &with, const std::atomic<bool> *cancel)
    : scene(of), options(with), judged_bands(some_bands(of.grid.nodes().size())) {
  leave_if_stopped(cancel);
  facts.is_convex = is_proven_convex(scene.mesh, cancel);
  elements = make_elements(scene, visible_sides(scene.mesh, cancel), cancel);
  const SharedSlots shared = share_materials(scene, options.hypotheses, elements);
  classes = join_facets(elements, tolerances_of(scene, options), cancel);
  plan = plan_groups(classes, has_masks() ? std::max<std::size_t>(options.masks.points, 1) : 0);
  leave_if_stopped(cancel);
  compiled = compile_scene(scene, options.hypotheses, shared, classes, plan,
                           options.cluster_rad > 0 && options.tells_cluster_error,
                           options.is_intensity_only);
  leave_if_stopped(cancel);
  // Else unlike normals are one there, whatever the lobe.
  if (!(options.cluster_rad > 0) || options.cluster_of_lobe > 0)
    add_patches(elements, classes, plan, compiled, cancel);
  single = round_scene(compiled.data);
  leave_if_stopped(cancel);
  flats = find_flats();
  views.whole = compiled.data.view();
  views.single = single.view();
  facts.triangles = scene.mesh.triangles.size();
  facts.classes = classes.list.size();
  facts.groups = plan.groups.size();
  facts.general_classes = compiled.general_classes;
  facts.scene_bytes =
      compiled.data.groups.size() *
          (sizeof(backend::FacetGroup<double>) + sizeof(backend::FacetGroup<float>)) +
      compiled.data.patches.size() *
          (sizeof(backend::NormalPatch<double>) + sizeof(backend::NormalPatch<float>));
}

void Engine::State::take_masks(std::optional<MaskStore> ready, const std::atomic<bool> *cancel) {
  if (!has_masks())
    return;
  occluder.emplace(scene.mesh, Occluder::Rays::Each, cancel);
  if (!ready)
    ready = read_cached_masks(options.mask_cache, key_of_masks(), plan, mask_size());
  masks =
      std::make_shared<LazyMasks>(ready ? std::move(*ready) : empty_masks(plan, mask_size()),
                                  MaskTracer(scene, elements, classes, plan, *occluder, cancel));
  if (!options.is_lazy)
    masks->ensure_all(options.threads, cancel);
  leave_if_stopped(cancel);
  if (options.masks.refine_above > 0)
    refine_points = RefinePoints(scene, elements, classes, plan, *occluder);
  facts.mask_bytes = masks->bytes();
}

ReadLock Engine::State::hold_masks(std::span<const Pose> poses, const LightTask &task) const {
  return masks ? masks->ensure(poses, task.threads, task.cancel) : ReadLock();
}

std::uint64_t Engine::State::key_of_masks() const {
  return mask_key(scene.mesh, classes, plan, mask_size());
}

void Engine::State::keep_masks() const {
  if (masks && masks->has_grown())
    masks->read([&](const MaskStore &store) {
      cache_masks(options.mask_cache, key_of_masks(), plan, mask_size(), store);
    });
}

Engine::Engine(const Scene &scene, const EngineOptions &options, const std::atomic<bool> *cancel) {
  const auto start = std::chrono::steady_clock::now();
  state_ = std::make_unique<State>(scene, options, cancel);
  state_->take_masks({}, cancel);
  state_->facts.setup_s = seconds_since(start);
}

Engine::Engine(std::unique_ptr<State> state) : state_(std::move(state)) {}

Result<Engine> Engine::with_masks(const std::filesystem::path &file, const Scene &scene,
                                  const EngineOptions &options, const std::atomic<bool> *cancel) {
  const auto start = std::chrono::steady_clock::now();
  auto state = std::make_unique<State>(scene, options, cancel);
  if (state->has_masks()) {
    const std::uint64_t key =
        mask_key(state->scene.mesh, state->classes, state->plan, state->mask_size());
    UMOV_ASSIGN(masks, read_masks(file, key, state->plan, state->mask_size()));
    state->take_masks(std::move(masks), cancel);
  }
  state->facts.setup_s = seconds_since(start);
  return Engine(std::move(state));
}

Result<void> Engine::save_masks(const std::filesystem::path &file) const {
  const State &s = *state_;
  if (!s.masks)
    return fail(ErrorCode::Usage, "nothing hides anything here: there are no masks to keep");
  return s.masks->read(
      [&](const MaskStore &store) { return write_masks(file, store, s.key_of_masks()); });
}

void Engine::keep_masks() const { state_->keep_masks(); }

void Engine::take_masks_of(const Engine &elder) const {
  const State &own = *state_, &other = *elder.state_;
  if (own.masks && other.masks && own.masks != other.masks &&
      own.key_of_masks() == other.key_of_masks())
    own.masks->take_rows_of(other.masks);
}

std::size_t Engine::mask_bytes() const { return state_->masks ? state_->masks->bytes() : 0; }

bool Engine::has_new_masks() const { return state_->masks && state_->masks->has_grown(); }

Engine::~Engine() = default;
Engine::Engine(Engine &&) noexcept = default;
Engine &Engine::operator=(Engine &&) noexcept = default;

const EngineFacts &Engine::facts() const { return state_->facts; }
std::size_t Engine::band_count() const { return state_->scene.grid.nodes().size(); }

void Engine::evaluate(std::span<const Pose> poses, StokesTable &out, unsigned threads) const {
  LightTask task;
  task.threads = threads;
  (void)evaluate(poses, out, task);
}

bool Engine::evaluate(std::span<const Pose> poses, StokesTable &out, const LightTask &task,
                      std::span<const std::uint32_t> material_of) const {
  const State &s = *state_;
  out.resize(poses.size(), band_count());
  if (task.has_glints)
    out.glint_share.assign(poses.size(), 0);
  std::vector<std::uint32_t> material; // per slot
  const bool has_materials = task.has_materials && !material_of.empty();
  for (std::size_t slot = 0; has_materials && slot < s.compiled.slots.size(); ++slot)
    material.push_back(material_of[s.compiled.slots[slot].front()]);
  const std::size_t materials =
      material.empty() ? 0 : *std::max_element(material_of.begin(), material_of.end()) + 1;
  out.material_i.assign(poses.size() * materials * band_count(), 0);
  const bool has_u_or_v = s.compiled.has_u;
  FromCards from_cards;
  if (s.on_cards && s.on_cards->loops->has_colours() && materials == 0 &&
      !s.needs_pose_beside_cards(task))
    from_cards = {backend::CardWants::Light,
                  [&](std::size_t row, const backend::CardRows &rows, std::size_t row_of_card) {
                    s.take_light(rows, row_of_card, row, out);
                  }};
  s.for_each(
      poses, task,
      [&](std::size_t row, const Pose &pose, const State::Prepared &at, State::Workspace &work) {
        const bool has_light = s.sum(pose, at, work);
        out.method[row] = !s.masks         ? PoseMethod::Exact
                          : work.is_mended ? PoseMethod::Mended
                                           : PoseMethod::Masks;
        if (!has_light)
          return put_darkness(row, out);
        if (materials > 0)
          s.colour_by_material(material, out.material_i.data() + row * materials * band_count(),
                               work);
        else if (!work.is_coloured)
          s.colour(work);
        put_light(work.light, s.compiled.area_m2, has_scattering_plane(pose), has_u_or_v, row, out);
        out.is_dark[row] = work.sums.is_any_seen || has_any_light(work.light) ? 0 : 1;
        if (task.has_glints)
          out.glint_share[row] = s.glint_share(pose, at, work);
      },
      from_cards);
  return !is_stopped(task.cancel);
}

Result<void> Engine::abundances(std::span<const Pose> poses, AbundanceTable &out, unsigned threads,
                                const std::atomic<bool> *cancel) const {
  const State &s = *state_;
  for (std::size_t slot = 0; slot < s.compiled.slots.size(); ++slot)
    if (s.compiled.data.slots[slot].is_general)
      return fail(ErrorCode::BadInput, "material \"" +
                                           s.compiled.colours.surface(slot).material().name +
                                           "\" is lit facet by facet and has no sums");
  begin_abundances(s.compiled, s.scene.mesh, poses, out);
  LightTask task;
  task.threads = threads;
  task.cancel = cancel;
  FromCards from_cards;
  if (s.on_cards && !s.needs_pose_beside_cards(task))
    from_cards = {backend::CardWants::Abundances,
                  [&](std::size_t row, const backend::CardRows &rows, std::size_t row_of_card) {
                    out.is_dark[row] = rows.is_any_seen(row_of_card) ? 0 : 1;
                    if (out.is_dark[row] == 0)
                      put_abundances(s.compiled, rows.weighed(row_of_card), row, out);
                  }};
  s.for_each(
      poses, task,
      [&](std::size_t row, const Pose &pose, const State::Prepared &at, State::Workspace &work) {
        // No colour is asked for but by rays, which go where the light is in doubt.
        const bool has_light =
            s.may_mend() ? s.sum(pose, at, work) : s.add_up(pose, at, work, false);
        out.is_dark[row] = has_light ? 0 : 1;
        if (work.has_variances)
          s.sum_variances(work);
        if (out.is_dark[row] == 0)
          put_abundances(s.compiled, work.sums, row, out);
      },
      from_cards);
  if (is_stopped(cancel))
    return fail(ErrorCode::Interrupted, "stopped by the user");
  return {};
}

Result<MaterialTables> Engine::tables_for(const Scene &materials) const {
  return make_material_tables(materials, state_->compiled, state_->scene.mesh,
                              state_->options.is_intensity_only);
}

} // namespace umov
