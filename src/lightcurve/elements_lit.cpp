#include "lightcurve/elements_lit.h"

#include "lightcurve/quadrature.h"

#include <algorithm>
#include <cmath>

namespace umov {
namespace {

/// Radius of the Sun's disk seen from 1 au [rad]; in half-vector space it is half as large.
constexpr double solar_radius_rad = 0.2665 * pi / 180;

/// Part of the whole light below which an element is left out: far under the rounding of the sum.
constexpr double negligible = 1e-25;

/// Angle from the normal at which D = (h.n)^m falls to one half [rad].
double lobe_half_width(double exponent) {
  return exponent > 0 ? std::acos(std::exp2(-1 / exponent)) : pi / 2;
}

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

/// Integrals of one side of one element.
struct SideIntegrals {
  RulePair specular;
  double projected = 0;
  std::vector<RulePair> body;
};

class Lighter {
public:
  Lighter(const Scene &scene, const Elements &elements, const PoseGeometry &pose)
      : scene_(scene), elements_(elements), pose_(pose), bands_(scene.bands.size()),
        is_known_(2 * scene.mesh.groups.size(), 0) {
    out_.fresnel.resize(is_known_.size() * bands_);
    out_.total.assign(bands_, 0);
    variance_i_.assign(bands_, 0);
    variance_q_.assign(bands_, 0);
    integrals_.body.resize(bands_);
  }

  LitElements run() {
    for (std::size_t i = 0; i < elements_.list.size(); ++i) {
      const Element &e = elements_.list[i];
      const SideSlots slots = elements_.slots[e.triangle];
      if (slots.front != no_index)
        consider(i, e, 1, slots.front);
      if (slots.back != no_index)
        consider(i, e, -1, slots.back);
    }
    std::stable_sort(out_.list.begin(), out_.list.end(),
                     [](const LitElement &a, const LitElement &b) { return a.slot < b.slot; });
    finish();
    return std::move(out_);
  }

private:
  void consider(std::size_t index, const Element &e, double side, std::uint32_t slot) {
    bool is_lit = false, is_seen = false;
    for (std::size_t k = 0; k < (e.is_flat ? 1u : 3u); ++k) {
      is_lit = is_lit || side * dot(e.normal[k], pose_.sun) > 0;
      is_seen = is_seen || side * dot(e.normal[k], pose_.observer) > 0;
    }
    if (!is_lit || !is_seen)
      return;
    const Surface &surface = surface_of_slot(scene_, slot);
    integrate(surface, e, side);
    learn_fresnel(surface, slot);
    LitElement lit;
    lit.element = static_cast<std::uint32_t>(index);
    lit.slot = slot;
    lit.side = static_cast<float>(side);
    lit.specular = integrals_.specular.value;
    lit.projected = integrals_.projected;
    lit.body_at = static_cast<std::uint32_t>(out_.body.size());
    bool has_light = false;
    for (std::size_t b = 0; b < bands_; ++b) {
      const FresnelFactors f = out_.fresnel[slot * bands_ + b];
      const double body = integrals_.body[b].value;
      const double value = f.a * lit.specular + body;
      out_.body.push_back(body);
      out_.total[b] += value;
      has_light = has_light || value > 0;
      const double error = f.a * integrals_.specular.error() + integrals_.body[b].error();
      variance_i_[b] += error * error;
      variance_q_[b] += f.b * f.b * integrals_.specular.error() * integrals_.specular.error();
    }
    if (!has_light) {
      out_.body.resize(lit.body_at);
      return;
    }
    lit.is_glint = e.is_flat && is_near_glint(e, side, surface.material().exponent);
    out_.list.push_back(lit);
  }

  void integrate(const Surface &surface, const Element &e, double side) {
    integrals_.specular = {};
    integrals_.projected = 0;
    std::fill(integrals_.body.begin(), integrals_.body.end(), RulePair{});
    const bool has_body = surface.has_body();
    const auto add = [&](Vec3<Body> n, double w, double w_low) {
      const double n_l = side * dot(n, pose_.sun), n_v = side * dot(n, pose_.observer);
      if (!(n_l > 0 && n_v > 0))
        return;
      integrals_.specular.add(surface.specular(n_l, n_v, pose_.cos_phase), w, w_low);
      integrals_.projected += w * n_l * n_v;
      for (std::size_t b = 0; has_body && b < bands_; ++b)
        integrals_.body[b].add(surface.body(b, n_l, n_v), w, w_low);
    };
    if (e.is_flat)
      add(e.normal[0], 1, 1);
    else
      for (std::size_t k = 0; k < TriangleRule::size; ++k) {
        const auto &p = TriangleRule::point[k];
        add(shading_normal(e, p[0], p[1], p[2]), TriangleRule::weight[k], TriangleRule::low[k]);
      }
    integrals_.specular.scale(e.area_m2);
    integrals_.projected *= e.area_m2;
    for (RulePair &body : integrals_.body)
      body.scale(e.area_m2);
  }

  void learn_fresnel(const Surface &surface, std::uint32_t slot) {
    if (is_known_[slot])
      return;
    is_known_[slot] = 1;
    for (std::size_t b = 0; b < bands_; ++b) {
      FresnelFactors &factors = out_.fresnel[slot * bands_ + b];
      factors = surface.fresnel(b, pose_.cos_phase);
      if (!pose_.has_plane)
        factors.b = 0;
    }
  }

  [[nodiscard]] bool is_near_glint(const Element &e, double side, double exponent) const {
    if (!(dot(pose_.half, pose_.half) > 0))
      return false;
    return angle_between(side * e.normal[0], pose_.half) <=
           lobe_half_width(exponent) + 0.5 * solar_radius_rad;
  }

  void finish() {
    for (LitElement &lit : out_.list)
      for (std::size_t b = 0; b < bands_; ++b)
        if (out_.total[b] > 0)
          lit.share +=
              (out_.fresnel[lit.slot * bands_ + b].a * lit.specular + out_.body[lit.body_at + b]) /
              (out_.total[b] * static_cast<double>(bands_));
    std::erase_if(out_.list, [](const LitElement &lit) { return !(lit.share > negligible); });
    for (std::size_t b = 0; b < bands_; ++b) {
      out_.rule_error_i.push_back(std::sqrt(variance_i_[b]));
      out_.rule_error_q.push_back(std::sqrt(variance_q_[b]));
    }
  }

  const Scene &scene_;
  const Elements &elements_;
  const PoseGeometry &pose_;
  std::size_t bands_;
  std::vector<char> is_known_; ///< per slot: its Fresnel factors are there
  std::vector<double> variance_i_, variance_q_;
  SideIntegrals integrals_;
  LitElements out_;
};

} // namespace

PoseGeometry geometry_of(const Pose &pose) {
  PoseGeometry out;
  out.sun = pose.sun;
  out.observer = pose.observer;
  out.has_plane = !(pose.sun == pose.observer) && !(pose.sun == -pose.observer);
  out.cos_phase = std::clamp(dot(pose.sun, pose.observer), -1.0, 1.0);
  const Vec3<Body> sum = pose.sun + pose.observer;
  // Below this the half vector is rounding; nothing can face both directions there anyway.
  if (norm(sum) > 1e-12)
    out.half = normalized(sum);
  return out;
}

LitElements light_elements(const Scene &scene, const Elements &elements, const PoseGeometry &pose) {
  return Lighter(scene, elements, pose).run();
}

} // namespace umov
