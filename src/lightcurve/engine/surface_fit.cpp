#include "lightcurve/engine/surface_fit.h"

#include "kernel/microfacet.inl.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

namespace umov {
namespace {

using Function = std::function<double(double)>;
using Coefficients = std::array<double, kernel::polynomial_degree + 1>;

/// A profile may differ from its polynomial by so much of its largest value: far below what
/// visibility costs.
constexpr double wanted_error = 1e-4, accepted_error = 2e-3;
constexpr std::size_t nodes = 64;

double node(std::size_t i) { // Chebyshev's, in [-1, 1]
  return std::cos(std::numbers::pi * (static_cast<double>(i) + 0.5) / nodes);
}

/// Profiles are polynomials in t = 2 (1 + bend) c / (c + bend) - 1, c the cosine: with a bend of
/// some widths of the lobe, what happens near grazing is drawn out. Chosen by trial: degree 12
/// leaves 4e-7 at m = 20, 7e-5 at m = 1000 and 3e-4 at m = 10,000; in the square root of c 2e-3 and
/// 3e-2.
double cosine(double t, double bend) {
  const double y = 0.5 * (t + 1);
  return bend * y / (1 + bend - y);
}
constexpr double bend_in_widths = 8, bend_max = 20;

/// Powers of t of Chebyshev's polynomials T_0 ... T_degree.
std::vector<Coefficients> chebyshev_powers(std::size_t degree) {
  std::vector<Coefficients> out{{1}, {0, 1}};
  for (std::size_t k = 2; k <= degree; ++k) { // T_k = 2 t T_{k-1} - T_{k-2}
    Coefficients next{};
    for (std::size_t j = 0; j < kernel::polynomial_degree; ++j)
      next[j + 1] = 2 * out[k - 1][j];
    for (std::size_t j = 0; j <= kernel::polynomial_degree; ++j)
      next[j] -= out[k - 2][j];
    out.push_back(next);
  }
  return out;
}

/// Least squares over the nodes, as powers of t.
Coefficients fit(const std::array<double, nodes> &value, std::size_t degree) {
  const auto powers = chebyshev_powers(degree);
  const auto columns = static_cast<Eigen::Index>(degree + 1);
  Eigen::MatrixXd a(static_cast<Eigen::Index>(nodes), columns);
  Eigen::VectorXd b(static_cast<Eigen::Index>(nodes));
  for (std::size_t i = 0; i < nodes; ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    b(row) = value[i];
    for (Eigen::Index k = 0; k < columns; ++k)
      a(row, k) = kernel::polynomial(powers[static_cast<std::size_t>(k)].data(),
                                     static_cast<std::size_t>(k), node(i));
  }
  const Eigen::VectorXd c = a.householderQr().solve(b);
  Coefficients out{};
  for (std::size_t k = 0; k <= degree; ++k)
    for (std::size_t j = 0; j <= k; ++j)
      out[j] += c(static_cast<Eigen::Index>(k)) * powers[k][j];
  return out;
}

/// P = 1 beyond this cosine, to single precision.
double masking_limit(const Distribution &normals) {
  const auto p = [&](double c) { return normals.masking({std::sqrt(1 - c * c), 0, c}); };
  double low = 0, high = 1;
  for (int i = 0; i < 40; ++i) {
    const double middle = 0.5 * (low + high);
    (p(middle) < 1 - 3e-7 ? low : high) = middle;
  }
  return std::max(high, 1e-6);
}

std::optional<kernel::LobeConstants<double>> fit_lobe(const Distribution &normals,
                                                      Shadowing shadowing) {
  const auto form = normals.kernel_form();
  if (!form)
    return {};
  kernel::LobeConstants<double> out;
  out.shape = form->shape;
  out.per_width2 = 1 / (normals.width() * normals.width());
  switch (form->kind) {
  case KernelForm::Kind::BlinnPhong:
    out.kind = kernel::LobeKind::BlinnPhong;
    out.peak = kernel::blinn_phong_peak(form->shape);
    break;
  case KernelForm::Kind::Beckmann:
    out.kind = kernel::LobeKind::Beckmann;
    break;
  case KernelForm::Kind::Ggx:
    out.kind = kernel::LobeKind::Ggx;
    break;
  }
  switch (shadowing) {
  case Shadowing::Ashikhmin:
    out.joint = kernel::JointMasking::Ashikhmin;
    break;
  case Shadowing::Smith:
    out.joint = kernel::JointMasking::Smith;
    break;
  case Shadowing::SmithDirectional:
    out.joint = kernel::JointMasking::SmithDirectional;
    break;
  case Shadowing::Separable:
    out.joint = kernel::JointMasking::Separable;
    break;
  }
  if (out.kind == kernel::LobeKind::Ggx)
    return out; // its masking is closed
  out.masking_limit = masking_limit(normals);
  out.masking_scale = 2 / out.masking_limit;
  const auto per_cosine = [&](double c) {
    return normals.masking({std::sqrt(std::max(0.0, 1 - c * c)), 0, c}) / c;
  };
  std::array<double, nodes> value{};
  for (std::size_t i = 0; i < nodes; ++i)
    value[i] = per_cosine((node(i) + 1) / out.masking_scale);
  const Coefficients c = fit(value, kernel::polynomial_degree);
  std::copy(c.begin(), c.end(), out.masking);
  for (int i = 1; i <= 400; ++i) {
    const double t = i / 200.0 - 1, x = (t + 1) / out.masking_scale;
    const double p = x * kernel::polynomial(out.masking, kernel::polynomial_degree, t);
    if (!(std::abs(p / (x * per_cosine(x)) - 1) < 1e-4))
      return {};
  }
  return out;
}

/// The values of a family of functions of the cosine at the nodes, reduced to few.
struct Basis {
  std::vector<std::array<double, nodes>> functions;
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

/// Greedy: the member that is reproduced worst, made orthogonal to those before it, comes next.
Basis reduce(const std::vector<Function> &family, double bend) {
  Basis out;
  std::vector<std::array<double, nodes>> rest(family.size());
  for (std::size_t b = 0; b < family.size(); ++b)
    for (std::size_t i = 0; i < nodes; ++i) {
      rest[b][i] = family[b](cosine(node(i), bend));
      out.largest = std::max(out.largest, std::abs(rest[b][i]));
    }
  const auto size_of = [](const std::array<double, nodes> &f) {
    double most = 0;
    for (const double value : f)
      most = std::max(most, std::abs(value));
    return most;
  };
  const auto product = [](const std::array<double, nodes> &f, const std::array<double, nodes> &g) {
    double sum = 0;
    for (std::size_t i = 0; i < nodes; ++i)
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
    const std::array<double, nodes> f = rest[worst];
    const double square = product(f, f);
    for (std::size_t b = 0; b < rest.size(); ++b) {
      const double c = product(rest[b], f) / square;
      out.share[b].push_back(c);
      for (std::size_t i = 0; i < nodes; ++i)
        rest[b][i] -= c * f[i];
    }
    out.functions.push_back(f);
  }
  return out;
}

/// The lowest degree that serves; empty if none does. `unit`: what an error of 1 would matter.
std::optional<backend::Profile<double>> fit_profile(const std::array<double, nodes> &value,
                                                    double unit, double bend) {
  for (std::size_t degree = 0; degree <= kernel::polynomial_degree; ++degree) {
    const Coefficients c = fit(value, degree);
    double error = 0;
    for (std::size_t i = 0; i < nodes; ++i)
      error = std::max(error, std::abs(kernel::polynomial(c.data(), degree, node(i)) - value[i]));
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

/// Relative error of a profile of a member of a family, at worst: about that of a product of two.
double fit_error(const Function &exact, const std::vector<double> &share,
                 const backend::Profile<double> *profiles) {
  double worst = 0;
  constexpr int steps = 200;
  for (int i = 1; i < steps; ++i) {
    const double t = 2.0 * i / steps - 1;
    double value = 0;
    for (std::size_t k = 0; k < share.size(); ++k)
      value += share[k] * kernel::polynomial(profiles[k].c, profiles[k].degree, t);
    const double wanted = exact(cosine(t, profiles[0].bend));
    if (wanted > 0)
      worst = std::max(worst, std::abs(value / wanted - 1));
  }
  return worst;
}

/// Diffuse light: term number t of all bands is one family of profiles. False if it does not fit.
bool fit_diffuse(const std::vector<std::vector<Surface::SeparableDiffuse>> &bands, double width,
                 SurfaceFit &out) {
  const double bend = std::min(bend_in_widths * width, bend_max);
  out.light.assign(bands.size(), {});
  const std::size_t terms = bands.front().size();
  for (std::size_t t = 0; t < terms; ++t) {
    std::vector<Function> family;
    for (const auto &band : bands)
      family.push_back(band[t].profile);
    const Basis basis = reduce(family, bend);
    const auto first = static_cast<std::uint32_t>(out.profiles.size());
    for (std::size_t k = 0; k < basis.functions.size(); ++k) {
      const auto profile = fit_profile(basis.functions[k], basis.largest / basis.weight(k), bend);
      if (!profile)
        return false;
      out.profiles.push_back(*profile);
    }
    for (std::uint32_t i = 0; i < basis.functions.size(); ++i)
      for (std::uint32_t j = i; j < basis.functions.size(); ++j) {
        out.products.push_back({first + i, first + j});
        for (std::size_t b = 0; b < bands.size(); ++b)
          out.light[b].push_back(
              {bands[b][t].factor * basis.share[b][i] * basis.share[b][j] * (i == j ? 1 : 2),
               bands[b][t].is_single_bounce});
      }
    for (std::size_t b = 0; b < bands.size(); ++b)
      out.diffuse_error = std::max(
          out.diffuse_error, fit_error(family[b], basis.share[b], out.profiles.data() + first));
  }
  return out.profiles.size() <= backend::profiles_max &&
         out.products.size() <= backend::products_max;
}

} // namespace

std::optional<SurfaceFit> fit_surface(const Surface &surface) {
  SurfaceFit out;
  const std::size_t bands = surface.band_count();
  std::vector<std::vector<Surface::SeparableDiffuse>> diffuse;
  bool has_lobe = false;
  for (std::size_t b = 0; b < bands; ++b) {
    auto terms = surface.separable_diffuse(b);
    if (!terms || surface.normals(b) == nullptr)
      return {};
    diffuse.push_back(std::move(*terms));
    has_lobe = has_lobe || !surface.interface(b).is_void();
  }
  if (bands == 0 || !fit_diffuse(diffuse, surface.width(), out))
    return {};
  if (!has_lobe)
    return out;
  // A polished surface is a lobe and a mirror in one.
  if (surface.material().apparent_roughness && surface.material().apparent_roughness->rms_height_nm)
    return {};
  for (std::size_t b = 0; b < (surface.is_specular_grey() ? 1 : bands); ++b) {
    const auto lobe = fit_lobe(*surface.normals(b), surface.material().shadowing);
    if (!lobe)
      return {};
    out.lobes.push_back(*lobe);
    out.widths.push_back(surface.normals(b)->width());
  }
  return out;
}

} // namespace umov
