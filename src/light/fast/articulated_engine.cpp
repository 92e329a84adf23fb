#include <umov/light/articulated_engine.h>

#include "light/fast/state.h"

#include <algorithm>
#include <cmath>
#include <umov/core/parallel.h>

namespace umov {
namespace {

/// A pose as a part sees it that has moved.
Pose seen_from(const PartMotion &motion, Pose pose) {
  const PartMotion own = motion.inverse();
  pose.sun = normalized(own.turn * pose.sun);
  pose.observer = normalized(own.turn * pose.observer);
  return pose;
}

/// The triangles of one rigid part.
Scene part_of(const Scene &scene, const std::vector<std::size_t> &joint_of, std::size_t which) {
  Scene out = scene;
  out.mesh.triangles.clear();
  out.mesh.tangents.clear();
  for (std::size_t t = 0; t < scene.mesh.triangles.size(); ++t)
    if (joint_of[scene.mesh.triangles[t].front] == which) {
      out.mesh.triangles.push_back(scene.mesh.triangles[t]);
      if (!scene.mesh.tangents.empty())
        out.mesh.tangents.push_back(scene.mesh.tangents[t]);
    }
  return out;
}

/// What one part may hide of another is looked for with so many points that this part of the whole
/// light may be missed where no accuracy is asked for (standard deviation).
constexpr double others_missed = 0.003;

} // namespace

struct ArticulatedEngine::State {
  struct Part {
    std::unique_ptr<Engine::State> engine;
    Occluder occluder;
    std::vector<Sphere> cover;
    RefinePoints points;

    Part(const Scene &scene, const EngineOptions &options, const std::atomic<bool> *cancel);
  };
  std::vector<Joint> joints;
  std::vector<std::size_t> motion_of; ///< per part: its joint, or joints.size()
  std::vector<std::unique_ptr<Part>> parts;
  std::size_t bands = 0;
  bool has_u_or_v = false;
  double refine_above = 0;

  /// What one thread needs of a part.
  struct PartWork {
    explicit PartWork(const Part &part);
    Engine::State::Workspace own;
    Engine::State::Prepared prepared;
    Pose pose; ///< in the part's axes
    std::vector<OtherPart> others;
    bool has_light = false;
    std::vector<std::uint32_t> material; ///< per slot
  };
  /// What one thread needs.
  struct Workspace {
    std::vector<PartWork> parts;
    BandLight total;           ///< [m2/sr]
    std::size_t materials = 0; ///< 0: none are asked for
  };

  [[nodiscard]] Workspace workspace(std::size_t materials,
                                    std::span<const std::uint32_t> material_of) const;
  [[nodiscard]] std::vector<PartMotion> motions(std::span<const double> angles) const;
  void evaluate(const Pose &pose, std::span<const double> angles, Workspace &work, std::size_t row,
                StokesTable &out) const;
  [[nodiscard]] std::vector<ReadLock> hold_masks(std::span<const Pose> poses,
                                                 std::span<const double> angles_rad,
                                                 const LightTask &task) const;
  bool add_up(const Pose &pose, const std::vector<PartMotion> &to_body, Workspace &work) const;
  void place_others(std::size_t which, const std::vector<PartMotion> &to_body,
                    PartWork &part) const;
  void sum(Workspace &work) const;
  void list(std::size_t which, PartWork &part) const;
  void look_at_others(std::size_t which, PartWork &part) const;
  void look_at_facet(const Engine::State &engine, std::size_t k, PartWork &part) const;
  void take_roots(const Engine::State &engine, PartWork &part) const;
  void mend(Workspace &work) const;
  void put(const Pose &pose, const Workspace &work, std::size_t row, StokesTable &out) const;
  void put_columns(Workspace &work, std::size_t row, StokesTable &out) const;
};

ArticulatedEngine::State::Part::Part(const Scene &scene, const EngineOptions &options,
                                     const std::atomic<bool> *cancel)
    : engine(std::make_unique<Engine::State>(scene, options, cancel)),
      occluder(scene.mesh, Occluder::Rays::Each, cancel), cover(umov::cover(scene.mesh)) {
  engine->take_masks({}, cancel);
  points = RefinePoints(engine->scene, engine->elements, engine->classes, engine->plan, occluder);
}

ArticulatedEngine::State::PartWork::PartWork(const Part &part) : own(*part.engine) {
  own.tracer.emplace(part.points, part.occluder, part.engine->hiding() != nullptr);
}

ArticulatedEngine::State::Workspace
ArticulatedEngine::State::workspace(std::size_t materials,
                                    std::span<const std::uint32_t> material_of) const {
  Workspace out;
  out.materials = materials;
  for (const auto &part : parts) {
    out.parts.emplace_back(*part);
    for (std::size_t slot = 0; materials > 0 && slot < part->engine->compiled.slots.size(); ++slot)
      out.parts.back().material.push_back(material_of[part->engine->compiled.slots[slot].front()]);
  }
  return out;
}

/// Of all joints, and of what stands still.
std::vector<PartMotion> ArticulatedEngine::State::motions(std::span<const double> angles) const {
  std::vector<PartMotion> out = part_motions(joints, {angles.begin(), angles.end()});
  out.emplace_back();
  return out;
}

void ArticulatedEngine::State::place_others(std::size_t which,
                                            const std::vector<PartMotion> &to_body,
                                            PartWork &part) const {
  part.others.clear();
  for (std::size_t q = 0; q < parts.size(); ++q) {
    if (q == which)
      continue;
    OtherPart other{
        &parts[q]->occluder, to_body[motion_of[q]].inverse() * to_body[motion_of[which]], {}};
    const PartMotion back = other.there.inverse();
    for (const Sphere &sphere : parts[q]->cover)
      other.cover.push_back({back.place(sphere.centre), sphere.radius});
    part.others.push_back(std::move(other));
  }
  part.own.tracer->set_others(part.others);
}

/// The light of every part as if it were alone; false if no part has any, beyond doubt.
bool ArticulatedEngine::State::add_up(const Pose &pose, const std::vector<PartMotion> &to_body,
                                      Workspace &work) const {
  bool is_any = false;
  for (std::size_t p = 0; p < parts.size(); ++p) {
    const Engine::State &engine = *parts[p]->engine;
    PartWork &part = work.parts[p];
    part.pose = seen_from(to_body[motion_of[p]], pose);
    engine.prepare(part.pose, part.prepared);
    part.has_light = engine.add_up(part.pose, part.prepared, part.own);
    is_any = is_any || part.has_light;
    if (part.has_light)
      place_others(p, to_body, part);
  }
  return is_any;
}

/// The light of the whole from the sums of its parts.
void ArticulatedEngine::State::sum(Workspace &work) const {
  work.total.reset(bands, true);
  for (std::size_t p = 0; p < parts.size(); ++p) {
    PartWork &part = work.parts[p];
    if (!part.has_light)
      continue;
    parts[p]->engine->colour(part.own);
    work.total.add_scaled(part.own.light, parts[p]->engine->compiled.area_m2);
  }
}

/// Facets to look at: all that could be seen, with variances of their own, where an accuracy is
/// asked for; else those that another part may come before.
void ArticulatedEngine::State::list(std::size_t which, PartWork &part) const {
  const Engine::State &engine = *parts[which]->engine;
  Engine::State::Workspace &own = part.own;
  engine.list_uncertain(part.pose, part.prepared, refine_above > 0 ? doubtful_error : mask_error,
                        own);
  if (!(refine_above > 0))
    own.uncertain.keep_if([&](const backend::SeenFacet &facet) {
      return own.tracer->has_others_before(facet, part.pose);
    });
}

/// Whether another part hides something of a facet; if so its share is traced, all parts in the
/// way.
void ArticulatedEngine::State::look_at_facet(const Engine::State &engine, std::size_t k,
                                             PartWork &part) const {
  Engine::State::Workspace &own = part.own;
  const backend::SeenFacet &facet = own.uncertain.facets[k];
  const double whole = engine.compiled.data.groups[facet.group].area[facet.lane];
  const double missed = refine_above > 0 ? 0.9 * refine_above / normal_95 : others_missed;
  const std::size_t points = first_points(own.error_per_area[k] * whole / missed);
  const TracedShare free = own.tracer->trace_others(facet, points, part.pose);
  if (free.share < 1) {
    own.is_mended = true;
    return engine.trace_facet(part.pose, k, points, own);
  }
  own.uncertain.facets[k].variance +=
      facet.area * facet.area * share_variance(1, static_cast<double>(free.points));
}

/// Takes away what other parts hide of this one's visible areas.
void ArticulatedEngine::State::look_at_others(std::size_t which, PartWork &part) const {
  const Engine::State &engine = *parts[which]->engine;
  engine.weigh_errors(part.own);
  for (std::size_t k = 0; k < part.own.uncertain.facets.size(); ++k) {
    const double before = part.own.uncertain.facets[k].variance;
    if (part.own.tracer->has_others_before(part.own.uncertain.facets[k], part.pose))
      look_at_facet(engine, k, part);
    if (!(refine_above > 0)) // the sums hold what there was before
      engine.add_variance(k, std::max(part.own.uncertain.facets[k].variance - before, 0.0),
                          part.own);
  }
  take_roots(engine, part);
}

void ArticulatedEngine::State::take_roots(const Engine::State &engine, PartWork &part) const {
  if (refine_above > 0)
    engine.add_up_variances(part.own);
  engine.take_roots(part.own, true);
}

/// Rays for what makes the error, if there is too much of it, shared out by what each part makes.
void ArticulatedEngine::State::mend(Workspace &work) const {
  const auto refer = [&](std::size_t p) {
    parts[p]->engine->refer_to(work.total, 1, work.parts[p].own);
  };
  std::vector<double> variance(parts.size(), 0);
  double all = 0;
  for (std::size_t p = 0; p < parts.size(); ++p) {
    if (!work.parts[p].has_light)
      continue;
    refer(p);
    const Engine::State::Workspace &own = work.parts[p].own;
    for (std::size_t b = 0; b < bands; ++b)
      variance[p] =
          std::max(variance[p], own.light.var_i[b] / (own.reference[b] * own.reference[b]));
    all += variance[p];
  }
  for (std::size_t p = 0; p < parts.size(); ++p) {
    const Engine::State &engine = *parts[p]->engine;
    PartWork &part = work.parts[p];
    if (!part.has_light || !engine.is_uncertain(work.total, 1, part.own) || !(variance[p] > 0))
      continue;
    engine.trace(part.pose, part.prepared, variance[p] / all, part.own);
    part.own.is_mended = true;
    take_roots(engine, part);
  }
}

void ArticulatedEngine::State::evaluate(const Pose &pose, std::span<const double> angles,
                                        Workspace &work, std::size_t row, StokesTable &out) const {
  out.method[row] = PoseMethod::Masks;
  if (!add_up(pose, motions(angles), work))
    return put_darkness(row, out);
  sum(work);
  for (std::size_t p = 0; p < parts.size(); ++p) {
    if (!work.parts[p].has_light)
      continue;
    parts[p]->engine->refer_to(work.total, 1, work.parts[p].own);
    list(p, work.parts[p]);
    look_at_others(p, work.parts[p]);
  }
  sum(work);
  if (refine_above > 0) {
    mend(work);
    sum(work);
  }
  put(pose, work, row, out);
  put_columns(work, row, out);
}

void ArticulatedEngine::State::put(const Pose &pose, const Workspace &work, std::size_t row,
                                   StokesTable &out) const {
  put_light(work.total, 1, has_scattering_plane(pose), has_u_or_v, row, out);
  bool is_seen = has_any_light(work.total);
  for (const PartWork &part : work.parts) {
    is_seen = is_seen || (part.has_light && part.own.sums.is_any_seen);
    if (part.has_light && part.own.is_mended)
      out.method[row] = PoseMethod::Mended;
  }
  out.is_dark[row] = is_seen ? 0 : 1;
}

/// Masks of all parts, in the directions that these see.
std::vector<ReadLock> ArticulatedEngine::State::hold_masks(std::span<const Pose> poses,
                                                           std::span<const double> angles_rad,
                                                           const LightTask &task) const {
  std::vector<std::vector<Pose>> by_part(parts.size());
  for (std::size_t k = 0; k < poses.size(); ++k) {
    const auto to_body = motions(angles_rad.subspan(k * joints.size(), joints.size()));
    for (std::size_t p = 0; p < parts.size(); ++p)
      by_part[p].push_back(seen_from(to_body[motion_of[p]], poses[k]));
  }
  std::vector<ReadLock> out;
  for (std::size_t p = 0; p < parts.size(); ++p)
    out.push_back(parts[p]->engine->hold_masks(by_part[p], task));
  return out;
}

/// The columns asked for.
void ArticulatedEngine::State::put_columns(Workspace &work, std::size_t row,
                                           StokesTable &out) const {
  double glint = 0;
  for (std::size_t p = 0; p < parts.size(); ++p) {
    const Engine::State &engine = *parts[p]->engine;
    PartWork &part = work.parts[p];
    if (!part.has_light)
      continue;
    if (work.materials > 0)
      engine.colour_by_material(part.material, out.material_i.data() + row * work.materials * bands,
                                part.own);
    if (!out.glint_share.empty())
      glint += engine.glint_share(part.pose, part.prepared, part.own) * part.own.light.i[0] *
               engine.compiled.area_m2;
  }
  if (!out.glint_share.empty() && work.total.i[0] > 0)
    out.glint_share[row] = glint / work.total.i[0];
}

ArticulatedEngine::ArticulatedEngine(const Scene &scene, const std::vector<Joint> &joints,
                                     const EngineOptions &options, const std::atomic<bool> *cancel)
    : state_(std::make_unique<State>()) {
  state_->joints = joints;
  state_->bands = scene.grid.nodes().size();
  state_->refine_above = options.masks.refine_above;
  const auto joint_of = joint_of_groups(scene.mesh, joints);
  for (std::size_t k = 0; k <= joints.size(); ++k) {
    const Scene part = part_of(scene, joint_of, k);
    if (part.mesh.triangles.empty())
      continue;
    state_->motion_of.push_back(k);
    state_->parts.push_back(std::make_unique<State::Part>(part, options, cancel));
    state_->has_u_or_v = state_->has_u_or_v || state_->parts.back()->engine->compiled.has_u;
  }
}

ArticulatedEngine::~ArticulatedEngine() = default;
ArticulatedEngine::ArticulatedEngine(ArticulatedEngine &&) noexcept = default;
ArticulatedEngine &ArticulatedEngine::operator=(ArticulatedEngine &&) noexcept = default;

void ArticulatedEngine::evaluate(std::span<const Pose> poses, std::span<const double> angles_rad,
                                 StokesTable &out, unsigned threads) const {
  LightTask task;
  task.threads = threads;
  (void)evaluate(poses, angles_rad, out, task);
}

std::size_t ArticulatedEngine::mask_bytes() const {
  std::size_t bytes = 0;
  for (const auto &part : state_->parts)
    bytes += part->engine->masks ? part->engine->masks->bytes() : 0;
  return bytes;
}

void ArticulatedEngine::keep_masks() const {
  for (const auto &part : state_->parts)
    part->engine->keep_masks();
}

bool ArticulatedEngine::evaluate(std::span<const Pose> poses, std::span<const double> angles_rad,
                                 StokesTable &out, const LightTask &task,
                                 std::span<const std::uint32_t> material_of) const {
  const State &s = *state_;
  out.resize(poses.size(), s.bands);
  if (task.has_glints)
    out.glint_share.assign(poses.size(), 0);
  const std::size_t materials = task.has_materials && !material_of.empty()
                                    ? *std::max_element(material_of.begin(), material_of.end()) + 1
                                    : 0;
  out.material_i.assign(poses.size() * materials * s.bands, 0);
  const std::vector<ReadLock> held = s.hold_masks(poses, angles_rad, task);
  constexpr std::size_t block = 64;
  parallel_for((poses.size() + block - 1) / block, task.threads, [&](std::size_t begin) {
    State::Workspace work = s.workspace(materials, material_of);
    for (std::size_t k = begin * block; k < std::min(poses.size(), (begin + 1) * block); ++k) {
      if (is_stopped(task.cancel))
        return;
      s.evaluate(poses[k], angles_rad.subspan(k * s.joints.size(), s.joints.size()), work, k, out);
    }
  });
  return !is_stopped(task.cancel);
}

} // namespace umov
