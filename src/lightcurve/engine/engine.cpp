#include <umov/lightcurve/engine.h>

#include "lightcurve/engine/compile.h"
#include "lightcurve/engine/masks.h"
#include "lightcurve/engine/pose_data.h"
#include "lightcurve/engine/pose_order.h"
#include "lightcurve/engine/refine.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <numeric>
#include <optional>
#include <umov/core/parallel.h>
#include <umov/shape/topology.h>

namespace umov {
namespace {

constexpr double normal_95 = 1.959963984540054; ///< two-sided quantile of the normal law

/// Rounding of the sums, in parts of I: docs/theory/engine.md has the measured agreement.
constexpr double rounding = 2e-6;

/// Calibrated against dense runs (tests/engine_errors_test.cpp).
constexpr backend::MaskErrorModel mask_error{1.5F, 0.25F};

bool has_scattering_plane(const Pose &pose) {
  return !(pose.sun == pose.observer) && !(pose.sun == -pose.observer);
}

double cos_phase_of(const Pose &pose) {
  return std::clamp(dot(pose.sun, pose.observer), -1.0, 1.0);
}

/// Poses that one thread takes at a time.
constexpr std::size_t poses_per_task_min = 64, poses_per_task_max = 16'384;

} // namespace

void StokesTable::resize(std::size_t poses, std::size_t band_count) {
  bands = band_count;
  for (auto *column : {&i, &q, &u, &v, &i_err, &q_err, &u_err, &v_err})
    column->assign(poses * band_count, 0);
  is_dark.assign(poses, 1);
}

BandResult StokesTable::at(std::size_t pose, std::size_t band) const {
  const std::size_t k = pose * bands + band;
  return {{i[k], q[k], u[k], v[k]}, {i_err[k], q_err[k], u_err[k], v_err[k]}};
}

MaskQuality masks_for(double accuracy) {
  MaskQuality out = accuracy >= 0.004 ? fast_masks : fine_masks;
  out.refine_above = std::max(20 * accuracy, 0.01);
  return out;
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
  std::optional<Occluder> occluder;
  RefinePoints refine_points;

  struct Light {
    Stokes<ScatteringPlane> stokes, deviation2; ///< and squared standard deviations
    double bias = 0;                            ///< bound of what the polynomials miss, in I
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
    std::vector<Light> slots; ///< [slot * bands + band]
    std::vector<backend::SeenFacet> uncertain;
    std::vector<double> weights;
    std::vector<Light> facet_light; ///< [uncertain facet * bands + band], per unit area
    std::vector<std::uint32_t> order;
    std::optional<RefineTracer> tracer;
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

  /// Sums of one slot: its lobes and products, and their standard deviations.
  struct SlotSums {
    const double *specular, *specular_deviation, *specular_bias, *product, *product_deviation;
  };
  /// Light of a slot that has kernels.
  [[nodiscard]] Light light_of_slot(std::size_t slot, std::size_t band, bool has_plane,
                                    const SlotSums &sums, const Workspace &work) const {
    const SlotLight &light = compiled.slots[slot];
    const backend::SlotTerms &terms = compiled.data.slots[slot];
    const double a = work.a[light.column + band];
    const double b = has_plane ? work.b[light.column + band] : 0;
    Light out;
    double deviation_i = 0, deviation_q = 0;
    if (terms.lobe_count > 0) {
      const std::size_t lobe = light.is_grey ? 0 : band;
      const double deviation = sums.specular_deviation[lobe];
      out.stokes.i = a * sums.specular[lobe];
      out.stokes.q = b * sums.specular[lobe];
      out.bias += a * sums.specular_bias[lobe];
      deviation_i = a * deviation;
      deviation_q = std::abs(b) * deviation;
    }
    for (std::size_t p = 0; p < terms.product_count; ++p) {
      const ProductLight &by = light.products[band][p];
      const double value = by.coefficient * sums.product[p];
      const double deviation = std::abs(by.coefficient) * sums.product_deviation[p];
      const double q = by.is_single_bounce && a > 0 ? b / a : 0;
      out.stokes.i += value;
      out.stokes.q += q * value;
      out.bias += light.diffuse_error * value;
      deviation_i += deviation;
      deviation_q += std::abs(q) * deviation;
    }
    out.deviation2 = {deviation_i * deviation_i, deviation_q * deviation_q, 0, 0};
    return out;
  }

  void evaluate(const Pose &pose, const Prepared &at, std::size_t row, StokesTable &out,
                Workspace &work) const;
  void add_seen(const Pose &pose, const Prepared &ready, Workspace &work) const;
  void light_of_surface(const Pose &pose, const Prepared &ready, const backend::SeenFacet &seen,
                        bool has_diffuse, const Workspace &work, Light *bands) const;
  void light_of_facet(const Pose &pose, const Prepared &ready, const backend::SeenFacet &facet,
                      Workspace &work, Light *bands) const;
  void refine(const Pose &pose, const Prepared &ready, Workspace &work) const;
  [[nodiscard]] bool is_uncertain(const Workspace &work) const;
  void finish(const Pose &pose, bool has_u_or_v, std::size_t row, const std::vector<Light> &bands,
              StokesTable &out) const;
};

/// Light of one facet per unit area by its surface: for what has no kernel at this pose.
void Engine::State::light_of_surface(const Pose &pose, const Prepared &ready,
                                     const backend::SeenFacet &seen, bool has_diffuse,
                                     const Workspace &work, Light *bands) const {
  const Stokes<ScatteringPlane> sunlight{1, 0, 0, 0};
  const bool has_plane = has_scattering_plane(pose);
  const SlotLight &light = compiled.slots[seen.slot];
  const Surface &surface = *light.surface;
  const FacetClass &c = classes.list[plan.groups[seen.group].member[seen.lane]];
  const Element &e = elements.list[classes.element[c.first]];
  const SurfaceDirections at =
      directions_on(c.normal, direction_field(scene.mesh, surface, e.triangle), pose.sun,
                    pose.observer, ready.cos_phase, pose.sun_radius_rad);
  for (std::size_t b = 0; b < scene.bands.size(); ++b) {
    const double w = surface.specular(b, at);
    bands[b].stokes = {work.a[light.column + b] * w, has_plane ? work.b[light.column + b] * w : 0,
                       0, 0};
    if (has_diffuse && surface.has_diffuse())
      bands[b].stokes += surface.diffuse(b, at, sunlight);
  }
}

/// Light of one facet per unit area, all of it.
void Engine::State::light_of_facet(const Pose &pose, const Prepared &ready,
                                   const backend::SeenFacet &facet, Workspace &work,
                                   Light *bands) const {
  const backend::SlotTerms &terms = compiled.data.slots[facet.slot];
  bool is_narrow = false;
  for (std::size_t k = 0; k < terms.lobe_count; ++k)
    is_narrow = is_narrow || ready.pose.is_narrow[terms.lobe_first + k] != 0;
  if (terms.is_general || is_narrow) {
    light_of_surface(pose, ready, facet, true, work, bands);
    return;
  }
  work.weights.assign(terms.lobe_count + terms.product_count, 0);
  backend::weigh_facet(compiled.data, ready.pose, facet, work.weights.data());
  const std::vector<double> none(work.weights.size(), 0);
  for (std::size_t b = 0; b < scene.bands.size(); ++b)
    bands[b] = light_of_slot(facet.slot, b, has_scattering_plane(pose),
                             {work.weights.data(), none.data(), none.data(),
                              work.weights.data() + terms.lobe_count, none.data()},
                             work);
}

/// Facets whose surface has no kernel at this pose.
void Engine::State::add_seen(const Pose &pose, const Prepared &ready, Workspace &work) const {
  work.facet_light.resize(work.bands.size());
  for (const backend::SeenFacet &seen : work.sums.seen) {
    light_of_surface(pose, ready, seen, compiled.data.slots[seen.slot].is_general, work,
                     work.facet_light.data());
    for (std::size_t b = 0; b < work.bands.size(); ++b) {
      const auto &s = work.facet_light[b].stokes;
      work.bands[b].stokes += s * seen.area;
      work.bands[b].deviation2 +=
          Stokes<ScatteringPlane>{s.i * s.i, s.q * s.q, s.u * s.u, s.v * s.v} * seen.variance;
    }
  }
}

/// Part of the accuracy asked of I that is asked of Q/I.
constexpr double polarization_part = 0.06;

/// Some band misses the accuracy from which on rays are traced, in I or in Q/I. What a slot lacks
/// of its light changes Q/I by how far its own is from that of the whole.
bool Engine::State::is_uncertain(const Workspace &work) const {
  const double most = options.masks.refine_above / normal_95;
  const std::size_t bands = work.bands.size();
  for (std::size_t b = 0; b < bands; ++b) {
    const Light &all = work.bands[b];
    const double allowed = most * all.stokes.i, allowed_q = polarization_part * allowed;
    if (all.deviation2.i > allowed * allowed)
      return true;
    double variance = 0;
    for (std::size_t slot = 0; slot < compiled.slots.size(); ++slot) {
      const Light &part = work.slots[slot * bands + b];
      if (!(part.deviation2.i > 0))
        continue;
      const double apart = part.stokes.q * all.stokes.i - all.stokes.q * part.stokes.i;
      const double scale = part.stokes.i * all.stokes.i;
      variance += scale > 0 ? part.deviation2.i * (apart / scale) * (apart / scale) : 0;
    }
    if (variance > allowed_q * allowed_q)
      return true;
  }
  return false;
}

/// Points that bring the error of a class down to a third of what may be left, if its whole light
/// is `weight` times that: sampling leaves 0.6 n^-3/4 at worst.
std::size_t points_for(double weight) {
  constexpr double fewest = 32, most = 4096;
  return static_cast<std::size_t>(std::clamp(std::pow(3 * 0.6 * weight, 4.0 / 3), fewest, most));
}

/// Replaces the shares of the classes that make the error by traced ones, the worst first, until
/// the rest is well below what is allowed.
void Engine::State::refine(const Pose &pose, const Prepared &ready, Workspace &work) const {
  if (options.is_double)
    backend::list_uncertain(compiled.data, hiding(), mask_error, ready.pose, work.uncertain);
  else
    backend::list_uncertain(single, hiding(), mask_error, ready.single, work.uncertain);
  const std::size_t bands = work.bands.size();
  work.facet_light.assign(work.uncertain.size() * bands, {});
  std::vector<double> importance(work.uncertain.size(), 0);
  std::vector<double> left(bands, 0), left_q(bands, 0); ///< variances of I and of Q at constant Q/I
  // What an area error does to Q/I, times I.
  const auto polarized = [&](std::size_t k, std::size_t b) {
    const auto &s = work.facet_light[k * bands + b].stokes, &all = work.bands[b].stokes;
    return all.i > 0 ? s.q - s.i * all.q / all.i : 0;
  };
  for (std::size_t k = 0; k < work.uncertain.size(); ++k) {
    const backend::SeenFacet &facet = work.uncertain[k];
    light_of_facet(pose, ready, facet, work, &work.facet_light[k * bands]);
    for (std::size_t b = 0; b < bands; ++b) {
      const double i = work.facet_light[k * bands + b].stokes.i;
      const double q = polarized(k, b) / polarization_part;
      left[b] += i * i * facet.variance;
      left_q[b] += q * q * facet.variance;
      const double total = work.bands[b].stokes.i;
      importance[k] += total > 0 ? (i * i + q * q) * facet.variance / (total * total) : 0;
    }
  }
  work.order.resize(work.uncertain.size());
  std::iota(work.order.begin(), work.order.end(), 0u);
  std::sort(work.order.begin(), work.order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return std::pair(-importance[a], a) < std::pair(-importance[b], b);
  });
  const double wanted = 0.7 * options.masks.refine_above / normal_95;
  for (const std::uint32_t k : work.order) {
    bool is_enough = true;
    for (std::size_t b = 0; b < bands; ++b) {
      const double allowed = wanted * work.bands[b].stokes.i;
      is_enough = is_enough && std::max(left[b], left_q[b]) <= allowed * allowed;
    }
    if (is_enough)
      break;
    backend::SeenFacet &facet = work.uncertain[k];
    const double whole = compiled.data.groups[facet.group].area[facet.lane];
    double weight = 0; // of the class's whole light against what may be left
    for (std::size_t b = 0; b < bands; ++b)
      weight = std::max(weight, std::max(work.facet_light[k * bands + b].stokes.i,
                                         std::abs(polarized(k, b)) / polarization_part) *
                                    whole / (wanted * std::max(work.bands[b].stokes.i, 1e-300)));
    const TracedShare traced =
        work.tracer->trace(refine_points.of(facet.group, facet.lane), points_for(weight), pose);
    const double area = whole * traced.share;
    const double n = static_cast<double>(traced.points);
    // One pseudo-disagreement stands for slivers that no point has found.
    const double share = std::clamp(traced.share, 0.5 / n, 1 - 0.5 / n);
    const double variance = whole * whole * static_cast<double>(mask_error.points) * share *
                            (1 - share) / (n * std::sqrt(n));
    for (std::size_t b = 0; b < bands; ++b) {
      const Light &light = work.facet_light[k * bands + b];
      const double q = polarized(k, b) / polarization_part;
      left[b] -= light.stokes.i * light.stokes.i * facet.variance;
      left_q[b] -= q * q * facet.variance;
      work.bands[b].stokes += light.stokes * (area - facet.area);
    }
    facet.area = area;
    facet.variance = variance;
  }
  for (std::size_t b = 0; b < bands; ++b) {
    work.bands[b].deviation2 = {};
    for (std::size_t k = 0; k < work.uncertain.size(); ++k) {
      const auto &s = work.facet_light[k * bands + b].stokes;
      work.bands[b].deviation2 +=
          Stokes<ScatteringPlane>{s.i * s.i, s.q * s.q, s.u * s.u, s.v * s.v} *
          work.uncertain[k].variance;
    }
  }
}

void Engine::State::finish(const Pose &pose, bool has_u_or_v, std::size_t row,
                           const std::vector<Light> &bands, StokesTable &out) const {
  const bool has_plane = has_scattering_plane(pose);
  for (std::size_t b = 0; b < bands.size(); ++b) {
    const std::size_t at = row * bands.size() + b;
    const auto &s = bands[b].stokes;
    const auto &d = bands[b].deviation2;
    const double k = compiled.area_m2;
    const double floor = (rounding * std::abs(s.i) + bands[b].bias) * k;
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
  backend::PoseSums &sums = work.sums;
  for (auto *variances : {&sums.specular_variance, &sums.product_variance})
    for (double &variance : *variances) // now standard deviations, once for all bands
      variance = std::sqrt(variance);
  work.slots.resize(compiled.slots.size() * bands.size());
  for (std::size_t slot = 0; slot < compiled.slots.size(); ++slot) {
    const backend::SlotTerms &terms = compiled.data.slots[slot];
    const SlotSums of_slot{
        sums.specular.data() + terms.lobe_first, sums.specular_variance.data() + terms.lobe_first,
        sums.specular_bias.data() + terms.lobe_first, sums.product.data() + terms.product_first,
        sums.product_variance.data() + terms.product_first};
    for (std::size_t b = 0; b < bands.size(); ++b) {
      const Light &light = work.slots[slot * bands.size() + b] =
          light_of_slot(slot, b, has_plane, of_slot, work);
      bands[b].stokes += light.stokes;
      bands[b].deviation2 += light.deviation2;
      bands[b].bias += light.bias;
    }
  }
  if (!work.sums.seen.empty())
    add_seen(pose, ready, work);
  if (masks && options.masks.refine_above > 0 && is_uncertain(work))
    refine(pose, ready, work);
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
    s.occluder.emplace(scene.mesh);
    const auto even = [](std::size_t cells) { return std::max<std::size_t>(cells / 2 * 2, 2); };
    s.masks = build_masks(s.scene, s.elements, s.classes, s.plan, *s.occluder,
                          {even(options.masks.narrow_cells), even(options.masks.wide_cells)},
                          options.threads);
    if (options.masks.refine_above > 0)
      s.refine_points =
          RefinePoints(s.scene, s.elements, s.classes, s.plan, *s.occluder, options.threads);
    s.facts.mask_bytes = memory_of(*s.masks) + s.refine_points.bytes();
  }
  s.facts.triangles = scene.mesh.triangles.size();
  s.facts.classes = s.classes.list.size();
  s.facts.groups = s.plan.groups.size();
  s.facts.general_classes = s.compiled.general_classes;
  s.facts.scene_bytes = s.compiled.data.groups.size() *
                        (sizeof(backend::FacetGroup<double>) + sizeof(backend::FacetGroup<float>));
  s.facts.setup_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}
Engine::~Engine() = default;
Engine::Engine(Engine &&) noexcept = default;
Engine &Engine::operator=(Engine &&) noexcept = default;

const EngineFacts &Engine::facts() const { return state_->facts; }
std::size_t Engine::band_count() const { return state_->scene.bands.size(); }

void Engine::evaluate(std::span<const Pose> poses, StokesTable &out, unsigned threads) const {
  out.resize(poses.size(), band_count());
  std::vector<std::uint32_t> order(poses.size());
  if (const backend::Masks *masks = state_->hiding(); masks) {
    const std::size_t directions = masks->narrow.directions();
    order = order_for_masks(poses, directions, state_->facts.mask_bytes / directions);
  } else {
    std::iota(order.begin(), order.end(), 0u);
  }
  const std::size_t size = std::clamp(poses.size() / (4 * resolve_threads(threads)) + 1,
                                      poses_per_task_min, poses_per_task_max);
  parallel_for((poses.size() + size - 1) / size, threads, [&](std::size_t task) {
    State::Workspace work;
    work.a.resize(state_->compiled.fresnel.columns());
    work.b.resize(state_->compiled.fresnel.columns());
    if (state_->occluder)
      work.tracer.emplace(*state_->occluder);
    const std::size_t begin = task * size, end = std::min(poses.size(), begin + size);
    state_->prepare(poses[order[begin]], work.prepared[0]);
    for (std::size_t k = begin; k < end; ++k) {
      if (k + 1 < end)
        state_->prepare(poses[order[k + 1]], work.prepared[(k + 1 - begin) % 2]);
      state_->evaluate(poses[order[k]], work.prepared[(k - begin) % 2], order[k], out, work);
    }
  });
}

const char *engine_instruction_set() { return backend::instruction_set_name(); }

bool restrict_engine(std::string_view instruction_set) {
  using backend::InstructionSet;
  constexpr std::pair<std::string_view, InstructionSet> names[] = {
      {"best", InstructionSet::Best},
      {"avx512", InstructionSet::Avx512},
      {"avx2", InstructionSet::Avx2},
      {"sse4", InstructionSet::Sse4},
      {"baseline", InstructionSet::Baseline}};
  for (const auto &[name, set] : names)
    if (name == instruction_set)
      return backend::choose_instruction_set(set);
  return false;
}

} // namespace umov
