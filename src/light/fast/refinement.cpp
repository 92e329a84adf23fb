// Poses whose masks are uncertain: rays for the classes that make the error.

#include "light/fast/state.h"

#include <algorithm>
#include <cmath>

namespace umov {
/// Sampling leaves 0.6 n^-3/4 at worst.
std::size_t first_points(double weight) {
  constexpr double fewest = 32, most = 4096;
  return static_cast<std::size_t>(std::clamp(std::pow(3 * 0.6 * weight, 4.0 / 3), fewest, most));
}

/// One pseudo-disagreement stands for slivers that no point has found.
double share_variance(double share, double points) {
  const double unsure = std::clamp(share, 1 / points, 1 - 1 / points);
  return static_cast<double>(mask_error.points) * unsure * (1 - unsure) /
         (points * std::sqrt(points));
}

namespace {

/// The same of points that stand as they come: along an edge of a shadow some of many are no longer
/// spread evenly.
double random_variance(double share, double points) {
  const double unsure = std::clamp(share, 1 / points, 1 - 1 / points);
  return unsure * (1 - unsure) / points;
}

constexpr double points_most = 16'384; ///< of a class

/// How rays are spent. A series is asked to a fraction of a per cent, and its neighbours err
/// together: there classes are taken one by one, with all their doubtful points, to well below what
/// is asked.
struct Spending {
  std::size_t together; ///< classes whose first rays go in the same packets
  /// Large classes may be asked for some of their points alone, and what several leave adds up: so
  /// many times finer than one by itself; 0: all points.
  double beside_others;
  double wanted, left, more; ///< in parts of what is allowed: all, what is not traced, more looks
  double anew;               ///< a new look begins anew: with so many times the points at least
};
constexpr Spending for_series{1, 0, 0.9, 0.3, 0.8, 1.2}, for_far_poses{8, 3, 0.97, 0.4, 0.95, 1.5};
const Spending &spending_of(const EngineOptions &options) {
  return options.is_for_many_poses ? for_far_poses : for_series;
}

} // namespace

/// What relative errors refer to from now on: the light of the whole [m2/sr], or the floor below
/// which I need not be known as well. `all` counts areas in units of `unit_m2`.
void Engine::State::refer_to(const BandLight &all, double unit_m2, Workspace &work) const {
  const double scale = unit_m2 / compiled.area_m2;
  work.reference.resize(bands());
  work.q_share.resize(bands());
  for (std::size_t b = 0; b < bands(); ++b) {
    const double floor = options.floor_i.empty() ? 0 : options.floor_i[b] / compiled.area_m2;
    work.reference[b] = std::max({all.i[b] * scale, floor, 1e-300});
    work.q_share[b] = all.i[b] > 0 ? all.q[b] / all.i[b] : 0;
  }
}

/// Some band of a pose's light misses the accuracy from which on rays are traced.
bool Engine::State::is_uncertain(const BandLight &all, double unit_m2,
                                 const Workspace &work) const {
  const double most = options.masks.refine_above / normal_95 * compiled.area_m2 / unit_m2;
  for (std::size_t b = 0; b < bands(); ++b)
    if (all.var_i[b] > std::pow(most * work.reference[b], 2))
      return true;
  return false;
}

void Engine::State::list_uncertain(const Pose &pose, const Prepared &at,
                                   const backend::MaskErrorModel &error, Workspace &work) const {
  work.uncertain.reset(views.whole.groups.size() * backend::lanes, terms_max());
  if (options.is_double)
    backend::list_weighed(views.whole, hiding(), error, at.pose, work.uncertain);
  else
    backend::list_weighed(views.single, hiding(), error, at.single, work.uncertain);
  if (!error.has_doubts && may_mend()) // what is certain needs neither light nor rays
    work.uncertain.keep_if([](const backend::SeenFacet &facet) { return facet.variance > 0; });
  const std::size_t count = work.uncertain.facets.size();
  work.points.assign(count, 0);
  work.unit_first.assign(compiled.slots.size(), no_index);
  work.unit_light.clear();
  if (compiled.general_classes > 0)
    work.facet_light.resize(count * bands());
  for (std::size_t k = 0; k < count; ++k) {
    const backend::SeenFacet &facet = work.uncertain.facets[k];
    if (compiled.data.slots[facet.slot].is_general)
      light_of_general(pose, at, facet, work, work.facet_light.data() + k * bands());
    else if (work.unit_first[facet.slot] == no_index)
      light_units(facet.slot, work);
  }
}

/// Light per unit of each term of a slot.
void Engine::State::light_units(std::uint32_t slot, Workspace &work) const {
  const backend::SlotTerms &terms = compiled.data.slots[slot];
  const std::size_t count = terms.lobe_count + terms.product_count;
  work.unit.assign(2 * count, 0); // a one among zeros, and zeros
  work.unit_first[slot] = static_cast<std::uint32_t>(work.unit_light.size());
  const double *one = work.unit.data(), *none = one + count;
  for (std::size_t t = 0; t < count; ++t) {
    work.unit[t] = 1;
    work.part.reset(bands(), compiled.has_u);
    compiled.colours.add_slot(slot, {one, none, none, one + terms.lobe_count, none, false},
                              work.factors, work.part);
    work.unit[t] = 0;
    for (std::size_t b = 0; b < bands(); ++b)
      work.unit_light.push_back(
          {work.part.i[b], work.part.q[b], compiled.has_u ? work.part.u[b] : 0, 0});
  }
}

/// Light of an uncertain facet per unit area, in one band.
Stokes<ScatteringPlane> Engine::State::facet_light(std::size_t k, std::size_t band,
                                                   const Workspace &work) const {
  const std::uint32_t slot = work.uncertain.facets[k].slot;
  const backend::SlotTerms &terms = compiled.data.slots[slot];
  if (terms.is_general)
    return work.facet_light[k * bands() + band];
  const double *weight = work.uncertain.weights_of(k);
  const Stokes<ScatteringPlane> *unit = work.unit_light.data() + work.unit_first[slot] + band;
  Stokes<ScatteringPlane> out{};
  for (std::size_t t = 0; t < terms.lobe_count + terms.product_count; ++t)
    out += unit[t * bands()] * weight[t];
  return out;
}

/// Error of I, or of Q at constant Q/I, per area of each uncertain facet, in parts of the light of
/// the whole: of the band where it is worst. Which facets err most is seen in a few wavelengths of
/// the many that a curve is made of.
void Engine::State::weigh_errors(Workspace &work) const {
  const std::size_t count = work.uncertain.facets.size();
  work.error_per_area.assign(count, 0);
  for (std::size_t k = 0; k < count; ++k)
    for (const std::uint32_t b : judged_bands) {
      const auto light = facet_light(k, b, work);
      const double worst =
          std::max(light.i, std::abs(light.q - light.i * work.q_share[b]) / options.q_part);
      work.error_per_area[k] = std::max(work.error_per_area[k], worst / work.reference[b]);
    }
}

/// Adds the variances of one general facet.
void Engine::State::add_general_variance(std::size_t k, double deviation, Workspace &work) const {
  BandLight &out = work.variances;
  const double variance = work.uncertain.facets[k].variance;
  for (std::size_t b = 0; b < bands(); ++b) {
    const auto &s = work.facet_light[k * bands() + b];
    out.var_i[b] += s.i * s.i * variance;
    out.var_q[b] += s.q * s.q * variance;
    out.var_u[b] += s.u * s.u * variance;
    out.var_v[b] += s.v * s.v * variance;
    out.i[b] += s.i * deviation;
    out.q[b] += s.q * deviation;
  }
}

/// Adds the variances of a slot's facets, from `moments` of their weights. The square of a facet's
/// light is a quadratic form in its weights, the same for all facets of a slot: facets are added up
/// before there is any colour.
void Engine::State::add_slot_variance(std::uint32_t slot, Workspace &work) const {
  const backend::SlotTerms &terms = compiled.data.slots[slot];
  const std::size_t count = terms.lobe_count + terms.product_count, all = bands();
  const Stokes<ScatteringPlane> *unit = work.unit_light.data() + work.unit_first[slot];
  const double *linear = work.moments.data(), *square = linear + count;
  BandLight &out = work.variances;
  for (std::size_t t = 0; t < count; ++t) {
    for (std::size_t b = 0; b < all; ++b) {
      out.i[b] += unit[t * all + b].i * linear[t];
      out.q[b] += unit[t * all + b].q * linear[t];
    }
    for (std::size_t r = 0; r <= t; ++r, ++square) {
      const double twice = (r < t ? 2 : 1) * *square;
      for (std::size_t b = 0; b < all; ++b) {
        const auto &one = unit[t * all + b], &other = unit[r * all + b];
        out.var_i[b] += one.i * other.i * twice;
        out.var_q[b] += one.q * other.q * twice;
        out.var_u[b] += one.u * other.u * twice;
      }
    }
  }
}

/// Variances of the light from those that the facets have now: of every facet that could be seen,
/// each with all its light, where those of the sums add up the deviations of lobes and products.
void Engine::State::add_up_variances(Workspace &work) const {
  BandLight &out = work.variances;
  out.reset(bands(), true);
  std::vector<double> &alike = out.i; // deviations that are looked up, added up
  const std::size_t facets = work.uncertain.facets.size();
  for (std::size_t k = 0; k < facets; ++k) {
    const backend::SeenFacet &facet = work.uncertain.facets[k];
    const backend::SlotTerms &terms = compiled.data.slots[facet.slot];
    const double deviation = work.points[k] != 0 ? 0 : std::sqrt(facet.variance);
    if (terms.is_general) {
      add_general_variance(k, deviation, work);
      continue;
    }
    const std::size_t count = terms.lobe_count + terms.product_count;
    if (k == 0 || work.uncertain.facets[k - 1].slot != facet.slot)
      work.moments.assign(count + count * (count + 1) / 2, 0);
    const double *weight = work.uncertain.weights_of(k);
    double *linear = work.moments.data(), *square = linear + count;
    for (std::size_t t = 0; t < count; ++t) {
      linear[t] += weight[t] * deviation;
      for (std::size_t r = 0; r <= t; ++r, ++square)
        *square += weight[t] * weight[r] * facet.variance;
    }
    if (k + 1 == facets || work.uncertain.facets[k + 1].slot != facet.slot)
      add_slot_variance(facet.slot, work);
  }
  for (std::size_t b = 0; b < bands(); ++b) {
    out.var_i[b] += mask_alike * alike[b] * alike[b];
    out.var_q[b] += mask_alike * out.q[b] * out.q[b];
    for (std::vector<double> *variance : {&out.var_i, &out.var_q, &out.var_u})
      (*variance)[b] = std::max((*variance)[b], 0.0); // products of unlike terms round
  }
  work.has_variances = true;
}

/// Puts the share of a facet's area that rays find in place of the looked-up one.
void Engine::State::trace_facet(const Pose &pose, std::size_t k, std::size_t points,
                                Workspace &work) const {
  const TracedShare traced = work.tracer->trace(work.uncertain.facets[k], points, pose);
  put_share(k, traced.share, traced.points,
            traced_variance(traced.share, static_cast<double>(traced.points)), work);
}

/// Neighbours in a series ask the same points too, and err together. Where these agree, the one
/// pseudo-disagreement is large enough as it is.
double Engine::State::traced_variance(double share, double points) const {
  const bool is_edge = share * points > 1 && (1 - share) * points > 1;
  const double alike = options.doubts_all && is_edge ? static_cast<double>(mask_series) : 1;
  return alike * share_variance(share, points);
}

void Engine::State::put_share(std::size_t k, double share, std::size_t points, double variance,
                              Workspace &work) const {
  backend::SeenFacet &facet = work.uncertain.facets[k];
  const double whole = compiled.data.groups[facet.group].area[facet.lane];
  change_area(k, whole * share - facet.area, work);
  facet.variance = whole * whole * variance;
  work.points[k] = points;
}

/// The first look at the classes of work.asked: rays for those of the points that the masks know
/// which they doubt, as long as nothing else comes before the part.
void Engine::State::look_closer(const Pose &pose, const Prepared &at, double wanted,
                                Workspace &work) const {
  if (!masks || work.tracer->has_others()) {
    for (const AskedClass &asked : work.asked) {
      const backend::SeenFacet &facet = work.uncertain.facets[asked.which];
      const double whole = compiled.data.groups[facet.group].area[facet.lane];
      const double weight = work.error_per_area[asked.which] * whole / wanted;
      trace_facet(pose, asked.which, first_points(weight), work);
    }
    return;
  }
  work.doubtful.clear();
  for (std::uint32_t n = 0; n < work.asked.size(); ++n)
    list_doubtful(at, n, wanted, work);
  work.tracer->trace_doubtful(work.asked, work.doubtful, pose);
  for (const AskedClass &asked : work.asked) {
    const auto count = static_cast<double>(asked.points.size());
    const double doubted = static_cast<double>(asked.doubted) / count;
    if (asked.asked == asked.doubted) {
      const double share = static_cast<double>(asked.sure + asked.free) / count;
      put_share(asked.which, share, asked.points.size(), traced_variance(share, count), work);
      continue;
    }
    const double found = static_cast<double>(asked.free) / static_cast<double>(asked.asked);
    const double share = static_cast<double>(asked.sure) / count + doubted * found;
    const double variance =
        traced_variance(share, count) +
        doubted * doubted * random_variance(found, static_cast<double>(asked.asked));
    put_share(asked.which, share, asked.points.size(), variance, work);
  }
}

/// The points of work.asked[n] that the masks doubt, or some of them where fewer tell enough: a
/// large class has thousands.
void Engine::State::list_doubtful(const Prepared &at, std::uint32_t n, double wanted,
                                  Workspace &work) const {
  AskedClass &asked = work.asked[n];
  const backend::SeenFacet &facet = work.uncertain.facets[asked.which];
  const std::size_t first = work.doubtful.size();
  asked.points = masks->points(facet.group, facet.lane);
  asked.sure = split_points(*hiding(), at.pose, facet.group, facet.lane, n, work.doubtful);
  asked.doubted = asked.asked = work.doubtful.size() - first;
  const double beside_others = spending_of(options).beside_others;
  if (!(beside_others > 0))
    return;
  const double whole = compiled.data.groups[facet.group].area[facet.lane];
  const double doubted =
      whole * static_cast<double>(asked.doubted) / static_cast<double>(asked.points.size());
  const std::size_t enough =
      first_points(beside_others * work.error_per_area[asked.which] * doubted / wanted);
  if (enough >= asked.doubted)
    return;
  for (std::size_t i = 0; i < enough; ++i)
    work.doubtful[first + i] = work.doubtful[first + (2 * i + 1) * asked.doubted / (2 * enough)];
  work.doubtful.resize(first + enough);
  asked.asked = enough;
}

void Engine::State::change_area(std::size_t k, double change, Workspace &work) const {
  backend::SeenFacet &facet = work.uncertain.facets[k];
  const backend::SlotTerms &terms = compiled.data.slots[facet.slot];
  const double *weights = work.uncertain.weights_of(k);
  facet.area += change;
  for (std::size_t l = 0; l < terms.lobe_count; ++l)
    work.sums.specular[terms.lobe_first + l] += weights[l] * change;
  for (std::size_t p = 0; p < terms.product_count; ++p)
    work.sums.product[terms.product_first + p] += weights[terms.lobe_count + p] * change;
  for (std::size_t b = 0; terms.is_general && b < bands(); ++b) {
    const auto &light = work.facet_light[k * bands() + b];
    work.general.i[b] += light.i * change;
    work.general_i[facet.slot * bands() + b] += light.i * change;
    work.general.q[b] += light.q * change;
    work.general.u[b] += light.u * change;
    work.general.v[b] += light.v * change;
  }
}

void Engine::State::add_variance(std::size_t k, double variance, Workspace &work) const {
  const backend::SeenFacet &facet = work.uncertain.facets[k];
  const backend::SlotTerms &terms = compiled.data.slots[facet.slot];
  const double *weights = work.uncertain.weights_of(k);
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

/// Traces the classes that make most of the error, the worst first, until what the others leave is
/// well below what is allowed; gives the variance that these leave, in parts of the light's square.
double Engine::State::trace_worst(const Pose &pose, const Prepared &at, double wanted,
                                  Workspace &work) const {
  double variance = 0, linear = 0; // of what is still looked up
  double traced = 0;               // variance of what no longer is
  const auto relative = [&](std::size_t k) {
    return work.error_per_area[k] * work.error_per_area[k] * work.uncertain.facets[k].variance;
  };
  work.worst.clear();
  for (std::size_t k = 0; k < work.uncertain.facets.size(); ++k) {
    if (work.points[k] > 0) {
      traced += relative(k);
      continue;
    }
    variance += relative(k);
    linear += std::sqrt(relative(k));
    work.worst.emplace_back(relative(k), no_index - static_cast<std::uint32_t>(k));
  }
  const auto left = [&] { return variance + mask_alike * linear * linear; };
  std::make_heap(work.worst.begin(), work.worst.end());
  const double most = wanted * wanted;
  const Spending &spending = spending_of(options);
  while (!work.worst.empty() && left() > spending.left * most && left() + traced > most) {
    work.asked.clear();
    do {
      const auto [error, from_end] = work.worst.front();
      std::pop_heap(work.worst.begin(), work.worst.end());
      work.worst.pop_back();
      variance = std::max(variance - error, 0.0);
      linear = std::max(linear - std::sqrt(error), 0.0);
      work.asked.push_back({.which = no_index - from_end, .points = {}});
    } while (!work.worst.empty() && left() > spending.left * most &&
             work.asked.size() < spending.together);
    look_closer(pose, at, wanted, work);
    for (const AskedClass &asked : work.asked)
      traced += relative(asked.which);
  }
  return left();
}

/// More points for the traced classes, where what the first look found says that they are needed:
/// their variance falls with the 3/2 power of their number, so the fewest points for a given sum of
/// variances go with the 2/5 power of each (Neyman 1934).
bool Engine::State::trace_more(const Pose &pose, double allowed, Workspace &work) const {
  double now = 0, growth = 0; // at equal marginal gain
  const auto variance = [&](std::size_t k) {
    return work.error_per_area[k] * work.error_per_area[k] * work.uncertain.facets[k].variance;
  };
  // Variance of one point: c = v n^1.5; n_k = s c_k^0.4 leaves the sum of c_k^0.4 s^-1.5.
  for (std::size_t k = 0; k < work.uncertain.facets.size(); ++k)
    if (work.points[k] > 0) {
      now += variance(k);
      growth += std::pow(variance(k) * std::pow(static_cast<double>(work.points[k]), 1.5), 0.4);
    }
  if (now <= allowed || !(allowed > 0))
    return false;
  const double scale = std::pow(growth / (spending_of(options).more * allowed), 2.0 / 3);
  bool is_any = false;
  for (std::size_t k = 0; k < work.uncertain.facets.size(); ++k) {
    if (work.points[k] == 0)
      continue;
    const double n = static_cast<double>(work.points[k]);
    const double wanted =
        std::min(scale * std::pow(variance(k) * std::pow(n, 1.5), 0.4), points_most);
    if (wanted < spending_of(options).anew * n)
      continue;
    trace_facet(pose, k, static_cast<std::size_t>(wanted), work);
    is_any = is_any || static_cast<double>(work.points[k]) > n;
  }
  return is_any;
}

/// Rays, until the variance that is left is `part` of what the accuracy allows.
void Engine::State::trace(const Pose &pose, const Prepared &at, double part,
                          Workspace &work) const {
  const double wanted =
      spending_of(options).wanted * options.masks.refine_above / normal_95 * std::sqrt(part);
  constexpr int looks_max = 3;
  weigh_errors(work);
  const double left = trace_worst(pose, at, wanted, work);
  for (int look = 1; look < looks_max; ++look)
    if (!trace_more(pose, wanted * wanted - left, work))
      break;
}

/// Variances of the sums from those that the facets have now.
void Engine::State::sum_variances(Workspace &work) const {
  for (const backend::View<double> column :
       {work.sums.specular_variance, work.sums.product_variance, work.sums.specular_linear,
        work.sums.product_linear})
    std::fill(column.begin(), column.end(), 0);
  for (std::size_t k = 0; k < work.uncertain.facets.size(); ++k) {
    const backend::SeenFacet &facet = work.uncertain.facets[k];
    const backend::SlotTerms &terms = compiled.data.slots[facet.slot];
    const double *weights = work.uncertain.weights_of(k), deviation = std::sqrt(facet.variance);
    const auto add = [&](double weight, double &variance, double &linear) {
      variance += weight * weight * facet.variance;
      linear += work.points[k] != 0 ? 0 : std::abs(weight) * deviation;
    };
    for (std::size_t l = 0; l < terms.lobe_count; ++l)
      add(weights[l], work.sums.specular_variance[terms.lobe_first + l],
          work.sums.specular_linear[terms.lobe_first + l]);
    for (std::size_t p = 0; p < terms.product_count; ++p)
      add(weights[terms.lobe_count + p], work.sums.product_variance[terms.product_first + p],
          work.sums.product_linear[terms.product_first + p]);
  }
  add_alike(work.sums);
}

/// Rays for the facets that make the error, if there is too much of it.
void Engine::State::mend(const Pose &pose, const Prepared &at, Workspace &work) const {
  list_uncertain(pose, at, options.is_for_many_poses ? error_model() : doubtful_error, work);
  add_up_variances(work);
  work.is_mended = is_uncertain(work.variances, compiled.area_m2, work);
  if (!work.is_mended)
    return take_variances(work);
  // What rays find may be less light than the masks said, and the same error more of it.
  for (int round = 0; round < 2 && is_uncertain(work.variances, compiled.area_m2, work); ++round) {
    trace(pose, at, 1, work);
    add_up_variances(work);
    colour(work);
    refer_to(work.light, compiled.area_m2, work);
  }
}

} // namespace umov
