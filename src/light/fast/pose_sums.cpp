// What a pose sums up to: by kernels, and facet by facet where there is none.

#include "light/fast/state.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace umov {

const backend::MaskErrorModel &Engine::State::error_model() const {
  return may_mend() && options.doubts_all ? doubtful_error : mask_error;
}

/// What has no kernel is listed here, and lit as always.
void Engine::State::take_from_card(const Prepared &at, SumsStore &out) const {
  at.card_sums->read(at.row_of_card, out);
  if (on_cards->general.empty())
    return;
  backend::SceneData<float> rest = views.single;
  rest.chunks = on_cards->general;
  backend::sum_facets(rest, hiding(), error_model(), at.single, out);
}

void Engine::State::sum_facets(const Prepared &at, SumsStore &out) const {
  out.reset(views.whole);
  if (at.card_sums != nullptr)
    take_from_card(at, out);
  else if (options.is_double)
    backend::sum_facets(views.whole, hiding(), error_model(), at.pose, out);
  else
    backend::sum_facets(views.single, hiding(), error_model(), at.single, out);
  if (masks)
    add_alike(out);
}

bool Engine::State::add_up(const Pose &pose, const Prepared &at, Workspace &work,
                           bool has_colours) const {
  sum_facets(at, work.sums);
  work.is_mended = work.has_variances = work.is_coloured = false;
  if (!work.sums.is_any_seen && !doubts_darkness())
    return false;
  if (has_colours)
    compiled.colours.prepare(at.cos_phase, has_scattering_plane(pose), work.factors);
  if (compiled.general_classes > 0) {
    work.general.reset(bands(), true);
    work.general_i.assign(compiled.slots.size() * bands(), 0);
  }
  if (!work.sums.seen.empty())
    add_general(pose, at, work);
  take_roots(work);
  if (!options.is_double)
    add_rounding(work);
  return true;
}

bool Engine::State::sum(const Pose &pose, const Prepared &at, Workspace &work) const {
  if (!add_up(pose, at, work))
    return false;
  if (!may_mend())
    return true;
  colour(work);
  refer_to(work.light, compiled.area_m2, work);
  if (is_uncertain(work.light, compiled.area_m2, work))
    mend(pose, at, work);
  work.is_coloured = true;
  return true;
}

namespace {

/// By how often it has halved; a root for each lobe of each pose would cost.
const std::array<double, backend::halvings_most + 1> &flank_roots() {
  static const auto roots = [] {
    std::array<double, backend::halvings_most + 1> out{};
    for (std::size_t n = 0; n < out.size(); ++n)
      out[n] = backend::flank_root<double>(static_cast<int>(n));
    return out;
  }();
  return roots;
}

} // namespace

void Engine::State::add_rounding(Workspace &work) const {
  for (std::size_t lobe = 0; lobe < compiled.data.lobes.size(); ++lobe) {
    const backend::LobeRounding<double> &of = compiled.rounding[lobe];
    const double sum = work.sums.specular[lobe];
    const auto halved = static_cast<std::size_t>(backend::halvings(sum * of.per_peak));
    work.sums.specular_bias[lobe] += backend::rounding_of(sum, of, flank_roots()[halved]);
  }
}

void Engine::State::take_roots(Workspace &work, bool may_vary) const {
  work.varies = masks || !work.sums.seen.empty() || may_vary;
  const auto root = [&](std::span<const double> variance, std::vector<double> &out) {
    out.resize(variance.size());
    if (!work.varies)
      return;
    std::transform(variance.begin(), variance.end(), out.begin(),
                   [](double x) { return std::sqrt(x); });
  };
  root(work.sums.specular_variance, work.specular_deviation);
  root(work.sums.product_variance, work.product_deviation);
}

SurfaceDirections Engine::State::directions(const Pose &pose, const Prepared &at,
                                            const backend::SeenFacet &facet) const {
  const FacetClass &c = classes.list[plan.groups[facet.group].member[facet.lane]];
  const Element &e = elements.list[classes.element[c.first]];
  return directions_on(
      c.normal, direction_field(scene.mesh, compiled.colours.surface(facet.slot), e.triangle),
      pose.sun, pose.observer, at.cos_phase, pose.sun_radius_rad);
}

void Engine::State::light_of_general(const Pose &pose, const Prepared &at,
                                     const backend::SeenFacet &facet, const Workspace &work,
                                     Stokes<ScatteringPlane> *bands) const {
  const Stokes<ScatteringPlane> sunlight{1, 0, 0, 0};
  const Surface &surface = compiled.colours.surface(facet.slot);
  const std::size_t column = compiled.colours.column(facet.slot);
  const SurfaceDirections on = directions(pose, at, facet);
  for (std::size_t b = 0; b < this->bands(); ++b) {
    const double w = surface.specular(b, on);
    const double a = work.factors.a[column + b], q = work.factors.b[column + b];
    bands[b] = {a * w, q * w, 0, 0};
    if (surface.has_diffuse()) // unpolarized light asks for a and b only
      bands[b] += surface.diffuse(b, on, sunlight, MuellerEntries{a, q, {}}.matrix());
  }
}

void Engine::State::add_general(const Pose &pose, const Prepared &at, Workspace &work) const {
  work.facet_light.resize(bands());
  for (const backend::SeenFacet &seen : work.sums.seen) {
    light_of_general(pose, at, seen, work, work.facet_light.data());
    BandLight &to = work.general;
    for (std::size_t b = 0; b < bands(); ++b) {
      const auto &s = work.facet_light[b];
      to.i[b] += s.i * seen.area;
      work.general_i[seen.slot * bands() + b] += s.i * seen.area;
      to.q[b] += s.q * seen.area;
      to.u[b] += s.u * seen.area;
      to.v[b] += s.v * seen.area;
      to.var_i[b] += s.i * s.i * seen.variance;
      to.var_q[b] += s.q * s.q * seen.variance;
      to.var_u[b] += s.u * s.u * seen.variance;
      to.var_v[b] += s.v * s.v * seen.variance;
    }
  }
}

SlotSums Engine::State::sums_of(std::size_t slot, const Workspace &work) const {
  const backend::SlotTerms &terms = compiled.data.slots[slot];
  return {work.sums.specular.data() + terms.lobe_first,
          work.specular_deviation.data() + terms.lobe_first,
          work.sums.specular_bias.data() + terms.lobe_first,
          work.sums.product.data() + terms.product_first,
          work.product_deviation.data() + terms.product_first,
          work.varies};
}

void Engine::State::colour_by_material(std::span<const std::uint32_t> material, double *intensity,
                                       Workspace &work) const {
  work.light.reset(bands(), compiled.has_u);
  for (std::size_t slot = 0; slot < compiled.slots.size(); ++slot) {
    if (compiled.data.slots[slot].is_general)
      continue;
    const std::vector<double> before = work.light.i;
    compiled.colours.add_slot(slot, sums_of(slot, work), work.factors, work.light);
    for (std::size_t b = 0; b < bands(); ++b)
      intensity[material[slot] * bands() + b] += (work.light.i[b] - before[b]) * compiled.area_m2;
  }
  if (compiled.general_classes > 0)
    work.light.add(work.general);
  take_variances(work);
  for (std::size_t slot = 0; compiled.general_classes > 0 && slot < compiled.slots.size(); ++slot)
    for (std::size_t b = 0; b < bands(); ++b)
      intensity[material[slot] * bands() + b] +=
          work.general_i[slot * bands() + b] * compiled.area_m2;
}

void Engine::State::colour(Workspace &work) const {
  work.light.reset(bands(), compiled.has_u);
  for (std::size_t slot = 0; slot < compiled.slots.size(); ++slot)
    if (!compiled.data.slots[slot].is_general)
      compiled.colours.add_slot(slot, sums_of(slot, work), work.factors, work.light);
  if (compiled.general_classes > 0)
    work.light.add(work.general);
  take_variances(work);
}

namespace {

/// Taking away what rays find hidden leaves the rounding of what was there: light is no less than
/// none, and no more polarized than whole.
void make_physical(BandLight &light, bool has_u_or_v) {
  for (std::size_t b = 0; b < light.size(); ++b) {
    light.i[b] = std::max(light.i[b], 0.0);
    const double others = has_u_or_v ? std::hypot(light.u[b], light.v[b]) : 0;
    const double polarized = std::hypot(light.q[b], others);
    if (!(polarized > light.i[b]))
      continue;
    const double part = light.i[b] / polarized;
    light.q[b] *= part;
    if (has_u_or_v) {
      light.u[b] *= part;
      light.v[b] *= part;
    }
  }
}

} // namespace

/// Variances facet by facet in place of those of the sums.
void Engine::State::take_variances(Workspace &work) const {
  if (!work.has_variances)
    return;
  if (work.is_mended)
    make_physical(work.light, compiled.has_u || compiled.general_classes > 0);
  work.light.var_i = work.variances.var_i;
  work.light.var_q = work.variances.var_q;
  if (!compiled.has_u && compiled.general_classes == 0)
    return;
  work.light.var_u = work.variances.var_u;
  work.light.var_v = work.variances.var_v;
}

} // namespace umov
