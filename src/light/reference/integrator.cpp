#include <umov/light/integrator.h>

#include "light/between/bounce_scene.h"
#include "light/between/chain_store.h"
#include "light/between/indirect.h"
#include "light/between/path_sampler.h"
#include "light/reference/visibility.h"
#include "light/unless_stopped.h"

#include <cmath>
#include <limits>
#include <map>
#include <mutex>
#include <optional>
#include <umov/core/parallel.h>
#include <umov/core/stop.h>
#include <umov/shape/topology.h>

namespace umov {
namespace {

/// Rounding of a sum of positive terms, in parts of the sum: some units in the last place.
constexpr double rounding = 16 * std::numeric_limits<double>::epsilon();

/// What paths are drawn on.
struct PathGround {
  const BounceScene &scene;
  const Occluder &occluder;
};

/// Slots of the one are slots of the other. Without a mesh of its own a scene is on any.
bool is_on_mesh_of(const Scene &a, const Scene &b) {
  if (a.front.size() != b.front.size() || a.back.size() != b.back.size())
    return false;
  if (a.mesh.triangles.empty())
    return true;
  const auto is_alike = [](const Triangle &s, const Triangle &t) {
    return s.vertex == t.vertex && s.normal == t.normal && s.front == t.front && s.back == t.back;
  };
  const auto &x = a.mesh.triangles, &y = b.mesh.triangles;
  return a.normals == b.normals && std::equal(x.begin(), x.end(), y.begin(), y.end(), is_alike) &&
         a.mesh.positions == b.mesh.positions && a.mesh.normals == b.mesh.normals &&
         a.mesh.tangents == b.mesh.tangents;
}

} // namespace

ChainSharing without_meshes(ChainSharing sharing, const Scene &scene) {
  std::erase_if(sharing.also, [&](const Scene &other) { return !is_on_mesh_of(other, scene); });
  for (Scene &other : sharing.also)
    other.mesh = {};
  return sharing;
}

struct Integrator::State {
  State(const Scene &of, const std::atomic<bool> *cancel, ChainSharing shared)
      : scene(of), sharing(without_meshes(std::move(shared), of)),
        is_convex(is_proven_convex(of.mesh, cancel)), sides(visible_sides(of.mesh, cancel)),
        elements(make_elements(scene, sides, cancel)) {
    if (!is_convex)
      occluder.emplace(scene.mesh, Occluder::Rays::Each, cancel);
  }
  /// Made when it is first asked for: direct light needs none of it. A convex body, of which
  /// nothing is hidden, has ray tests from then on.
  PathGround paths(const std::atomic<bool> *cancel) const {
    std::call_once(has_bounces, [&] {
      if (!occluder)
        occluder.emplace(scene.mesh, Occluder::Rays::Each, cancel);
      bounces.emplace(scene, sides);
    });
    return {*bounces, *occluder};
  }
  /// Chains of up to so many surfaces; null where they cannot draw anything.
  const ChainStore *chains(const IntegrationOptions &options,
                           const std::atomic<bool> *cancel) const {
    if (options.between != BetweenMethod::Chains || !is_sunlight(options.source))
      return nullptr;
    const PathGround ground = paths(cancel);
    const WriteLock lock(store_mutex);
    auto &store = stores[{options.bounces, options.seed}];
    if (!store) {
      const ChainKey key{options.bounces, options.seed};
      Taken chains = taken(key, cancel);
      if (!chains.drawing)
        chains = {own_drawing(key, ground, cancel), own_surfaces(cancel)};
      store = std::make_unique<const ChainStore>(std::move(chains.drawing), scene,
                                                 std::move(chains.surfaces));
    }
    return store->surfaces().has_any() ? store.get() : nullptr;
  }
  /// How many surfaces, and the seed.
  using ChainKey = std::pair<std::size_t, std::uint64_t>;
  /// Whose chains, and this scene's surfaces as their ends.
  struct Taken {
    std::shared_ptr<const ChainDrawing> drawing;
    std::shared_ptr<const ChainSurfaces> surfaces;
  };
  /// The elder's chains; null where they do not serve. Under the mutex, as what it calls.
  Taken taken(ChainKey key, const std::atomic<bool> *cancel) const {
    if (!sharing.elder || !is_on_mesh_of(scene, sharing.elder->state_->scene))
      return {};
    std::shared_ptr<const ChainDrawing> drawing;
    {
      const State &elder = *sharing.elder->state_;
      const PathGround ground = elder.paths(cancel);
      const WriteLock lock(elder.store_mutex);
      drawing = elder.own_drawing(key, ground, cancel);
    }
    const ChainCover &cover = drawing->cover();
    if (const auto member = cover.member_like(scene)) {
      if (!surfaces)
        surfaces = std::make_shared<const ChainSurfaces>(cover.surfaces(*member),
                                                         cover.sides(*member), scene);
      return {std::move(drawing), surfaces};
    }
    if (!drawing->serves(scene, *own_surfaces(cancel), cancel))
      return {};
    return {std::move(drawing), surfaces};
  }

  Scene scene;
  ChainSharing sharing;
  bool is_convex;
  std::vector<VisibleSides> sides;
  Elements elements;
  mutable std::optional<Occluder> occluder; ///< direct light of a convex mesh does not ask for it

  mutable Mutex store_mutex;

private:
  /// Tabulated once.
  std::shared_ptr<const ChainSurfaces> own_surfaces(const std::atomic<bool> *cancel) const {
    if (!surfaces)
      surfaces = std::make_shared<const ChainSurfaces>(scene, cancel);
    return surfaces;
  }
  std::shared_ptr<const ChainDrawing> own_drawing(ChainKey key, const PathGround &ground,
                                                  const std::atomic<bool> *cancel) const {
    auto &drawing = drawings[key];
    if (!drawing) {
      while (others.size() < sharing.also.size()) {
        const Scene &other = sharing.also[others.size()];
        others.push_back({&other, std::make_shared<const ChainSurfaces>(other, cancel)});
      }
      std::vector<ChainMember> members{{&scene, own_surfaces(cancel)}};
      members.insert(members.end(), others.begin(), others.end());
      drawing = std::make_shared<const ChainDrawing>(ground.scene, ground.occluder,
                                                     ChainCover(std::move(members), cancel),
                                                     key.first, key.second, cancel);
    }
    return drawing;
  }
  mutable std::once_flag has_bounces;
  mutable std::optional<BounceScene> bounces;
  mutable std::shared_ptr<const ChainSurfaces> surfaces;
  mutable std::vector<ChainMember> others; ///< of sharing.also
  mutable std::map<ChainKey, std::shared_ptr<const ChainDrawing>> drawings;
  mutable std::map<ChainKey, std::unique_ptr<const ChainStore>> stores;
};

Integrator::Integrator(const Scene &scene, const std::atomic<bool> *cancel, ChainSharing sharing)
    : state_(std::make_unique<State>(scene, cancel, std::move(sharing))) {}
Integrator::~Integrator() = default;
Integrator::Integrator(Integrator &&) noexcept = default;
Integrator &Integrator::operator=(Integrator &&) noexcept = default;

bool Integrator::is_convex() const { return state_->is_convex; }

bool Integrator::takes_chains(std::size_t bounces, std::uint64_t seed,
                              const std::atomic<bool> *cancel) const {
  const WriteLock lock(state_->store_mutex);
  return state_->taken({bounces, seed}, cancel).drawing != nullptr;
}

/// Throws Failure where it is stopped.
PoseResult Integrator::direct(const Pose &pose, const IntegrationOptions &options,
                              const std::atomic<bool> *cancel) const {
  const Scene &scene = state_->scene;
  const std::size_t bands = scene.grid.nodes().size(), groups = scene.mesh.groups.size();
  const PoseGeometry geometry = geometry_of(pose);
  const LitElements lit = light_elements(scene, state_->elements, geometry, options.source, cancel);
  const VisibleSums sums =
      state_->is_convex
          ? sum_unhidden(scene, lit)
          : sum_visible(scene, state_->elements, *state_->occluder, geometry, lit, options, cancel);
  PoseResult out;
  out.rays = sums.rays;
  out.is_dark = !sums.is_any_seen;
  out.bands.resize(bands);
  out.slot_i.assign(2 * groups * bands, 0);
  for (std::size_t b = 0; b < bands; ++b) {
    BandResult &band = out.bands[b];
    for (std::size_t slot = 0; slot < 2 * groups; ++slot) {
      const Stokes<ScatteringPlane> light =
          lit.fresnel[slot * bands + b] * sums.specular[slot * lit.lobes + lit.lobe_of(b)] +
          sums.diffuse[slot * bands + b];
      band.stokes += light;
      out.slot_i[slot * bands + b] = light.i;
    }
    const double floor = rounding * band.stokes.i;
    const Stokes<ScatteringPlane> &rule = sums.rule_variance[b];
    band.half_width = sums.half_width[b];
    band.half_width += Stokes<ScatteringPlane>{std::sqrt(rule.i), std::sqrt(rule.q),
                                               std::sqrt(rule.u), std::sqrt(rule.v)};
    band.half_width.i += floor;
    band.half_width.q += floor;
    if (lit.has_u_or_v) {
      band.half_width.u += floor;
      band.half_width.v += floor;
    }
    if (!geometry.has_plane && options.source.q == 0 && options.source.u == 0)
      band.stokes.q = band.stokes.u = 0;
  }
  if (bands > 0 && out.bands[0].stokes.i > 0)
    out.glint_share = sums.glint / out.bands[0].stokes.i;
  return out;
}

namespace {

void add(const IndirectLight &light, PoseResult &out) {
  const double direct = out.bands.empty() ? 0 : out.bands[0].stokes.i;
  out.rays += light.rays;
  for (std::size_t b = 0; b < out.bands.size(); ++b) {
    const BandResult &more = light.bands[b];
    out.indirect.push_back(more.stokes);
    umov::add(more, out.bands[b]);
    out.is_dark = out.is_dark && !(more.stokes.i > 0);
  }
  if (direct > 0)
    out.glint_share *= direct / out.bands[0].stokes.i;
}

std::vector<IndirectLight>
by_paths(const PathGround &ground, std::span<const Pose> poses, std::span<const double> direct_i,
         const IntegrationOptions &options, unsigned threads, const std::atomic<bool> *cancel,
         const ThermalEmission *emission, const ChainSurfaces *chains = nullptr) {
  constexpr std::size_t block = 1024; // poses whose sums are held at a time
  const std::size_t bands = poses.empty() ? 0 : direct_i.size() / poses.size();
  std::vector<IndirectLight> out;
  for (std::size_t begin = 0; begin < poses.size(); begin += block) {
    const std::size_t count = std::min(block, poses.size() - begin);
    auto part = indirect_light(ground.scene, ground.occluder, poses.subspan(begin, count), options,
                               direct_i.subspan(begin * bands, count * bands), threads, cancel,
                               emission, chains);
    if (part.empty())
      return {};
    std::move(part.begin(), part.end(), std::back_inserter(out));
  }
  return out;
}

/// The rows `which` of some table.
template <class T>
std::vector<T> rows(std::span<const T> all, const std::vector<std::size_t> &which,
                    std::size_t width) {
  std::vector<T> out;
  for (const std::size_t k : which)
    out.insert(out.end(), all.begin() + static_cast<std::ptrdiff_t>(k * width),
               all.begin() + static_cast<std::ptrdiff_t>((k + 1) * width));
  return out;
}

/// Chains, and paths for what they leave out and for poses that met too few of them.
std::vector<IndirectLight> by_chains(const ChainStore &store, const PathGround &ground,
                                     std::span<const Pose> poses, std::span<const double> direct_i,
                                     const IntegrationOptions &options, unsigned threads,
                                     const std::atomic<bool> *cancel) {
  const std::size_t bands = poses.empty() ? 0 : direct_i.size() / poses.size();
  ChainStore::Answer found = store.light(poses, direct_i, options, threads, cancel);
  std::vector<std::size_t> enough, few;
  for (std::size_t k = 0; k < found.is_enough.size(); ++k)
    (found.is_enough[k] != 0 ? enough : few).push_back(k);
  const auto draw = [&](const std::vector<std::size_t> &which, std::span<const double> beside,
                        const ChainSurfaces *chains) {
    const std::vector<Pose> at = rows<Pose>(poses, which, 1);
    return by_paths(ground, at, rows<double>(beside, which, bands), options, threads, cancel,
                    nullptr, chains);
  };
  auto alone = draw(few, direct_i, nullptr);
  for (std::size_t k = 0; k < alone.size(); ++k)
    found.light[few[k]] = std::move(alone[k]);
  if (!store.surfaces().needs_paths() || enough.empty())
    return is_stopped(cancel) ? std::vector<IndirectLight>{} : std::move(found.light);
  std::vector<double> beside(direct_i.begin(), direct_i.end());
  for (std::size_t k = 0; k < beside.size(); ++k)
    beside[k] += found.light[k / bands].bands[k % bands].stokes.i;
  const auto more = draw(enough, beside, &store.surfaces());
  for (std::size_t k = 0; k < more.size(); ++k) {
    IndirectLight &to = found.light[enough[k]];
    to.rays += more[k].rays;
    for (std::size_t b = 0; b < bands; ++b)
      umov::add(more[k].bands[b], to.bands[b]);
  }
  return is_stopped(cancel) ? std::vector<IndirectLight>{} : std::move(found.light);
}

} // namespace

std::vector<IndirectLight> Integrator::indirect(std::span<const Pose> poses,
                                                std::span<const double> direct_i,
                                                const IntegrationOptions &options, unsigned threads,
                                                const std::atomic<bool> *cancel) const {
  return unless_stopped(cancel, [&]() -> std::vector<IndirectLight> {
    const std::size_t bands = state_->scene.grid.nodes().size();
    if (state_->is_convex || options.bounces < 2)
      return {poses.size(), IndirectLight{std::vector<BandResult>(bands), 0}};
    // The accuracy refers to the whole light, or to the floor.
    std::vector<double> refers_to(direct_i.begin(), direct_i.end());
    for (std::size_t at = 0; at < refers_to.size() && !options.floor_i.empty(); ++at)
      refers_to[at] = std::max(refers_to[at], options.floor_i[at % bands]);
    if (const ChainStore *store = state_->chains(options, cancel))
      return by_chains(*store, state_->paths(cancel), poses, refers_to, options, threads, cancel);
    return by_paths(state_->paths(cancel), poses, refers_to, options, threads, cancel, nullptr);
  });
}

std::vector<IndirectLight> Integrator::thermal(std::span<const Pose> poses,
                                               const ThermalEmission &emission,
                                               const IntegrationOptions &options, unsigned threads,
                                               const std::atomic<bool> *cancel) const {
  return unless_stopped(cancel, [&]() -> std::vector<IndirectLight> {
    const std::vector<double> nothing(poses.size() * state_->scene.grid.nodes().size());
    return by_paths(state_->paths(cancel), poses, nothing, options, threads, cancel, &emission);
  });
}

std::vector<Stokes<ScatteringPlane>>
Integrator::indirect_radiance(const Pose &pose, std::span<const SurfacePoint> points,
                              const IntegrationOptions &options, std::size_t paths,
                              std::uint64_t first, const std::atomic<bool> *cancel) const {
  const std::size_t bands = state_->scene.grid.nodes().size();
  std::vector<Stokes<ScatteringPlane>> out(points.size() * bands);
  if (state_->is_convex || options.bounces < 2 || points.empty())
    return out;
  const PathGround ground = state_->paths(cancel);
  PathSampler sampler(ground.scene, ground.occluder, pose, options, nullptr, nullptr, false);
  std::vector<Stokes<ScatteringPlane>> sum(bands);
  for (std::size_t k = 0; k < points.size() && !is_stopped(cancel); ++k) {
    std::fill(sum.begin(), sum.end(), Stokes<ScatteringPlane>{});
    for (std::size_t i = 0; i < paths; ++i)
      sampler.look(points[k], (first + k) * paths + i, sum);
    for (std::size_t b = 0; b < bands; ++b) {
      out[k * bands + b] = sum[b] * (1 / static_cast<double>(paths));
      if (!has_scattering_plane(pose))
        out[k * bands + b].q = out[k * bands + b].u = 0;
    }
  }
  return out;
}

PoseResult Integrator::evaluate(const Pose &pose, const IntegrationOptions &options) const {
  return std::move(evaluate(std::vector{pose}, options, 1).front());
}

std::vector<PoseResult> Integrator::evaluate(const std::vector<Pose> &poses,
                                             const IntegrationOptions &options, unsigned threads,
                                             const std::atomic<bool> *cancel) const {
  return unless_stopped(cancel, [&]() -> std::vector<PoseResult> {
    std::vector<PoseResult> out(poses.size());
    parallel_for(poses.size(), threads, [&](std::size_t i) {
      if (!is_stopped(cancel))
        out[i] = direct(poses[i], options, cancel); // which may take seconds
    });
    if (is_stopped(cancel))
      return {};
    if (options.bounces < 2)
      return out;
    std::vector<double> direct_i;
    for (const PoseResult &one : out)
      for (const BandResult &band : one.bands)
        direct_i.push_back(band.stokes.i);
    const auto more = indirect(poses, direct_i, options, threads, cancel);
    if (more.size() < out.size())
      return {};
    for (std::size_t i = 0; i < out.size(); ++i)
      add(more[i], out[i]);
    return out;
  });
}

} // namespace umov
