#include "light/between/chain_surfaces.h"

#include "kernel/disk_lobe.h"

#include "light/fast/chebyshev.h"
#include "light/fast/lobe_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <umov/core/random.h>
#include <umov/core/stop.h>
#include <umov/light/integrator.h>

namespace umov {
namespace {

/// Product of the widths (rms slopes) of two lobes below which chains, that have to meet both by
/// chance, are too few: GGX of alpha 0.1 twice.
constexpr double least_widths = 0.0049;
/// A lobe narrower than this (GGX of alpha 0.07) is met by too few chains whatever stands at the
/// other end, and a pose that has many others would not notice; a path begun on it meets it always.
constexpr double least_width = 0.05;
/// Between two lobes narrower than this (GGX of alpha 0.14) few of the chains that levels keep
/// carry anything to a pose, and some of those much: their spread tells too little.
constexpr double wide = 0.1;
constexpr std::size_t cosines = 32;

/// Cosine at t = 2 (1 + bend) c/(c + bend) - 1.
double cosine_at(double bend, double t) {
  const double x = (t + 1) / (2 * (1 + bend));
  return std::min(1.0, bend * x / (1 - x));
}

/// Functions of a cosine, `n` of them, at Chebyshev's nodes of t and at places between them.
template <std::size_t n> struct Sampled {
  using Values = std::array<double, n>;
  static constexpr std::size_t places = 201;
  static double place(std::size_t k) { return -1 + 0.01 * static_cast<double>(k); }

  double bend;
  std::array<NodeValues, n> at_node{};
  std::array<Values, places> between{};

  template <class Function> Sampled(double of_bend, const Function &f) : bend(of_bend) {
    for (std::size_t i = 0; i < chebyshev_nodes; ++i) {
      const Values values = f(cosine_at(bend, chebyshev_node(i)));
      for (std::size_t part = 0; part < n; ++part)
        at_node[part][i] = values[part];
    }
    for (std::size_t k = 0; k < places; ++k)
      between[k] = f(cosine_at(bend, place(k)));
  }
  /// One of them as powers of t; returns by what it misses at worst, in parts of what `scale` says
  /// of their values there.
  template <class Scale>
  double fit(std::size_t part, std::size_t degree, const Scale &scale, float *out) const {
    const Coefficients c = fit_polynomial(at_node[part], degree);
    std::transform(c.begin(), c.end(), out, [](double x) { return static_cast<float>(x); });
    double worst = 0;
    for (std::size_t k = 0; k < places; ++k) {
      double sum = 0;
      for (std::size_t power = degree + 1; power-- > 0;)
        sum = sum * place(k) + c[power];
      const double error = std::abs(sum - between[k][part]) / scale(between[k]);
      if (!(error <= worst)) // no number is the worst of all
        worst = error;
    }
    return worst;
  }
};

/// All of `n` functions by polynomials of one bend and degree: the lowest that misses no more than
/// is wanted of what `scale` says, or the best of all that is good enough in parts of `most`; false
/// if there is none.
template <std::size_t n, class Function, class Scale>
bool fit_all(const Function &f, const Scale &scale, double most, const std::array<float *, n> &out,
             float &bend, std::uint32_t &degree) {
  std::vector<Sampled<n>> all;
  for (const double one : {1e3, 1.0, 0.3, 0.1})
    all.emplace_back(one, f);
  const auto miss_of = [&](const Sampled<n> &sampled, std::size_t of_degree, const auto &parts_of) {
    double worst = 0;
    for (std::size_t part = 0; part < n; ++part)
      if (const double miss = sampled.fit(part, of_degree, parts_of, out[part]); !(miss <= worst))
        worst = miss;
    bend = static_cast<float>(sampled.bend);
    degree = static_cast<std::uint32_t>(of_degree);
    return worst;
  };
  for (std::size_t k = 2; k <= kernel::polynomial_degree; k += 2)
    for (const Sampled<n> &sampled : all)
      if (miss_of(sampled, k, scale) <= backend::chain_fit_wanted)
        return true;
  const auto of_most = [most](const auto &) { return most; };
  const auto whole = [&](const Sampled<n> &sampled) {
    return miss_of(sampled, kernel::polynomial_degree, of_most);
  };
  return whole(*std::ranges::min_element(all, {}, whole)) <= backend::chain_fit_error;
}

bool fit_reflection(const Surface &surface, std::size_t band, backend::ChainSurface &out) {
  const auto reflection = [&](double cosine) {
    const MuellerEntries m = surface.reflection(band, cosine);
    return std::array{m.a, m.b, m.z.real(), m.z.imag()};
  };
  // Of glass a is a twenty-fifth near the normal of what it is along the surface.
  const auto reflected = [](const std::array<double, 4> &m) { return m[0]; };
  return fit_all<4>(reflection, reflected, surface.reflection(band, 0).a,
                    {out.a, out.b, out.z_real, out.z_imaginary}, out.bend, out.degree);
}

bool fit_products(const Surface &surface, std::size_t band, backend::ChainSurface &out) {
  if (!surface.has_diffuse())
    return true;
  const auto products = surface.separable_diffuse(band);
  if (!products || products->size() > backend::chain_products_max)
    return false;
  for (const Surface::SeparableDiffuse &from : *products) {
    backend::ChainProduct &to = out.product[out.products++];
    to.factor = static_cast<float>(from.factor);
    to.is_as_reflected = from.is_single_bounce;
    to.is_polarized = static_cast<bool>(from.polarizing);
    const auto profiles = [&](double c) {
      return std::array{from.profile(c), to.is_polarized ? from.polarizing(c) * (1 - c * c) : 0};
    };
    const auto entering = [](const std::array<double, 2> &) { return 1.0; };
    if (!fit_all<2>(profiles, entering, 1, {to.profile, to.polarizing}, to.bend, to.degree))
      return false;
  }
  return true;
}

bool has_lobe(const Surface &surface, std::size_t band) {
  return surface.normals(band) != nullptr && surface.reflection(band, 0.01).a > 0;
}

bool compile(const Surface &surface, std::size_t band, backend::ChainSurface &out) {
  const Distribution *normals = surface.normals(band);
  if (normals == nullptr || surface.has_mirror() || surface.is_anisotropic())
    return false;
  const auto lobe = fit_lobe(*normals, surface.material().shadowing);
  if (!lobe)
    return false;
  out.lobe = kernel::round_lobe(*lobe);
  out.has_lobe = has_lobe(surface, band);
  return (!out.has_lobe || fit_reflection(surface, band, out)) && fit_products(surface, band, out);
}

bool is_left_to_paths(const Surface &surface) {
  return surface.has_mirror() || surface.material().measured ||
         (has_lobe(surface, 0) && surface.width() < least_width);
}

ChainPart part_of(const Surface &a, const Surface &b) {
  if (is_left_to_paths(a) || is_left_to_paths(b))
    return ChainPart::Nothing;
  if (a.width() * b.width() >= least_widths)
    return ChainPart::Whole;
  const bool is_lobe_alone = !a.has_diffuse() && !b.has_diffuse();
  return is_lobe_alone ? ChainPart::Nothing : ChainPart::WithoutLobes;
}

bool reflects_nothing(const Surface &surface, std::size_t bands) {
  for (std::size_t b = 0; b < bands; ++b)
    if (has_lobe(surface, b) || surface.has_diffuse() || surface.has_mirror())
      return false;
  return true;
}

} // namespace

bool chains_draw_any(const Scene &scene) {
  const std::vector<VisibleSides> sides = visible_sides(scene.mesh);
  std::set<const Surface *> ends;
  for (std::size_t t = 0; t < sides.size(); ++t)
    for (const bool is_front : {true, false})
      if (is_front ? sides[t].front : sides[t].back)
        ends.insert(&surface_of_side(scene, scene.mesh.triangles[t], is_front));
  std::erase_if(
      ends, [&](const Surface *one) { return reflects_nothing(*one, scene.grid.nodes().size()); });
  return std::ranges::any_of(ends, [&](const Surface *a) {
    return std::ranges::any_of(
        ends, [&](const Surface *b) { return part_of(*a, *b) != ChainPart::Nothing; });
  });
}

ChainSurfaces::ChainSurfaces(const Scene &scene, const std::atomic<bool> *cancel) {
  const std::size_t bands = scene.grid.nodes().size();
  for (const auto *side : {&scene.front, &scene.back})
    for (const Surface &surface : *side) {
      std::uint32_t kind = 0;
      while (kind < surface_.size() && !surface_[kind]->is_same(surface))
        ++kind;
      if (kind == surface_.size())
        surface_.push_back(&surface);
      kind_[&surface] = kind;
    }
  fast_.resize(surface_.size() * bands);
  for (std::uint32_t kind = 0; kind < surface_.size(); ++kind) {
    leave_if_stopped(cancel);
    bool is_fast = true;
    for (std::size_t b = 0; b < bands && is_fast; ++b) {
      backend::ChainSurface &to = fast_[kind * bands + b];
      is_fast = compile(*surface_[kind], b, to);
      to.is_lobe_of_first = b > 0 && surface_[kind]->is_specular_grey();
    }
    is_fast_.push_back(is_fast ? 1 : 0);
  }
  leaves_any_.assign(surface_.size(), 0);
  for (std::uint32_t a = 0; a < surface_.size(); ++a)
    for (std::uint32_t b = 0; b < surface_.size(); ++b) {
      if (part(a, b) != ChainPart::Whole)
        leaves_any_[a] = leaves_any_[b] = 1;
      needs_paths_ = needs_paths_ || part(a, b) != ChainPart::Whole;
      has_any_ = has_any_ || part(a, b) != ChainPart::Nothing;
    }
  are_fast_ = are_narrow_ = has_any_;
  for (std::uint32_t a = 0; a < surface_.size(); ++a) {
    if (is_left_to_paths(*surface_[a]))
      continue; // no end of a chain
    are_fast_ = are_fast_ && is_fast(a);
    are_narrow_ = are_narrow_ && !surface_[a]->has_diffuse() && is_narrow(a);
  }
  tabulate_strength(bands, cancel);
}

ChainSurfaces::ChainSurfaces(const ChainSurfaces &known, const Scene &of_known, const Scene &scene)
    : ChainSurfaces(known) {
  kind_.clear();
  for (const auto side : {&Scene::front, &Scene::back})
    for (std::size_t g = 0; g < (scene.*side).size(); ++g) {
      const std::uint32_t kind = known.kind_of(&(of_known.*side)[g]);
      const Surface *surface = &(scene.*side)[g];
      kind_[surface] = kind;
      surface_[kind] = surface;
    }
}

bool ChainSurfaces::is_narrow(std::uint32_t kind) const {
  return has_lobe(*surface_[kind], 0) && surface_[kind]->width() < wide;
}

ChainPart ChainSurfaces::part(std::uint32_t a, std::uint32_t b) const {
  return part_of(*surface_[a], *surface_[b]);
}

void ChainSurfaces::tabulate_strength(std::size_t bands, const std::atomic<bool> *cancel) {
  constexpr std::size_t draws = 512;
  const Vec3<Body> normal{0, 0, 1};
  for (const Surface *surface : surface_) {
    ByCosine &out = strength_.emplace_back(cosines + 1);
    auto &of_band = strength_of_band_.emplace_back(bands, ByCosine(cosines + 1));
    if (is_left_to_paths(*surface))
      continue;
    const Sampler sampler(*surface);
    for (std::size_t k = 0; k <= cosines; ++k) {
      leave_if_stopped(cancel);
      const double c = std::max(0.02, static_cast<double>(k) / cosines);
      const Vec3<Body> w{std::sqrt(1 - c * c), 0, c};
      for (std::size_t i = 0; i < draws; ++i) {
        const auto u = uniform4(0, 0xC4A0, k * draws + i);
        const Direction d = sampler.draw(normal, w, u[0], u[1], u[2]);
        if (!(d.density > 0))
          continue;
        const auto on = directions_on(normal, {}, d.to, w, dot(d.to, w), 0);
        for (std::size_t b = 0; b < bands; ++b) {
          const double f = surface->brdf(b, on).m[0][0] * d.to.z;
          of_band[b][k] += f * f / d.density / draws;
        }
      }
      for (ByCosine &one : of_band) {
        out[k] += one[k] / static_cast<double>(bands);
        one[k] = std::sqrt(one[k] / (4 * pi));
      }
      out[k] = std::sqrt(out[k] / (4 * pi));
    }
  }
}

double ChainSurfaces::at_cosine(const ByCosine &table, double cosine) {
  const double x = std::clamp(cosine, 0.0, 1.0) * cosines;
  const auto k = std::min(static_cast<std::size_t>(x), cosines - 1);
  return table[k] + (x - static_cast<double>(k)) * (table[k + 1] - table[k]);
}

} // namespace umov
