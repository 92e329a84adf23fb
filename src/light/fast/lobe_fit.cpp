#include "light/fast/lobe_fit.h"

#include "kernel/facet.inl.h"
#include "light/fast/chebyshev.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace umov {
namespace {

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

} // namespace

std::optional<kernel::LobeConstants<double>> fit_lobe(const Distribution &normals,
                                                      Shadowing shadowing) {
  const auto form = normals.kernel_form();
  if (!form)
    return {};
  kernel::LobeConstants<double> out;
  out.kind = form->kind;
  out.joint = shadowing;
  out.shape = form->shape;
  out.per_width2 = 1 / (normals.width() * normals.width());
  if (out.kind == LobeKind::BlinnPhong)
    out.peak = kernel::blinn_phong_peak(form->shape);
  if (out.kind == LobeKind::Ggx)
    return out; // its masking is closed
  out.masking_limit = masking_limit(normals);
  out.masking_scale = 2 / out.masking_limit;
  const auto per_cosine = [&](double c) {
    return normals.masking({std::sqrt(std::max(0.0, 1 - c * c)), 0, c}) / c;
  };
  NodeValues value{};
  for (std::size_t i = 0; i < chebyshev_nodes; ++i)
    value[i] = per_cosine((chebyshev_node(i) + 1) / out.masking_scale);
  const Coefficients c = fit_polynomial(value, kernel::polynomial_degree);
  std::copy(c.begin(), c.end(), out.masking);
  for (int i = 1; i <= 400; ++i) {
    const double t = i / 200.0 - 1, x = (t + 1) / out.masking_scale;
    const double p = x * kernel::polynomial(out.masking, kernel::polynomial_degree, t);
    if (!(std::abs(p / (x * per_cosine(x)) - 1) < 1e-4))
      return {};
  }
  return out;
}

namespace {

/// Weights of Lagrange's polynomial through `nodes` at x, over 4: the factor of G2 in the BRDF.
void put_lagrange(const std::vector<double> &nodes, double x, double *out) {
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    out[i] = 0.25;
    for (std::size_t j = 0; j < nodes.size(); ++j)
      if (j != i)
        out[i] *= (x - nodes[j]) / (nodes[i] - nodes[j]);
  }
}

/// Largest relative error of the interpolated shadowing of one lobe.
double family_error(const backend::LobeFamily<double> &family, std::size_t lobe,
                    const kernel::LobeConstants<double> &exact) {
  double worst = 0;
  constexpr int cosines = 24;
  kernel::FacetPose<double> pose;
  for (int i = 1; i <= cosines; ++i)
    for (int j = 1; j <= i; ++j)
      for (const double cos_azimuth : {-1.0, 0.0, 0.9}) {
        // Denser towards grazing.
        const double n_l = std::pow(i / double(cosines), 2), n_v = std::pow(j / double(cosines), 2);
        pose.cos_phase = n_l * n_v + cos_azimuth * std::sqrt((1 - n_l * n_l) * (1 - n_v * n_v));
        double sum = 0;
        for (std::size_t n = 0; n < family.node_count; ++n)
          sum +=
              4 * family.weight[lobe][n] * kernel::lobe_shadowing(family.node[n], pose, n_l, n_v);
        worst = std::max(worst, std::abs(sum / kernel::lobe_shadowing(exact, pose, n_l, n_v) - 1));
      }
  return worst;
}

} // namespace

std::optional<backend::LobeFamily<double>>
fit_family(const std::vector<kernel::LobeConstants<double>> &lobes, Shadowing shadowing) {
  constexpr double tolerance = 1e-4;
  if (lobes.size() < 3 || lobes.size() > backend::family_lobes_max)
    return {};
  double low = HUGE_VAL, high = 0;
  for (const auto &lobe : lobes) {
    if (lobe.kind != LobeKind::BlinnPhong || !(lobe.shape > 0))
      return {};
    low = std::min(low, lobe.shape);
    high = std::max(high, lobe.shape);
  }
  for (std::uint32_t count = 2; count <= backend::family_nodes_max; ++count) {
    backend::LobeFamily<double> out;
    out.node_count = count;
    std::vector<double> nodes;
    for (std::uint32_t n = 0; n < count; ++n) {
      const double t = 0.5 - 0.5 * std::cos(std::numbers::pi * (n + 0.5) / count);
      nodes.push_back(std::log(low) + t * std::log(high / low));
      const auto normals = make_distribution(blinn_phong(std::exp(nodes.back())));
      const auto lobe = normals ? fit_lobe(**normals, shadowing) : std::nullopt;
      if (!lobe)
        return {};
      out.node[n] = *lobe;
    }
    double error = high > low ? 0 : HUGE_VAL;
    for (std::size_t k = 0; k < lobes.size(); ++k) {
      put_lagrange(nodes, std::log(lobes[k].shape), out.weight[k]);
      error = std::max(error, family_error(out, k, lobes[k]));
    }
    if (error <= tolerance)
      return out;
  }
  return {};
}

} // namespace umov
