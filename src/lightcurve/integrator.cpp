#include <umov/lightcurve/integrator.h>

#include "lightcurve/bounces/bounces.h"
#include "lightcurve/visibility.h"

#include <cmath>
#include <limits>
#include <optional>
#include <umov/core/parallel.h>
#include <umov/shape/topology.h>

namespace umov {
namespace {

/// Rounding of a sum of positive terms, in parts of the sum: some units in the last place.
constexpr double rounding = 16 * std::numeric_limits<double>::epsilon();

} // namespace

struct Integrator::State {
  Scene scene;
  bool is_convex = false;
  Elements elements;
  std::optional<Occluder> occluder; ///< none for a convex mesh
  std::optional<BounceScene> bounces;
};

Integrator::Integrator(const Scene &scene) : state_(std::make_unique<State>()) {
  state_->scene = scene;
  state_->is_convex = is_proven_convex(scene.mesh);
  state_->elements = make_elements(scene, visible_sides(scene.mesh));
  if (!state_->is_convex) {
    state_->occluder.emplace(scene.mesh);
    state_->bounces.emplace(state_->scene);
  }
}
Integrator::~Integrator() = default;
Integrator::Integrator(Integrator &&) noexcept = default;
Integrator &Integrator::operator=(Integrator &&) noexcept = default;

bool Integrator::is_convex() const { return state_->is_convex; }

void Integrator::add_indirect(const State &state, const Pose &pose,
                              const IntegrationOptions &options, PoseResult &out) {
  out.indirect.assign(out.bands.size(), {});
  if (!state.bounces)
    return;
  std::vector<double> direct;
  for (const BandResult &band : out.bands)
    direct.push_back(band.stokes.i);
  const IndirectLight light = state.bounces->light(*state.occluder, pose, options, direct);
  out.rays += light.rays;
  const auto quadrature = [](double &a, double b) { a = std::hypot(a, b); };
  for (std::size_t b = 0; b < out.bands.size(); ++b) {
    const BandResult &more = light.bands[b];
    out.indirect[b] = more.stokes;
    out.bands[b].stokes += more.stokes;
    quadrature(out.bands[b].half_width.i, more.half_width.i);
    quadrature(out.bands[b].half_width.q, more.half_width.q);
    quadrature(out.bands[b].half_width.u, more.half_width.u);
    quadrature(out.bands[b].half_width.v, more.half_width.v);
    out.is_dark = out.is_dark && !(more.stokes.i > 0);
  }
}

PoseResult Integrator::evaluate(const Pose &pose, const IntegrationOptions &options) const {
  const Scene &scene = state_->scene;
  const std::size_t bands = scene.bands.size(), groups = scene.mesh.groups.size();
  const PoseGeometry geometry = geometry_of(pose);
  const LitElements lit = light_elements(scene, state_->elements, geometry, options.source);
  const VisibleSums sums =
      state_->is_convex
          ? sum_unhidden(scene, lit)
          : sum_visible(scene, state_->elements, *state_->occluder, geometry, lit, options);
  PoseResult out;
  out.rays = sums.rays;
  out.is_dark = !sums.is_any_seen;
  out.bands.resize(bands);
  out.group_intensity.assign(groups * bands, 0);
  for (std::size_t b = 0; b < bands; ++b) {
    BandResult &band = out.bands[b];
    for (std::size_t slot = 0; slot < 2 * groups; ++slot) {
      const Stokes<ScatteringPlane> light =
          lit.fresnel[slot * bands + b] * sums.specular[slot * lit.lobes + lit.lobe_of(b)] +
          sums.diffuse[slot * bands + b];
      band.stokes += light;
      out.group_intensity[group_of_slot(static_cast<std::uint32_t>(slot)) * bands + b] += light.i;
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
  if (options.bounces > 1)
    add_indirect(*state_, pose, options, out);
  if (bands > 0 && out.bands[0].stokes.i > 0)
    out.glint_share = sums.glint / out.bands[0].stokes.i;
  return out;
}

std::vector<PoseResult> Integrator::evaluate(const std::vector<Pose> &poses,
                                             const IntegrationOptions &options,
                                             unsigned threads) const {
  std::vector<PoseResult> out(poses.size());
  parallel_for(poses.size(), threads, [&](std::size_t i) { out[i] = evaluate(poses[i], options); });
  return out;
}

} // namespace umov
