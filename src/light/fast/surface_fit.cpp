#include "light/fast/surface_fit.h"

#include "kernel/math.inl.h"
#include "light/fast/chebyshev.h"
#include "light/fast/lobe_fit.h"

#include "algebra/dense.h"
#include <algorithm>
#include <cmath>
#include <functional>

namespace umov {
namespace {

using Function = std::function<double(double)>;

/// A profile may differ from its polynomial by so much of its largest value: far below what
/// visibility costs.
constexpr double wanted_error = 1e-4, accepted_error = 2e-3;

/// Profiles are polynomials in t = 2 (1 + bend) c / (c + bend) - 1, c the cosine: with a bend of
/// some widths of the lobe, what happens near grazing is drawn out. Chosen by trial: degree 12
/// leaves 4e-7 at m = 20, 7e-5 at m = 1000 and 3e-4 at m = 10,000; in the square root of c 2e-3 and
/// 3e-2.
double cosine(double t, double bend) {
  const double y = 0.5 * (t + 1);
  return bend * y / (1 + bend - y);
}
constexpr double bend_in_widths = 8, bend_max = 20;

/// The values of a family of functions of the cosine at the nodes, reduced to few.
struct Basis {
  std::vector<NodeValues> functions;
  std::vector<std::vector<double>> share; ///< [member][function]
  double largest = 0;                     ///< value of any member

  /// How much the members make of an error of a function.
  [[nodiscard]] double weight(std::size_t function) const {
    double most = 0;
    for (const auto &of_member : share)
      most = std::max(most, std::abs(of_member[function]));
    return most;
  }
};

double size_of(const NodeValues &f) {
  double most = 0;
  for (const double value : f)
    most = std::max(most, std::abs(value));
  return most;
}

/// Greedy: the member that is reproduced worst, made orthogonal to those before it, comes next.
Basis reduce(const std::vector<Function> &family, double bend) {
  Basis out;
  std::vector<NodeValues> rest(family.size());
  for (std::size_t b = 0; b < family.size(); ++b)
    for (std::size_t i = 0; i < chebyshev_nodes; ++i) {
      rest[b][i] = family[b](cosine(chebyshev_node(i), bend));
      out.largest = std::max(out.largest, std::abs(rest[b][i]));
    }
  const auto product = [](const NodeValues &f, const NodeValues &g) {
    double sum = 0;
    for (std::size_t i = 0; i < chebyshev_nodes; ++i)
      sum += f[i] * g[i];
    return sum;
  };
  out.share.resize(family.size());
  while (out.functions.size() < backend::profiles_max) {
    std::size_t worst = 0;
    for (std::size_t b = 1; b < rest.size(); ++b)
      if (size_of(rest[b]) > size_of(rest[worst]))
        worst = b;
    if (size_of(rest[worst]) <= wanted_error * out.largest)
      break;
    const NodeValues f = rest[worst];
    const double square = product(f, f);
    for (std::size_t b = 0; b < rest.size(); ++b) {
      const double c = product(rest[b], f) / square;
      out.share[b].push_back(c);
      for (std::size_t i = 0; i < chebyshev_nodes; ++i)
        rest[b][i] -= c * f[i];
    }
    out.functions.push_back(f);
  }
  return out;
}

/// The lowest degree that serves; empty if none does. `unit`: what an error of 1 would matter.
std::optional<backend::Profile<double>> fit_profile(const NodeValues &value, double unit,
                                                    double bend) {
  for (std::size_t degree = 0; degree <= kernel::polynomial_degree; ++degree) {
    const Coefficients c = fit_polynomial(value, degree);
    double error = 0;
    for (std::size_t i = 0; i < chebyshev_nodes; ++i)
      error = std::max(
          error, std::abs(kernel::polynomial(c.data(), degree, chebyshev_node(i)) - value[i]));
    const bool is_last = degree == kernel::polynomial_degree;
    if (error > (is_last ? accepted_error : wanted_error) * unit)
      continue;
    backend::Profile<double> out;
    out.degree = static_cast<std::uint32_t>(degree);
    out.bend = bend;
    std::copy(c.begin(), c.end(), out.c);
    return out;
  }
  return {};
}

using DiffuseBands = std::vector<std::vector<Surface::SeparableDiffuse>>;

/// Diffuse terms of every band of a surface; empty if they have no such form.
std::optional<DiffuseBands> diffuse_of(const Surface &surface) {
  DiffuseBands out;
  for (std::size_t b = 0; b < surface.band_count(); ++b) {
    auto terms = surface.separable_diffuse(b);
    if (!terms || surface.normals(b) == nullptr)
      return {};
    out.push_back(std::move(*terms));
  }
  return out;
}

/// Adds the functions of a family as profiles. False if one does not fit.
bool add_profiles(const Basis &basis, double bend, SurfaceFit &out) {
  for (std::size_t k = 0; k < basis.functions.size(); ++k) {
    const auto profile = fit_profile(basis.functions[k], basis.largest / basis.weight(k), bend);
    if (!profile)
      return false;
    out.profiles.push_back(*profile);
  }
  return true;
}

/// What a function of a basis makes of the largest member, at most.
double part_of(const Basis &basis, std::size_t function) {
  return size_of(basis.functions[function]) * basis.weight(function) / basis.largest;
}

/// The part of the light that is polarized about the plane of emission, of a term whose profiles,
/// those of `entering`, stand already.
bool fit_polarizing(const std::vector<Function> &family, const Basis &entering, double bend,
                    SurfaceFit::Term &term, SurfaceFit &out) {
  const Basis basis = reduce(family, bend);
  term.polarizing_first = static_cast<std::uint32_t>(out.profiles.size());
  term.polarizing_count = static_cast<std::uint32_t>(basis.functions.size());
  if (!add_profiles(basis, bend, out))
    return false;
  for (std::uint32_t i = 0; i < term.count; ++i)
    for (std::uint32_t j = 0; j < term.polarizing_count; ++j)
      for (const auto kind : {backend::ProductKind::Cosine, backend::ProductKind::Sine})
        if (part_of(entering, i) * part_of(basis, j) > wanted_error)
          out.products.push_back({term.first + i, term.polarizing_first + j, kind});
  return true;
}

/// Profiles of term number t of all surfaces and bands: one family. False if it does not fit.
bool fit_term(const std::vector<DiffuseBands> &surfaces, std::size_t t, double bend,
              SurfaceFit &out) {
  std::vector<Function> family, polarizing;
  for (const DiffuseBands &bands : surfaces)
    for (const auto &terms : bands)
      if (t < terms.size()) {
        family.push_back(terms[t].profile);
        if (terms[t].polarizing)
          polarizing.push_back(terms[t].polarizing);
      }
  const Basis basis = reduce(family, bend);
  SurfaceFit::Term term{static_cast<std::uint32_t>(out.profiles.size()),
                        static_cast<std::uint32_t>(basis.functions.size()),
                        static_cast<std::uint32_t>(out.products.size()), 0};
  if (!add_profiles(basis, bend, out))
    return false;
  // Products of two small profiles are smaller than what the profiles themselves leave out.
  for (std::uint32_t i = 0; i < term.count; ++i)
    for (std::uint32_t j = i; j < term.count; ++j)
      if (part_of(basis, i) * part_of(basis, j) > wanted_error)
        out.products.push_back({term.first + i, term.first + j});
  term.product_count = static_cast<std::uint32_t>(out.products.size()) - term.product_first;
  if (!polarizing.empty() && !fit_polarizing(polarizing, basis, bend, term, out))
    return false;
  out.terms.push_back(term);
  return true;
}

bool fit_diffuse(const std::vector<DiffuseBands> &surfaces, double width, SurfaceFit &out) {
  const double bend = std::min(bend_in_widths * width, bend_max);
  std::size_t terms = 0;
  for (const DiffuseBands &bands : surfaces)
    for (const auto &of_band : bands)
      terms = std::max(terms, of_band.size());
  for (std::size_t t = 0; t < terms; ++t)
    if (!fit_term(surfaces, t, bend, out))
      return false;
  return out.profiles.size() <= backend::profiles_max &&
         out.products.size() <= backend::products_max;
}

bool has_lobe(const Surface &surface) {
  for (std::size_t b = 0; b < surface.band_count(); ++b)
    if (!surface.interface(b).is_void())
      return true;
  return false;
}

bool is_same_lobe(const kernel::LobeConstants<double> &a, const kernel::LobeConstants<double> &b) {
  return a.kind == b.kind && a.joint == b.joint && std::abs(a.shape - b.shape) <= 1e-9 * a.shape;
}

/// Adds the lobes of a surface that are not yet there. False if a kernel does not know one.
bool add_lobes(const Surface &surface, SurfaceFit &out) {
  // A polished surface is a lobe and a mirror in one.
  if (surface.material().apparent_roughness && surface.material().apparent_roughness->rms_height_nm)
    return false;
  for (std::size_t b = 0; b < (surface.is_specular_grey() ? 1 : surface.band_count()); ++b) {
    const auto lobe = fit_lobe(*surface.normals(b), surface.material().shadowing);
    if (!lobe)
      return false;
    const auto is_it = [&](const auto &other) { return is_same_lobe(*lobe, other); };
    if (std::any_of(out.lobes.begin(), out.lobes.end(), is_it))
      continue;
    out.lobes.push_back(*lobe);
    out.widths.push_back(surface.normals(b)->width());
  }
  return true;
}

/// A function as a sum of a term's profiles, and how far it is off at worst, relatively.
struct Projection {
  std::vector<double> share;
  std::vector<double> part; ///< of the function, that each profile makes at most
  double error = HUGE_VAL;
};
/// `unit`: what an error of the function is relative to.
Projection project(const Function &exact, const Function &unit, const SurfaceFit &fit,
                   std::size_t first, std::size_t count) {
  const auto columns = static_cast<Eigen::Index>(count);
  const auto *profiles = fit.profiles.data() + first;
  const auto value = [&](Eigen::Index k, double t) {
    return kernel::polynomial(profiles[k].c, profiles[k].degree, t);
  };
  Eigen::MatrixXd a(static_cast<Eigen::Index>(chebyshev_nodes), columns);
  Eigen::VectorXd wanted(static_cast<Eigen::Index>(chebyshev_nodes));
  for (std::size_t i = 0; i < chebyshev_nodes; ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    wanted(row) = exact(cosine(chebyshev_node(i), profiles[0].bend));
    for (Eigen::Index k = 0; k < columns; ++k)
      a(row, k) = value(k, chebyshev_node(i));
  }
  const Eigen::VectorXd share = algebra::least_squares(a, wanted);
  Projection out{{share.data(), share.data() + share.size()}, std::vector<double>(count, 0), 0};
  constexpr int steps = 200;
  for (int i = 1; i < steps; ++i) {
    const double t = 2.0 * i / steps - 1, c = cosine(t, profiles[0].bend), f = exact(c),
                 one = unit(c);
    double sum = 0;
    for (Eigen::Index k = 0; k < columns; ++k) {
      sum += share(k) * value(k, t);
      auto &part = out.part[static_cast<std::size_t>(k)];
      part = one > 0 ? std::max(part, std::abs(share(k) * value(k, t) / one)) : part;
    }
    if (one > 0)
      out.error = std::max(out.error, std::abs(sum - f) / one);
  }
  return out;
}

/// Q and U of emitted light as sums of products; gives the error in parts of I.
double add_polarized(const Surface::SeparableDiffuse &of, const SurfaceFit &fit,
                     const SurfaceFit::Term &term, const Projection &by,
                     std::vector<ProductLight> &products) {
  if (term.polarizing_count == 0)
    return HUGE_VAL;
  // Where light leaves at the normal it is not polarized: errors count with the squared sine.
  const auto unit = [&](double c) { return of.profile(c) / std::max((1 - c) * (1 + c), 1e-3); };
  const Projection out =
      project(of.polarizing, unit, fit, term.polarizing_first, term.polarizing_count);
  double error = out.error;
  std::size_t product = term.product_first + term.product_count;
  for (std::size_t i = 0; i < term.count; ++i)
    for (std::size_t j = 0; j < term.polarizing_count; ++j) {
      if (product == fit.products.size() || fit.products[product].first != term.first + i ||
          fit.products[product].second != term.polarizing_first + j) {
        error += by.part[i] * out.part[j]; // not summed
        continue;
      }
      const double c = of.factor * by.share[i] * out.share[j];
      products[product++].q += c;
      products[product++].u += c;
    }
  return error;
}

/// Adds one diffuse term of one band as a sum of products.
void add_term(const Surface::SeparableDiffuse &of, const SurfaceFit &fit, SurfaceLight &out,
              std::vector<ProductLight> &products) {
  const SurfaceFit::Term *best = nullptr;
  Projection by;
  for (const auto &term : fit.terms)
    if (Projection one = project(of.profile, of.profile, fit, term.first, term.count);
        one.error < by.error && (!of.polarizing || term.polarizing_count > 0)) {
      best = &term;
      by = std::move(one);
    }
  if (best == nullptr) {
    out.diffuse_error = HUGE_VAL;
    return;
  }
  std::size_t product = best->product_first;
  const std::size_t end = product + best->product_count;
  for (std::size_t i = 0; i < best->count; ++i)
    for (std::size_t j = i; j < best->count; ++j) {
      const int both = i == j ? 1 : 2;
      if (product == end || fit.products[product].first != best->first + i ||
          fit.products[product].second != best->first + j) {
        by.error += both * by.part[i] * by.part[j]; // not summed
        continue;
      }
      const double c = of.factor * by.share[i] * by.share[j] * both;
      (of.is_single_bounce ? products[product].single_bounce : products[product].unpolarized) += c;
      ++product;
    }
  if (of.polarizing)
    by.error += add_polarized(of, fit, *best, by, products);
  out.diffuse_error = std::max(out.diffuse_error, by.error);
}

} // namespace

std::optional<SurfaceFit> fit_surfaces(std::span<const Surface *const> surfaces) {
  SurfaceFit out;
  std::vector<DiffuseBands> diffuse;
  for (const Surface *surface : surfaces) {
    auto terms = diffuse_of(*surface);
    if (!terms || terms->empty() || (has_lobe(*surface) && !add_lobes(*surface, out)))
      return {};
    diffuse.push_back(std::move(*terms));
  }
  if (!fit_diffuse(diffuse, surfaces.front()->width(), out))
    return {};
  out.family = fit_family(out.lobes, surfaces.front()->material().shadowing);
  return out;
}

Result<SurfaceLight> light_in(const SurfaceFit &fit, const Surface &surface) {
  const auto refuse = [&](const char *why) {
    return fail(ErrorCode::BadInput,
                "material \"" + surface.material().name + "\" " + why +
                    " these sums were not made for; name it when the engine is made");
  };
  SurfaceLight out;
  const auto diffuse = diffuse_of(surface);
  if (!diffuse)
    return refuse("scatters in a way that");
  const bool is_lit = has_lobe(surface);
  for (std::size_t b = 0; b < surface.band_count(); ++b) {
    std::size_t lobe = 0;
    if (is_lit) {
      const auto wanted = fit_lobe(*surface.normals(b), surface.material().shadowing);
      while (wanted && lobe < fit.lobes.size() && !is_same_lobe(*wanted, fit.lobes[lobe]))
        ++lobe;
      if (!wanted || lobe == fit.lobes.size())
        return refuse("has a roughness or shadowing that");
    }
    out.lobe.push_back(static_cast<std::uint32_t>(lobe));
    auto &products = out.products.emplace_back(fit.products.size());
    for (const auto &term : (*diffuse)[b])
      add_term(term, fit, out, products);
  }
  if (!(out.diffuse_error < HUGE_VAL))
    return refuse("has body light that");
  return out;
}

} // namespace umov
