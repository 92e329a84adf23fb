#include "light/reference/elements_lit.h"

#include "light/reference/quadrature.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <umov/core/stop.h>
#include <umov/light/glints.h>

namespace umov {
namespace {

/// Part of the whole light below which an element is left out: far under the rounding of the sum.
constexpr double negligible = 1e-25;

/// An integral over one element by two rules.
struct RulePair {
  double value = 0, low = 0;
  void add(double f, double w, double w_low) {
    value += f * w;
    low += f * w_low;
  }
  void scale(double k) {
    value *= k;
    low *= k;
  }
  /// The difference of the rules is the error of the lower one; that of the higher one falls
  /// faster, as in the estimates of QUADPACK (Piessens et al. 1983, section 2.2.4.1).
  [[nodiscard]] double error() const {
    const double difference = std::abs(value - low);
    const double scale = std::max(std::abs(value), difference);
    return scale > 0 ? difference * std::min(1.0, std::sqrt(difference / scale)) : 0;
  }
};

/// A Stokes vector by two rules.
struct StokesPair {
  RulePair i, q, u, v;
  void add(const Stokes<ScatteringPlane> &s, double w, double w_low) {
    i.add(s.i, w, w_low);
    q.add(s.q, w, w_low);
    u.add(s.u, w, w_low);
    v.add(s.v, w, w_low);
  }
  void scale(double k) {
    for (RulePair *part : {&i, &q, &u, &v})
      part->scale(k);
  }
  [[nodiscard]] Stokes<ScatteringPlane> value() const {
    return {i.value, q.value, u.value, v.value};
  }
  [[nodiscard]] Stokes<ScatteringPlane> error() const {
    return {i.error(), q.error(), u.error(), v.error()};
  }
};

/// Integrals of one side of one element.
struct SideIntegrals {
  std::vector<RulePair> specular; ///< per lobe
  double projected = 0;
  std::vector<StokesPair> diffuse; ///< per band
};

constexpr int piece_depth_max = 24; ///< halvings of one element for a pose

class Lighter {
public:
  Lighter(const Scene &scene, const Elements &elements, const PoseGeometry &pose,
          const Stokes<ScatteringPlane> &source)
      : scene_(scene), elements_(elements), pose_(pose), source_(source),
        bands_(scene.grid.nodes().size()), is_known_(2 * scene.mesh.groups.size(), 0) {
    for (const auto *side : {&scene.front, &scene.back})
      for (const Surface &surface : *side)
        if (!surface.is_specular_grey())
          out_.lobes = bands_;
    out_.has_u_or_v = source.u != 0 || source.v != 0;
    for (const auto *side : {&scene.front, &scene.back})
      for (const Surface &surface : *side)
        out_.has_u_or_v =
            out_.has_u_or_v || (surface.material().body && surface.material().body->is_polarized) ||
            (surface.material().measured && surface.material().measured->has_polarization());
    out_.fresnel.resize(is_known_.size() * bands_);
    reflection_.resize(is_known_.size() * bands_);
    out_.total.assign(bands_, 0);
    integrals_.specular.resize(out_.lobes);
    integrals_.diffuse.resize(bands_);
  }

  LitElements run(const std::atomic<bool> *cancel) {
    for (std::size_t i = 0; i < elements_.list.size(); ++i) {
      leave_if_stopped(cancel, i);
      const Element &e = elements_.list[i];
      const SideSlots slots = elements_.slots[e.triangle];
      if (slots.front != no_index)
        consider(i, e, 1, slots.front, 0);
      if (slots.back != no_index)
        consider(i, e, -1, slots.back, 0);
    }
    std::stable_sort(out_.list.begin(), out_.list.end(),
                     [](const LitElement &a, const LitElement &b) { return a.slot < b.slot; });
    finish();
    return std::move(out_);
  }

private:
  void consider(std::size_t index, const Element &e, double side, std::uint32_t slot, int depth) {
    bool is_lit = false, is_seen = false;
    for (std::size_t k = 0; k < (e.is_flat ? 1u : 3u); ++k) {
      is_lit = is_lit || side * dot(e.normal[k], pose_.sun) > 0;
      is_seen = is_seen || side * dot(e.normal[k], pose_.observer) > 0;
    }
    if (!is_lit || !is_seen)
      return;
    const Surface &surface = surface_of_slot(scene_, slot);
    if (!e.is_flat && depth < piece_depth_max && is_too_coarse(surface, e, side)) {
      for (const Element &half : halves(e))
        consider(0, half, side, slot, depth + 1);
      return;
    }
    learn_reflection(surface, slot);
    integrate(surface, e, side, slot);
    LitElement lit;
    lit.is_piece = depth > 0;
    lit.element = static_cast<std::uint32_t>(lit.is_piece ? out_.pieces.size() : index);
    lit.slot = slot;
    lit.side = static_cast<float>(side);
    lit.projected = integrals_.projected;
    if (!keep_light(lit))
      return;
    if (lit.is_piece)
      out_.pieces.push_back(e);
    lit.is_glint = e.is_flat && is_near_glint(e, side, surface);
    out_.list.push_back(lit);
  }

  /// True where the normal turns by more than the lobe over the element and the lobe is near.
  [[nodiscard]] bool is_too_coarse(const Surface &surface, const Element &e, double side) const {
    // The Sun's disk widens a lobe in half vectors by a quarter of its radius; its edge is sharp.
    const double width =
        std::max(surface.width(), pose_.sun_radius_rad * (surface.width() > 0 ? 0.25 : 0.06));
    const double wanted = std::max(element_turn_in_lobes * width, 1e-5);
    double turn = 0;
    for (std::size_t k = 0; k < 3; ++k)
      turn = std::max(turn, norm(e.normal[k] - e.normal[(k + 1) % 3]));
    if (turn <= wanted || turn <= 1e-7)
      return false;
    if (turn > element_turn_min_rad)
      return false; // wide lobes were cut well enough before
    const Vec3<Body> middle = normalized(e.normal[0] + e.normal[1] + e.normal[2]);
    constexpr double reach = 9; // standard deviations
    return dot(pose_.half, pose_.half) > 0 &&
           angle_between(side * middle, pose_.half) < turn + reach * width + pose_.sun_radius_rad;
  }

  /// The element cut across the edge along which the normal turns most.
  [[nodiscard]] static std::array<Element, 2> halves(const Element &e) {
    std::size_t edge = 0;
    double most = -1;
    for (std::size_t k = 0; k < 3; ++k)
      if (const double turn = norm(e.normal[k] - e.normal[(k + 1) % 3]); turn > most) {
        most = turn;
        edge = k;
      }
    const std::size_t next = (edge + 1) % 3;
    const Vec3<Body> normal = normalized(e.normal[edge] + e.normal[next]);
    const std::array<double, 2> corner{0.5 * (e.corner[edge][0] + e.corner[next][0]),
                                       0.5 * (e.corner[edge][1] + e.corner[next][1])};
    std::array<Element, 2> out{e, e};
    out[0].normal[next] = out[1].normal[edge] = normal;
    out[0].corner[next] = out[1].corner[edge] = corner;
    out[0].area_m2 = out[1].area_m2 = 0.5 * e.area_m2;
    return out;
  }

  /// Stores the integrals; false, and nothing stored, if there is no light in any band.
  bool keep_light(LitElement &lit) {
    lit.specular_at = static_cast<std::uint32_t>(out_.specular.size());
    lit.diffuse_at = static_cast<std::uint32_t>(out_.diffuse.size());
    for (const RulePair &lobe : integrals_.specular)
      out_.specular.push_back(lobe.value);
    for (const StokesPair &band : integrals_.diffuse)
      out_.diffuse.push_back(band.value());
    bool has_light = false;
    for (std::size_t b = 0; b < bands_; ++b) {
      const double value = out_.light_of(lit, b).i;
      has_light = has_light || value > 0;
      out_.total[b] += value;
      const Stokes<ScatteringPlane> f = out_.fresnel[lit.slot * bands_ + b];
      const double error = integrals_.specular[out_.lobe_of(b)].error();
      const Stokes<ScatteringPlane> d = integrals_.diffuse[b].error();
      const auto square = [](double x) { return x * x; };
      out_.rule_variance.push_back({square(f.i * error + d.i), square(std::abs(f.q) * error + d.q),
                                    square(std::abs(f.u) * error + d.u),
                                    square(std::abs(f.v) * error + d.v)});
    }
    if (!has_light) {
      out_.specular.resize(lit.specular_at);
      out_.diffuse.resize(lit.diffuse_at);
      out_.rule_variance.resize(lit.diffuse_at);
    }
    return has_light;
  }

  void integrate(const Surface &surface, const Element &e, double side, std::uint32_t slot) {
    std::fill(integrals_.specular.begin(), integrals_.specular.end(), RulePair{});
    std::fill(integrals_.diffuse.begin(), integrals_.diffuse.end(), StokesPair{});
    integrals_.projected = 0;
    const bool has_diffuse = surface.has_diffuse();
    const auto add = [&](Vec3<Body> n, double w, double w_low) {
      const SurfaceDirections at = directions_at(scene_, pose_, e, slot, side * n);
      if (!(at.l.z > 0 && at.v.z > 0))
        return;
      for (std::size_t k = 0; k < out_.lobes; ++k)
        integrals_.specular[k].add(surface.specular(k, at), w, w_low);
      integrals_.projected += w * at.l.z * at.v.z;
      for (std::size_t b = 0; has_diffuse && b < bands_; ++b)
        integrals_.diffuse[b].add(surface.diffuse(b, at, source_, reflection_[slot * bands_ + b]),
                                  w, w_low);
    };
    if (e.is_flat)
      add(e.normal[0], 1, 1);
    else
      for (std::size_t k = 0; k < TriangleRule::size; ++k) {
        const auto &p = TriangleRule::point[k];
        add(shading_normal(e, p[0], p[1], p[2]), TriangleRule::weight[k], TriangleRule::low[k]);
      }
    for (RulePair &lobe : integrals_.specular)
      lobe.scale(e.area_m2);
    integrals_.projected *= e.area_m2;
    for (StokesPair &band : integrals_.diffuse)
      band.scale(e.area_m2);
  }

  /// One microfacet incidence serves the whole pose.
  void learn_reflection(const Surface &surface, std::uint32_t slot) {
    if (is_known_[slot])
      return;
    is_known_[slot] = 1;
    const bool is_sunlight = source_.q == 0 && source_.u == 0 && source_.v == 0;
    for (std::size_t b = 0; b < bands_; ++b) {
      const FacetMueller m = surface.mueller(b, pose_.cos_phase);
      reflection_[slot * bands_ + b] = m;
      Stokes<ScatteringPlane> &light = out_.fresnel[slot * bands_ + b];
      light = m * source_;
      if (is_sunlight && !pose_.has_plane)
        light.q = 0;
    }
  }

  [[nodiscard]] bool is_near_glint(const Element &e, double side, const Surface &surface) const {
    if (!(dot(pose_.half, pose_.half) > 0))
      return false;
    const double half_width = surface.half_width_rad();
    return half_width <= widest_glint_rad && angle_between(side * e.normal[0], pose_.half) <=
                                                 half_width + 0.5 * sun_radius_at_1au_rad;
  }

  void finish() {
    for (LitElement &lit : out_.list)
      for (std::size_t b = 0; b < bands_; ++b)
        if (out_.total[b] > 0)
          lit.share += out_.light_of(lit, b).i / (out_.total[b] * static_cast<double>(bands_));
    std::erase_if(out_.list, [](const LitElement &lit) { return !(lit.share > negligible); });
  }

  const Scene &scene_;
  const Elements &elements_;
  const PoseGeometry &pose_;
  const Stokes<ScatteringPlane> &source_;
  std::size_t bands_;
  std::vector<char> is_known_;           ///< per slot: its reflection is there
  std::vector<FacetMueller> reflection_; ///< one: [slot * bands + band]
  SideIntegrals integrals_;
  LitElements out_;
};

} // namespace

SurfaceDirections directions_at(const Scene &scene, const PoseGeometry &pose, const Element &e,
                                std::uint32_t slot, Vec3<Body> normal) {
  return directions_on(normal,
                       direction_field(scene.mesh, surface_of_slot(scene, slot), e.triangle),
                       pose.sun, pose.observer, pose.cos_phase, pose.sun_radius_rad);
}

PoseGeometry geometry_of(const Pose &pose) {
  PoseGeometry out;
  out.sun = pose.sun;
  out.observer = pose.observer;
  out.sun_radius_rad = pose.sun_radius_rad;
  out.has_plane = has_scattering_plane(pose);
  out.cos_phase = cos_phase(pose);
  const Vec3<Body> sum = pose.sun + pose.observer;
  // Below this the half vector is rounding; nothing can face both directions there anyway.
  if (norm(sum) > 1e-12)
    out.half = normalized(sum);
  return out;
}

LitElements light_elements(const Scene &scene, const Elements &elements, const PoseGeometry &pose,
                           const Stokes<ScatteringPlane> &source, const std::atomic<bool> *cancel) {
  return Lighter(scene, elements, pose, source).run(cancel);
}

} // namespace umov
