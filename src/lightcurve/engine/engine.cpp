#include <umov/lightcurve/engine.h>

#include "lightcurve/engine/compile.h"
#include "lightcurve/engine/masks.h"
#include "lightcurve/engine/pose_data.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <optional>
#include <umov/core/parallel.h>
#include <umov/shape/topology.h>

namespace umov {
namespace {

constexpr double normal_95 = 1.959963984540054; ///< two-sided quantile of the normal law

/// Rounding of the sums, in parts of I: docs/theory/engine.md has the measured agreement.
constexpr double float_rounding = 2e-5, double_rounding = 1e-5;

/// Calibrated against dense runs (tests/engine_errors_test.cpp).
constexpr backend::MaskErrorModel mask_error{1.0F, 1.0F};

bool has_scattering_plane(const Pose &pose) {
  return !(pose.sun == pose.observer) && !(pose.sun == -pose.observer);
}

double cos_phase_of(const Pose &pose) {
  return std::clamp(dot(pose.sun, pose.observer), -1.0, 1.0);
}

/// Poses that one thread takes at a time.
constexpr std::size_t poses_per_task = 256;

} // namespace

void StokesTable::resize(std::size_t poses, std::size_t band_count) {
  bands = band_count;
  for (auto *column : {&i, &q, &u, &v, &i_err, &q_err, &u_err, &v_err})
    column->assign(poses * band_count, 0);
  is_dark.assign(poses, 1);
}

struct Engine::State {
  Scene scene;
  EngineOptions options;
  EngineFacts facts;
  Elements elements;
  FacetClasses classes;
  GroupPlan plan;
  CompiledScene compiled;
  backend::SceneData<float> single;
  std::optional<backend::Masks> masks;

  struct Light {
    Stokes<ScatteringPlane> stokes, deviation2; ///< and squared standard deviations
  };

  /// A pose made ready; the next one is while this one is summed.
  struct Prepared {
    double cos_phase = 1;
    backend::PoseData<double> pose;
    backend::PoseData<float> single;
  };
  /// What one thread needs besides.
  struct Workspace {
    std::array<Prepared, 2> prepared;
    backend::PoseSums sums;
    std::vector<double> a, b; ///< Fresnel factors by column
    std::vector<Light> bands;
  };

  [[nodiscard]] const backend::Masks *hiding() const { return masks ? &*masks : nullptr; }

  void prepare(const Pose &pose, Prepared &out) const {
    out.cos_phase = cos_phase_of(pose);
    prepare_pose(pose, out.cos_phase, compiled.data.lobes, compiled.widths, hiding(), out.pose);
    if (!options.is_double)
      round_pose(out.pose, out.single);
    if (masks)
      backend::prefetch(*masks, out.pose.narrow_sun, out.pose.narrow_observer, out.pose.wide_sun,
                        out.pose.wide_observer);
  }
  void sum(const Prepared &at, backend::PoseSums &sums) const {
    if (options.is_double)
      backend::sum_facets(compiled.data, hiding(), mask_error, at.pose, sums);
    else
      backend::sum_facets(single, hiding(), mask_error, at.single, sums);
  }

  /// Light of the slots that have kernels.
  [[nodiscard]] Light light_of_slot(std::size_t slot, std::size_t band, bool has_plane,
                                    const double *specular, const double *specular_variance,
                                    const double *product, const double *product_variance,
                                    const Workspace &work) const {
    const SlotLight &light = compiled.slots[slot];
    const backend::SlotTerms &terms = compiled.data.slots[slot];
    const double a = work.a[light.column + band];
    const double b = has_plane ? work.b[light.column + band] : 0;
    Light out;
    double deviation_i = 0, deviation_q = 0;
    if (terms.lobe_count > 0) {
      const std::size_t lobe = terms.lobe_first + (light.is_grey ? 0 : band);
      const double deviation = std::sqrt(specular_variance[lobe]);
      out.stokes.i = a * specular[lobe];
      out.stokes.q = b * specular[lobe];
      deviation_i = a * deviation;
      deviation_q = std::abs(b) * deviation;
    }
    for (std::size_t p = 0; p < terms.product_count; ++p) {
      const ProductLight &by = light.products[band][p];
      const double value = by.coefficient * product[terms.product_first + p];
      const double deviation =
          std::abs(by.coefficient) * std::sqrt(product_variance[terms.product_first + p]);
      const double q = by.is_single_bounce && a > 0 ? b / a : 0;
      out.stokes.i += value;
      out.stokes.q += q * value;
      deviation_i += deviation;
      deviation_q += std::abs(q) * deviation;
    }
    out.deviation2 = {deviation_i * deviation_i, deviation_q * deviation_q, 0, 0};
    return out;
  }

  void evaluate(const Pose &pose, const Prepared &at, std::size_t row, StokesTable &out,
                Workspace &work) const;
  void add_seen(const Pose &pose, double cos_phase, bool has_plane, const Workspace &work,
                std::vector<Light> &bands) const;
  void finish(const Pose &pose, bool has_u_or_v, std::size_t row, const std::vector<Light> &bands,
              StokesTable &out) const;
};

/// Facets whose surface has no kernel at this pose, by the surface itself.
void Engine::State::add_seen(const Pose &pose, double cos_phase, bool has_plane,
                             const Workspace &work, std::vector<Light> &bands) const {
  const Stokes<ScatteringPlane> sunlight{1, 0, 0, 0};
  for (const backend::SeenFacet &seen : work.sums.seen) {
    const SlotLight &light = compiled.slots[seen.slot];
    const Surface &surface = *light.surface;
    const FacetClass &c = classes.list[plan.groups[seen.group].member[seen.lane]];
    const Element &e = elements.list[classes.element[c.first]];
    const SurfaceDirections at =
        directions_on(c.normal, direction_field(scene.mesh, surface, e.triangle), pose.sun,
                      pose.observer, cos_phase, pose.sun_radius_rad);
    const bool is_general = compiled.data.slots[seen.slot].is_general;
    for (std::size_t b = 0; b < bands.size(); ++b) {
      const double w = surface.specular(b, at);
      Stokes<ScatteringPlane> s{work.a[light.column + b] * w,
                                has_plane ? work.b[light.column + b] * w : 0, 0, 0};
      if (is_general && surface.has_diffuse())
        s += surface.diffuse(b, at, sunlight);
      bands[b].stokes += s * seen.area;
      bands[b].deviation2 += Stokes<ScatteringPlane>{s.i * s.i, s.q * s.q, s.u * s.u, s.v * s.v} *
                             seen.variance;
    }
  }
}

void Engine::State::finish(const Pose &pose, bool has_u_or_v, std::size_t row,
                           const std::vector<Light> &bands, StokesTable &out) const {
  const double rounding = options.is_double ? double_rounding : float_rounding;
  const bool has_plane = has_scattering_plane(pose);
  for (std::size_t b = 0; b < bands.size(); ++b) {
    const std::size_t at = row * bands.size() + b;
    const auto &s = bands[b].stokes;
    const auto &d = bands[b].deviation2;
    const double k = compiled.area_m2, floor = rounding * std::abs(s.i) * k;
    const auto half_width = [&](double variance) {
      return normal_95 * std::sqrt(std::max(variance, 0.0)) * k + floor;
    };
    out.i[at] = s.i * k;
    out.q[at] = has_plane ? s.q * k : 0;
    out.u[at] = has_plane ? s.u * k : 0;
    out.v[at] = s.v * k;
    out.i_err[at] = half_width(d.i);
    out.q_err[at] = half_width(d.q);
    out.u_err[at] = has_u_or_v ? half_width(d.u) : 0;
    out.v_err[at] = has_u_or_v ? half_width(d.v) : 0;
  }
}

void Engine::State::evaluate(const Pose &pose, const Prepared &ready, std::size_t row,
                             StokesTable &out, Workspace &work) const {
  const double cos_phase = ready.cos_phase;
  const bool has_plane = has_scattering_plane(pose);
  sum(ready, work.sums);
  out.is_dark[row] = work.sums.is_any_seen ? 0 : 1;
  if (!work.sums.is_any_seen)
    return;
  compiled.fresnel.at(cos_phase, work.a.data(), work.b.data());
  std::vector<Light> &bands = work.bands;
  bands.assign(scene.bands.size(), {});
  for (std::size_t slot = 0; slot < compiled.slots.size(); ++slot)
    for (std::size_t b = 0; b < bands.size(); ++b) {
      const Light light = light_of_slot(
          slot, b, has_plane, work.sums.specular.data(), work.sums.specular_variance.data(),
          work.sums.product.data(), work.sums.product_variance.data(), work);
      bands[b].stokes += light.stokes;
      bands[b].deviation2 += light.deviation2;
    }
  if (!work.sums.seen.empty())
    add_seen(pose, cos_phase, has_plane, work, bands);
  finish(pose, compiled.general_classes > 0, row, bands, out);
}

Engine::Engine(const Scene &scene, const EngineOptions &options)
    : state_(std::make_unique<State>()) {
  const auto start = std::chrono::steady_clock::now();
  State &s = *state_;
  s.scene = scene;
  s.options = options;
  s.facts.is_convex = is_proven_convex(scene.mesh);
  const bool has_masks = options.visibility == Visibility::Masks && !s.facts.is_convex;
  s.elements = make_elements(s.scene, visible_sides(scene.mesh));
  s.classes = join_facets(s.elements, options.cluster_rad);
  s.plan = plan_groups(s.classes, has_masks ? std::max<std::size_t>(options.masks.points, 1) : 0);
  s.compiled = compile_scene(s.scene, s.classes, s.plan, options.cluster_rad);
  s.single = round_scene(s.compiled.data);
  if (has_masks) {
    const Occluder occluder(scene.mesh);
    const auto even = [](std::size_t cells) { return std::max<std::size_t>(cells / 2 * 2, 2); };
    s.masks = build_masks(s.scene, s.elements, s.classes, s.plan, occluder,
                          {even(options.masks.narrow_cells), even(options.masks.wide_cells)},
                          options.threads);
    s.facts.mask_bytes = memory_of(*s.masks);
  }
  s.facts.triangles = scene.mesh.triangles.size();
  s.facts.classes = s.classes.list.size();
  s.facts.groups = s.plan.groups.size();
  s.facts.general_classes = s.compiled.general_classes;
  s.facts.scene_bytes =
      s.compiled.data.groups.size() *
      (sizeof(backend::FacetGroup<double>) + sizeof(backend::FacetGroup<float>));
  s.facts.setup_s =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}
Engine::~Engine() = default;
Engine::Engine(Engine &&) noexcept = default;
Engine &Engine::operator=(Engine &&) noexcept = default;

const EngineFacts &Engine::facts() const { return state_->facts; }
std::size_t Engine::band_count() const { return state_->scene.bands.size(); }

void Engine::evaluate(std::span<const Pose> poses, StokesTable &out, unsigned threads) const {
  out.resize(poses.size(), band_count());
  const std::size_t tasks = (poses.size() + poses_per_task - 1) / poses_per_task;
  parallel_for(tasks, threads, [&](std::size_t task) {
    State::Workspace work;
    work.a.resize(state_->compiled.fresnel.columns());
    work.b.resize(state_->compiled.fresnel.columns());
    const std::size_t end = std::min(poses.size(), (task + 1) * poses_per_task);
    const std::size_t begin = task * poses_per_task;
    state_->prepare(poses[begin], work.prepared[0]);
    for (std::size_t i = begin; i < end; ++i) {
      if (i + 1 < end)
        state_->prepare(poses[i + 1], work.prepared[(i + 1 - begin) % 2]);
      state_->evaluate(poses[i], work.prepared[(i - begin) % 2], i, out, work);
    }
  });
}

} // namespace umov
