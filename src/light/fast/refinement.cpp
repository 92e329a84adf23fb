// Poses whose masks are uncertain: rays for the classes that make the error.

#include "light/fast/state.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace umov {
namespace {

/// Part of the accuracy asked of I that is asked of Q/I.
constexpr double polarization_part = 0.06;

/// Points that bring the error of a class down to a third of what may be left, if its whole light
/// is `weight` times that: sampling leaves 0.6 n^-3/4 at worst.
std::size_t points_for(double weight) {
  constexpr double fewest = 32, most = 4096;
  return static_cast<std::size_t>(std::clamp(std::pow(3 * 0.6 * weight, 4.0 / 3), fewest, most));
}

/// What an area error of a facet does to Q/I, times I and in units of what is allowed of I.
double polarized(const Stokes<ScatteringPlane> &facet, const BandLight &all, std::size_t b) {
  return all.i[b] > 0 ? (facet.q - facet.i * all.q[b] / all.i[b]) / polarization_part : 0;
}

} // namespace

/// Some band misses the accuracy from which on rays are traced, in I or in Q/I. What a slot lacks
/// of its light changes Q/I by how far its own is from that of the whole.
bool Engine::State::is_uncertain(Workspace &work) const {
  colour(work);
  const double most = options.masks.refine_above / normal_95;
  const BandLight &all = work.light;
  for (std::size_t b = 0; b < bands(); ++b)
    if (all.var_i[b] > most * most * all.i[b] * all.i[b])
      return true;
  std::vector<double> &variance = work.band_room;
  variance.assign(bands(), 0);
  for (std::size_t slot = 0; slot < compiled.slots.size(); ++slot) {
    if (compiled.data.slots[slot].is_general)
      continue;
    work.part.reset(bands());
    compiled.colours.add_slot(slot, sums_of(slot, work), work.factors, work.part);
    for (std::size_t b = 0; b < bands(); ++b) {
      const double scale = work.part.i[b] * all.i[b];
      const double apart = work.part.q[b] * all.i[b] - all.q[b] * work.part.i[b];
      if (scale > 0)
        variance[b] += work.part.var_i[b] * (apart / scale) * (apart / scale);
    }
  }
  bool is_any = false;
  for (std::size_t b = 0; b < bands(); ++b) {
    const double allowed = polarization_part * most * all.i[b];
    is_any = is_any || variance[b] > allowed * allowed;
  }
  return is_any;
}

/// The light of one uncertain facet per unit area, and its weights in the sums.
void Engine::State::weigh(const Pose &pose, const Prepared &at, std::size_t k,
                          Workspace &work) const {
  const backend::SeenFacet &facet = work.uncertain[k];
  const backend::SlotTerms &terms = compiled.data.slots[facet.slot];
  Stokes<ScatteringPlane> *light = work.facet_light.data() + k * bands();
  if (terms.is_general)
    return light_of_general(pose, at, facet, work, light);
  double *weight = work.weights.data() + k * terms_max();
  backend::weigh_facet(views.whole, at.pose, facet, weight);
  for (std::size_t l = 0; l < terms.lobe_count; ++l)
    if (at.pose.is_narrow[terms.lobe_first + l])
      weight[l] = narrow_weight(terms.lobe_first + l, directions(pose, at, facet));
  const double *none = work.nothing.data();
  work.part.reset(bands());
  compiled.colours.add_slot(facet.slot,
                            {weight, none, none, weight + terms.lobe_count, none, false},
                            work.factors, work.part);
  for (std::size_t b = 0; b < bands(); ++b)
    light[b] = {work.part.i[b], work.part.q[b], 0, 0};
}

void Engine::State::list_uncertain(const Pose &pose, const Prepared &at, Workspace &work) const {
  work.uncertain.reset(views.whole.groups.size() * backend::lanes);
  if (options.is_double)
    backend::list_uncertain(views.whole, hiding(), mask_error, at.pose, work.uncertain);
  else
    backend::list_uncertain(views.single, hiding(), mask_error, at.single, work.uncertain);
  work.nothing.assign(terms_max(), 0);
  work.facet_light.assign(work.uncertain.size() * bands(), {});
  work.weights.assign(work.uncertain.size() * terms_max(), 0);
  for (std::size_t k = 0; k < work.uncertain.size(); ++k)
    weigh(pose, at, k, work);
}

/// What is left of the error: variances of I and of Q at constant Q/I, and deviations of I added
/// up, per band.
struct Engine::State::Left {
  std::vector<double> i, q, linear;
  explicit Left(std::size_t bands) : i(bands, 0), q(bands, 0), linear(bands, 0) {}
  void add(const Workspace &work, std::size_t k, double sign) {
    const double variance = work.uncertain[k].variance;
    for (std::size_t b = 0; b < i.size(); ++b) {
      const auto &light = work.facet_light[k * i.size() + b];
      i[b] += sign * light.i * light.i * variance;
      q[b] += sign * std::pow(polarized(light, work.light, b), 2) * variance;
      linear[b] += sign * light.i * std::sqrt(variance);
    }
  }
  [[nodiscard]] bool is_enough(const BandLight &all, double wanted) const {
    for (std::size_t b = 0; b < i.size(); ++b) {
      const double allowed = wanted * all.i[b];
      const double common = mask_alike * linear[b] * linear[b];
      if (std::max(i[b] + common, q[b]) > allowed * allowed)
        return false;
    }
    return true;
  }
};

/// Uncertain facets, those that make most of the error first.
void Engine::State::order_by_error(Workspace &work) const {
  std::vector<double> importance(work.uncertain.size(), 0);
  for (std::size_t k = 0; k < work.uncertain.size(); ++k)
    for (std::size_t b = 0; b < bands(); ++b) {
      const auto &light = work.facet_light[k * bands() + b];
      const double q = polarized(light, work.light, b), total = work.light.i[b];
      if (total > 0)
        importance[k] += (light.i * light.i + q * q) * work.uncertain[k].variance / (total * total);
    }
  work.order.resize(work.uncertain.size());
  std::iota(work.order.begin(), work.order.end(), 0u);
  std::sort(work.order.begin(), work.order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return std::pair(-importance[a], a) < std::pair(-importance[b], b);
  });
}

/// Puts the share of a facet's area that rays find in place of the looked-up one.
void Engine::State::trace_facet(const Pose &pose, std::size_t k, double wanted,
                                Workspace &work) const {
  backend::SeenFacet &facet = work.uncertain[k];
  const double whole = compiled.data.groups[facet.group].area[facet.lane];
  double weight = 0; // of the class's whole light against what may be left
  for (std::size_t b = 0; b < bands(); ++b) {
    const auto &light = work.facet_light[k * bands() + b];
    weight = std::max(weight, std::max(light.i, std::abs(polarized(light, work.light, b))) * whole /
                                  (wanted * std::max(work.light.i[b], 1e-300)));
  }
  const TracedShare traced =
      work.tracer->trace(refine_points.of(facet.group, facet.lane), points_for(weight), pose);
  const double points = static_cast<double>(traced.points);
  // One pseudo-disagreement stands for slivers that no point has found.
  const double share = std::clamp(traced.share, 0.5 / points, 1 - 0.5 / points);
  change_area(k, whole * traced.share - facet.area, work);
  facet.variance = whole * whole * static_cast<double>(mask_error.points) * share * (1 - share) /
                   (points * std::sqrt(points));
  work.is_traced[k] = 1;
}

void Engine::State::change_area(std::size_t k, double change, Workspace &work) const {
  backend::SeenFacet &facet = work.uncertain[k];
  const backend::SlotTerms &terms = compiled.data.slots[facet.slot];
  const double *weights = work.weights.data() + k * terms_max();
  facet.area += change;
  for (std::size_t l = 0; l < terms.lobe_count; ++l)
    work.sums.specular[terms.lobe_first + l] += weights[l] * change;
  for (std::size_t p = 0; p < terms.product_count; ++p)
    work.sums.product[terms.product_first + p] += weights[terms.lobe_count + p] * change;
  for (std::size_t b = 0; terms.is_general && b < bands(); ++b) {
    const auto &light = work.facet_light[k * bands() + b];
    work.general.i[b] += light.i * change;
    work.general.q[b] += light.q * change;
    work.general.u[b] += light.u * change;
    work.general.v[b] += light.v * change;
  }
}

void Engine::State::add_variance(std::size_t k, double variance, Workspace &work) const {
  const backend::SeenFacet &facet = work.uncertain[k];
  const backend::SlotTerms &terms = compiled.data.slots[facet.slot];
  const double *weights = work.weights.data() + k * terms_max();
  for (std::size_t l = 0; l < terms.lobe_count; ++l)
    work.sums.specular_variance[terms.lobe_first + l] += weights[l] * weights[l] * variance;
  for (std::size_t p = 0; p < terms.product_count; ++p) {
    const double w = weights[terms.lobe_count + p];
    work.sums.product_variance[terms.product_first + p] += w * w * variance;
  }
  for (std::size_t b = 0; terms.is_general && b < bands(); ++b) {
    const auto &light = work.facet_light[k * bands() + b];
    work.general.var_i[b] += light.i * light.i * variance;
    work.general.var_q[b] += light.q * light.q * variance;
    work.general.var_u[b] += light.u * light.u * variance;
    work.general.var_v[b] += light.v * light.v * variance;
  }
}

/// Traces the classes that make the error, the worst first, until the rest is well below what is
/// allowed.
void Engine::State::trace(const Pose &pose, Workspace &work) const {
  const double wanted = 0.7 * options.masks.refine_above / normal_95;
  Left left(bands());
  for (std::size_t k = 0; k < work.uncertain.size(); ++k)
    left.add(work, k, 1);
  order_by_error(work);
  work.is_traced.assign(work.uncertain.size(), 0);
  for (const std::uint32_t k : work.order) {
    if (left.is_enough(work.light, wanted))
      break;
    left.add(work, k, -1);
    trace_facet(pose, k, wanted, work);
  }
}

/// Variances of the sums from those that the facets have now.
void Engine::State::take_variances(Workspace &work) const {
  for (const backend::View<double> column :
       {work.sums.specular_variance, work.sums.product_variance, work.sums.specular_linear,
        work.sums.product_linear, backend::View<double>(work.general.var_i),
        backend::View<double>(work.general.var_q), backend::View<double>(work.general.var_u),
        backend::View<double>(work.general.var_v)})
    std::fill(column.begin(), column.end(), 0);
  for (std::size_t k = 0; k < work.uncertain.size(); ++k) {
    const backend::SeenFacet &facet = work.uncertain[k];
    const backend::SlotTerms &terms = compiled.data.slots[facet.slot];
    const double *weights = work.weights.data() + k * terms_max(),
                 deviation = std::sqrt(facet.variance);
    const auto add = [&](double weight, double &variance, double &linear) {
      variance += weight * weight * facet.variance;
      linear += work.is_traced[k] != 0 ? 0 : std::abs(weight) * deviation;
    };
    for (std::size_t l = 0; l < terms.lobe_count; ++l)
      add(weights[l], work.sums.specular_variance[terms.lobe_first + l],
          work.sums.specular_linear[terms.lobe_first + l]);
    for (std::size_t p = 0; p < terms.product_count; ++p)
      add(weights[terms.lobe_count + p], work.sums.product_variance[terms.product_first + p],
          work.sums.product_linear[terms.product_first + p]);
    for (std::size_t b = 0; terms.is_general && b < bands(); ++b) {
      const auto &s = work.facet_light[k * bands() + b];
      work.general.var_i[b] += s.i * s.i * facet.variance;
      work.general.var_q[b] += s.q * s.q * facet.variance;
      work.general.var_u[b] += s.u * s.u * facet.variance;
      work.general.var_v[b] += s.v * s.v * facet.variance;
    }
  }
  add_alike(work.sums);
}

void Engine::State::refine(const Pose &pose, const Prepared &at, Workspace &work) const {
  list_uncertain(pose, at, work);
  trace(pose, work);
  take_variances(work);
  take_roots(work);
}

} // namespace umov
