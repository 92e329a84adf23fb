#include <umov/light/articulated_engine.h>

#include "light/fast/state.h"

#include <algorithm>
#include <cmath>
#include <umov/core/parallel.h>

namespace umov {
namespace {

struct Sphere {
  Vec3<Body> centre{};
  double radius = 0;
};

Sphere around(std::span<const Vec3<Body>> points) {
  Vec3<Body> low{INFINITY, INFINITY, INFINITY}, high = -1 * low;
  for (const Vec3<Body> &p : points) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  Sphere out{(low + high) / 2, 0};
  for (const Vec3<Body> &p : points)
    out.radius = std::max(out.radius, norm(p - out.centre));
  return out;
}

/// Spheres that hold a mesh: its triangles halved along their longest spread until there are 32.
std::vector<Sphere> cover(const Mesh &mesh) {
  constexpr std::size_t pieces = 32;
  std::vector<std::vector<std::uint32_t>> parts{{}};
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
    parts[0].push_back(t);
  const auto corners = [&](const std::vector<std::uint32_t> &of) {
    std::vector<Vec3<Body>> out;
    for (const std::uint32_t t : of)
      for (const std::uint32_t v : mesh.triangles[t].vertex)
        out.push_back(mesh.positions[v]);
    return out;
  };
  while (parts.size() < pieces) {
    const auto largest = std::max_element(parts.begin(), parts.end(), [&](auto &a, auto &b) {
      return (a.size() < 2 ? 0 : around(corners(a)).radius) <
             (b.size() < 2 ? 0 : around(corners(b)).radius);
    });
    if (largest->size() < 2)
      break;
    const auto points = corners(*largest);
    Vec3<Body> low = points[0], high = points[0];
    for (const Vec3<Body> &p : points) {
      low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
      high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
    const Vec3<Body> d = high - low;
    const auto along = [&](std::uint32_t t) {
      const Triangle &x = mesh.triangles[t];
      const Vec3<Body> c =
          mesh.positions[x.vertex[0]] + mesh.positions[x.vertex[1]] + mesh.positions[x.vertex[2]];
      return d.x >= d.y && d.x >= d.z ? c.x : d.y >= d.z ? c.y : c.z;
    };
    std::stable_sort(largest->begin(), largest->end(),
                     [&](std::uint32_t a, std::uint32_t b) { return along(a) < along(b); });
    const auto half = static_cast<std::ptrdiff_t>(largest->size() / 2);
    std::vector<std::uint32_t> rest(largest->begin() + half, largest->end());
    largest->erase(largest->begin() + half, largest->end());
    parts.push_back(std::move(rest));
  }
  std::vector<Sphere> out;
  for (const auto &part : parts)
    if (!part.empty())
      out.push_back(around(corners(part)));
  return out;
}

/// Something of `other` may stand in a direction from something of `from`.
bool may_hide(const Sphere &from, const Sphere &other, Vec3<Body> direction) {
  const Vec3<Body> w = other.centre - from.centre;
  const double reach = from.radius + other.radius, ahead = dot(w, direction);
  return ahead > -reach && dot(w, w) - ahead * ahead < reach * reach;
}

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

} // namespace

struct ArticulatedEngine::State {
  struct Part {
    std::unique_ptr<Engine::State> engine;
    Occluder occluder;
    std::vector<Sphere> cover;
    std::vector<std::vector<Vec3<Body>>> points; ///< [group * lanes + lane]: ray origins
    std::vector<Sphere> bounds;                  ///< of the same classes

    Part(const Scene &scene, const EngineOptions &options);
  };
  std::vector<Joint> joints;
  std::vector<std::size_t> motion_of; ///< per part: its joint, or joints.size()
  std::vector<Part> parts;
  std::size_t bands = 0;
  bool has_u_or_v = false;

  /// What one thread needs.
  struct Workspace {
    std::vector<Engine::State::Workspace> parts;
    std::vector<Engine::State::Prepared> prepared; ///< per part
    std::vector<Pose> pose;                        ///< per part, in its axes
    std::vector<char> is_seen;                     ///< per part
    BandLight total;
    std::vector<Vec3<Body>> points;
    std::vector<Occluder::Point> origins, directions;
    std::vector<unsigned char> free;
    BandLight left;                                   ///< after what parts hide of each other
    bool is_mended = false;                           ///< rays were traced for some part
    std::vector<std::vector<std::uint32_t>> material; ///< [part][slot]
    std::size_t materials = 0;                        ///< 0: none are asked for
  };

  void evaluate(const Pose &pose, const std::vector<double> &angles, Workspace &work,
                std::size_t row, StokesTable &out) const;
  [[nodiscard]] std::vector<ReadLock> hold_masks(std::span<const Pose> poses,
                                                 std::span<const double> angles_rad,
                                                 unsigned threads) const;
  void light_parts(const std::vector<PartMotion> &motions, std::size_t row, Workspace &work,
                   StokesTable &out) const;
  void hide(std::size_t which, const std::vector<PartMotion> &to_part, Workspace &work) const;
  [[nodiscard]] std::size_t points_for(const Engine::State &engine,
                                       const Engine::State::Workspace &own, std::size_t k,
                                       const BandLight &total) const;
  [[nodiscard]] std::vector<bool> hidden(const Occluder &occluder, const PartMotion &there,
                                         Vec3<Body> direction, Workspace &work) const;
};

ArticulatedEngine::State::Part::Part(const Scene &scene, const EngineOptions &options)
    : engine(std::make_unique<Engine::State>(scene, options)), occluder(scene.mesh),
      cover(umov::cover(scene.mesh)) {
  engine->take_masks({});
  const GroupPlan &plan = engine->plan;
  points.resize(plan.groups.size() * backend::lanes);
  bounds.resize(points.size());
  double area = 0;
  for (const FacetClass &c : engine->classes.list)
    area += c.area_m2;
  parallel_for(plan.groups.size(), options.threads, [&](std::size_t g) {
    for (std::size_t lane = 0; lane < backend::lanes; ++lane) {
      const std::uint32_t member = plan.groups[g].member[lane];
      if (member == no_index)
        continue;
      // Large flats get more points: their light hangs on the edge of a shadow.
      const double share = engine->classes.list[member].area_m2 / area;
      const auto count = static_cast<std::size_t>(std::clamp(80'000 * share, 64.0, 4096.0));
      auto &to = points[g * backend::lanes + lane];
      for (const Occluder::Point &p :
           spread_points(engine->scene, engine->elements, engine->classes, member, count, occluder)
               .origin)
        to.push_back(occluder.from_point(p));
      bounds[g * backend::lanes + lane] = around(to);
    }
  });
}

/// Which of work.points (in this part's axes) another part hides in a direction; `there` takes
/// them to the other part's axes.
std::vector<bool> ArticulatedEngine::State::hidden(const Occluder &occluder,
                                                   const PartMotion &there, Vec3<Body> direction,
                                                   Workspace &work) const {
  const Vec3<Body> d = there.turn * direction;
  work.origins.clear();
  for (const Vec3<Body> &p : work.points)
    work.origins.push_back(occluder.to_point(there.place(p)));
  work.directions.assign(work.points.size(), {static_cast<float>(d.x), static_cast<float>(d.y),
                                              static_cast<float>(d.z)});
  work.free.resize(work.points.size());
  occluder.is_free(work.origins, work.directions, work.free);
  std::vector<bool> out(work.points.size());
  std::transform(work.free.begin(), work.free.end(), out.begin(),
                 [](unsigned char free) { return free == 0; });
  return out;
}

/// Points that bring the error of a class down to a third of 0.3 % of the whole light, if sampling
/// leaves 0.6 n^-3/4.
std::size_t ArticulatedEngine::State::points_for(const Engine::State &engine,
                                                 const Engine::State::Workspace &own, std::size_t k,
                                                 const BandLight &total) const {
  constexpr double wanted = 0.003, fewest = 24;
  double weight = 0;
  for (std::size_t b = 0; b < bands; ++b)
    weight =
        std::max(weight, own.facet_light[k * bands + b].i * own.uncertain[k].area *
                             engine.compiled.area_m2 / (wanted * std::max(total.i[b], 1e-300)));
  return static_cast<std::size_t>(std::max(std::pow(3 * 0.6 * weight, 4.0 / 3), fewest));
}

/// Takes away what other parts hide of this one's visible areas. work.total: the light without
/// that.
void ArticulatedEngine::State::hide(std::size_t which, const std::vector<PartMotion> &to_part,
                                    Workspace &work) const {
  const Part &part = parts[which];
  const Pose &pose = work.pose[which];
  const Engine::State::Prepared &prepared = work.prepared[which];
  const Engine::State &engine = *part.engine;
  Engine::State::Workspace &own = work.parts[which];
  std::vector<std::vector<Sphere>> others(parts.size());
  for (std::size_t q = 0; q < parts.size(); ++q)
    for (const Sphere &sphere : parts[q].cover)
      if (q != which)
        others[q].push_back({to_part[q].inverse().place(sphere.centre), sphere.radius});
  own.uncertain.reset(engine.views.whole.groups.size() * backend::lanes);
  backend::list_seen(engine.views.whole, engine.hiding(), mask_error, prepared.pose, own.uncertain);
  // Those that another part may come before.
  const auto is_apart = [&](const backend::SeenFacet &facet) {
    const Sphere &bounds = part.bounds[facet.group * backend::lanes + facet.lane];
    for (const auto &spheres : others)
      for (const Sphere &other : spheres)
        if (may_hide(bounds, other, pose.sun) || may_hide(bounds, other, pose.observer))
          return false;
    return true;
  };
  own.uncertain.truncate(static_cast<std::size_t>(
      std::remove_if(own.uncertain.begin(), own.uncertain.end(), is_apart) -
      own.uncertain.begin()));
  own.nothing.assign(engine.terms_max(), 0);
  own.facet_light.assign(own.uncertain.size() * bands, {});
  own.weights.assign(own.uncertain.size() * engine.terms_max(), 0);
  for (std::size_t k = 0; k < own.uncertain.size(); ++k) {
    backend::SeenFacet &facet = own.uncertain[k];
    const std::size_t at = facet.group * backend::lanes + facet.lane;
    engine.weigh(pose, prepared, k, own);
    const std::vector<Vec3<Body>> &all = part.points[at];
    const std::size_t count = std::min(all.size(), points_for(engine, own, k, work.total));
    work.points.clear();
    for (std::size_t i = 0; i < count; ++i) // spread over all of them
      work.points.push_back(all[(2 * i + 1) * all.size() / (2 * count)]);
    std::vector<bool> is_lost(count, false);
    for (std::size_t q = 0; q < parts.size(); ++q)
      for (const Vec3<Body> direction : {pose.sun, pose.observer}) {
        const bool is_near =
            std::any_of(others[q].begin(), others[q].end(), [&](const Sphere &other) {
              return may_hide(part.bounds[at], other, direction);
            });
        if (!is_near)
          continue;
        const auto gone = hidden(parts[q].occluder, to_part[q], direction, work);
        for (std::size_t i = 0; i < count; ++i)
          is_lost[i] = is_lost[i] || gone[i];
      }
    if (std::none_of(is_lost.begin(), is_lost.end(), [](bool lost) { return lost; }))
      continue;
    // Of the points that the part itself leaves free, those that others hide.
    std::vector<bool> is_free(count, true);
    if (engine.hiding() != nullptr)
      for (const Vec3<Body> direction : {pose.sun, pose.observer}) {
        const auto gone = hidden(part.occluder, {}, direction, work);
        for (std::size_t i = 0; i < count; ++i)
          is_free[i] = is_free[i] && !gone[i];
      }
    std::size_t free = 0, lost = 0;
    for (std::size_t i = 0; i < count; ++i) {
      free += is_free[i] ? 1u : 0u;
      lost += is_free[i] && is_lost[i] ? 1u : 0u;
    }
    if (free == 0 || lost == 0)
      continue;
    const double n = static_cast<double>(free), share = static_cast<double>(lost) / n;
    const double before = facet.area;
    engine.change_area(k, -before * share, own);
    // One pseudo-disagreement stands for slivers that no point has found.
    const double unsure = std::clamp(share, 0.5 / n, 1 - 0.5 / n);
    engine.add_variance(k,
                        before * before * static_cast<double>(mask_error.points) * unsure *
                            (1 - unsure) / (n * std::sqrt(n)),
                        own);
  }
  engine.take_roots(own, true);
}

void ArticulatedEngine::State::evaluate(const Pose &pose, const std::vector<double> &angles,
                                        Workspace &work, std::size_t row, StokesTable &out) const {
  std::vector<PartMotion> motions = part_motions(joints, angles);
  motions.emplace_back(); // what stands still
  work.total.reset(bands, true);
  work.is_seen.assign(parts.size(), 0);
  for (std::size_t p = 0; p < parts.size(); ++p) {
    work.pose[p] = seen_from(motions[motion_of[p]], pose);
    const Engine::State &engine = *parts[p].engine;
    engine.prepare(work.pose[p], work.prepared[p]);
    if (!engine.sum(work.pose[p], work.prepared[p], work.parts[p]))
      continue;
    work.is_seen[p] = 1;
    engine.colour(work.parts[p]);
    work.total.add_scaled(work.parts[p].light, engine.compiled.area_m2);
  }
  if (std::find(work.is_seen.begin(), work.is_seen.end(), 1) == work.is_seen.end())
    return put_darkness(row, out);
  light_parts(motions, row, work, out);
  put_light(work.left, 1, has_scattering_plane(pose), has_u_or_v, row, out);
  out.method[row] = work.is_mended ? PoseMethod::Mended : PoseMethod::Masks;
}

/// Masks of all parts, in the directions that these see.
std::vector<ReadLock> ArticulatedEngine::State::hold_masks(std::span<const Pose> poses,
                                                           std::span<const double> angles_rad,
                                                           unsigned threads) const {
  std::vector<std::vector<Pose>> by_part(parts.size());
  std::vector<double> angles(joints.size());
  for (std::size_t k = 0; k < poses.size(); ++k) {
    std::copy_n(angles_rad.begin() + static_cast<std::ptrdiff_t>(k * angles.size()), angles.size(),
                angles.begin());
    std::vector<PartMotion> motions = part_motions(joints, angles);
    motions.emplace_back(); // what stands still
    for (std::size_t p = 0; p < parts.size(); ++p)
      by_part[p].push_back(seen_from(motions[motion_of[p]], poses[k]));
  }
  std::vector<ReadLock> out;
  for (std::size_t p = 0; p < parts.size(); ++p)
    out.push_back(parts[p].engine->hold_masks(by_part[p], threads));
  return out;
}

/// The light of all parts after what they hide of each other, and the columns asked for.
void ArticulatedEngine::State::light_parts(const std::vector<PartMotion> &motions, std::size_t row,
                                           Workspace &work, StokesTable &out) const {
  work.left.reset(bands, true);
  work.is_mended = false;
  double glint = 0;
  for (std::size_t p = 0; p < parts.size(); ++p) {
    if (work.is_seen[p] == 0)
      continue;
    std::vector<PartMotion> to_part;
    for (std::size_t q = 0; q < parts.size(); ++q)
      to_part.push_back(motions[motion_of[q]].inverse() * motions[motion_of[p]]);
    hide(p, to_part, work);
    const Engine::State &engine = *parts[p].engine;
    Engine::State::Workspace &own = work.parts[p];
    if (work.materials > 0)
      engine.colour_by_material(work.material[p],
                                out.material_i.data() + row * work.materials * bands, own);
    else
      engine.colour(own);
    work.left.add_scaled(own.light, engine.compiled.area_m2);
    work.is_mended = work.is_mended || own.is_mended;
    if (!out.glint_share.empty())
      glint += engine.glint_share(work.pose[p], work.prepared[p], own) * own.light.i[0] *
               engine.compiled.area_m2;
  }
  if (!out.glint_share.empty() && work.left.i[0] > 0)
    out.glint_share[row] = glint / work.left.i[0];
}

ArticulatedEngine::ArticulatedEngine(const Scene &scene, const std::vector<Joint> &joints,
                                     const EngineOptions &options)
    : state_(std::make_unique<State>()) {
  state_->joints = joints;
  state_->bands = scene.bands.size();
  const auto joint_of = joint_of_groups(scene.mesh, joints);
  for (std::size_t k = 0; k <= joints.size(); ++k) {
    const Scene part = part_of(scene, joint_of, k);
    if (part.mesh.triangles.empty())
      continue;
    state_->motion_of.push_back(k);
    state_->parts.emplace_back(part, options);
    state_->has_u_or_v = state_->has_u_or_v || state_->parts.back().engine->compiled.has_u;
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
  for (const State::Part &part : state_->parts)
    bytes += part.engine->masks ? part.engine->masks->bytes() : 0;
  return bytes;
}

void ArticulatedEngine::keep_masks() const {
  for (const State::Part &part : state_->parts)
    part.engine->keep_masks();
}

bool ArticulatedEngine::evaluate(std::span<const Pose> poses, std::span<const double> angles_rad,
                                 StokesTable &out, const LightTask &task,
                                 std::span<const std::uint32_t> material_of) const {
  const State &s = *state_;
  out.resize(poses.size(), s.bands);
  if (task.has_glints)
    out.glint_share.assign(poses.size(), 0);
  const std::size_t materials =
      task.has_materials ? *std::max_element(material_of.begin(), material_of.end()) + 1 : 0;
  out.material_i.assign(poses.size() * materials * s.bands, 0);
  const std::vector<ReadLock> held = s.hold_masks(poses, angles_rad, task.threads);
  constexpr std::size_t block = 64;
  parallel_for((poses.size() + block - 1) / block, task.threads, [&](std::size_t begin) {
    State::Workspace work;
    work.materials = materials;
    for (const State::Part &part : s.parts) {
      work.parts.emplace_back(*part.engine);
      work.material.emplace_back();
      for (std::size_t slot = 0; materials > 0 && slot < part.engine->compiled.slots.size(); ++slot)
        work.material.back().push_back(material_of[part.engine->compiled.slots[slot].front()]);
    }
    work.prepared.resize(s.parts.size());
    work.pose.resize(s.parts.size());
    std::vector<double> angles(s.joints.size());
    for (std::size_t k = begin * block; k < std::min(poses.size(), (begin + 1) * block); ++k) {
      if (task.cancel != nullptr && *task.cancel)
        return;
      std::copy_n(angles_rad.begin() + static_cast<std::ptrdiff_t>(k * angles.size()),
                  angles.size(), angles.begin());
      s.evaluate(poses[k], angles, work, k, out);
    }
  });
  return task.cancel == nullptr || !*task.cancel;
}

} // namespace umov
