#include "surface/albedo.h"

#include "kernel/gauss.h"
#include "kernel/microfacet.inl.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <umov/core/quantity.h>

namespace umov {
namespace {

/// Even, for Simpson's rule; equal steps of sqrt(n.k) because R bends near grazing.
constexpr std::size_t cells = 96;
/// Lobes wider than this (m = 20) are integrated over directions, narrower ones over normals.
constexpr double wide_lobe = 0.2132;

double reflectance(const FacetReflectance &facet, double cosine) {
  return facet ? facet(cosine) : 1;
}

/// Over directions of the observer, for wide lobes: the kink of min(P(l), P(v)) lies at n.v = n.l,
/// and panels that grow away from the mirror direction follow the peak at grazing incidence.
double albedo_over_directions(double n_l, const MicrofacetLobe &lobe,
                              const FacetReflectance &facet) {
  const double s_l = std::sqrt((1 - n_l) * (1 + n_l));
  const auto at = [&](double n_v, double phi) {
    const double l_v = n_l * n_v - s_l * std::sqrt((1 - n_v) * (1 + n_v)) * std::cos(phi);
    return lobe.isotropic(n_l, n_v, l_v, kernel::half_cosine(n_l, n_v, l_v)) *
           reflectance(facet, std::sqrt(std::max(0.0, (1 + l_v) / 2)));
  };
  const auto over_azimuth = [&](double n_v) { // phi counts from the forward direction
    double sum = 0, from = 0;
    for (double to = std::max(n_l, 1e-3); from < pi; to *= 5) {
      sum += gauss_integral<20>(from, std::min(to, pi), [&](double phi) { return at(n_v, phi); });
      from = to;
    }
    return 2 * sum;
  };
  double sum = 0, from = 0;
  for (double to = n_l; from < 1; to *= 5) {
    sum += gauss_integral<20>(from, std::min(to, 1.0), over_azimuth);
    from = to;
  }
  return sum / n_l;
}

/// Over microfacet normals, dw_v = 4 (h.l) dw_h, for narrow lobes: as smooth as D.
double albedo_over_normals(double n_l, const MicrofacetLobe &lobe, const FacetReflectance &facet) {
  const double sine = std::sqrt((1 - n_l) * (1 + n_l));
  const double last = std::min(pi / 2, lobe.normals().reach_rad());
  const auto over_azimuth = [&](double theta) {
    const double c = std::cos(theta), s = std::sin(theta);
    const auto term = [&](double phi) {
      const double h_l = c * n_l + s * sine * std::cos(phi);
      const double n_v = 2 * h_l * c - n_l;
      if (h_l <= 0 || n_v <= 0)
        return 0.0;
      const double l_v = std::min(1.0, 2 * h_l * h_l - 1);
      return lobe.isotropic(n_l, n_v, l_v, c) * 4 * h_l * reflectance(facet, h_l);
    };
    // n.v > 0 needs cos(phi) above a limit: integrate up to it, not across the cut.
    const double limit = s * sine > 0 ? (n_l / (2 * c) - c * n_l) / (s * sine) : -1;
    const double end = std::acos(std::clamp(limit, -1.0, 1.0));
    return 2 * s * gauss_integral(0, end, term);
  };
  // Panels that grow with the angle: long tails (GGX) fall by powers.
  const auto panels = [&](double from, double to, const auto &f) {
    double sum = 0;
    double step = 9 * lobe.normals().width();
    while (from < to) {
      const double end = std::min(to, from + step);
      sum += gauss_integral(from, end, f);
      from = end;
      step *= 4;
    }
    return sum;
  };
  // The cut begins where the mirrored direction reaches the horizon.
  const double kink = std::min(last, (pi / 2 - std::acos(n_l)) / 2);
  double sum = panels(0, kink, over_azimuth);
  if (last > kink) {
    const double first = std::min(last, kink + 9 * lobe.normals().width());
    sum += gauss_integral(0, std::sqrt(first - kink),
                          [&](double t) { return 2 * t * over_azimuth(kink + t * t); });
    sum += panels(first, last, over_azimuth);
  }
  return sum / n_l;
}

} // namespace

double directional_albedo(double n_k, const MicrofacetLobe &lobe, const FacetReflectance &facet) {
  const double n_l = std::clamp(n_k, 1e-6, 1.0); // the limit at grazing is reached long before
  if (lobe.normals().is_mirror())
    return reflectance(facet, n_l);
  return lobe.normals().width() > wide_lobe ? albedo_over_directions(n_l, lobe, facet)
                                            : albedo_over_normals(n_l, lobe, facet);
}

double directional_albedo(Vec3<Facet> k, const MicrofacetLobe &lobe,
                          const FacetReflectance &facet) {
  if (lobe.normals().is_isotropic())
    return directional_albedo(k.z, lobe, facet);
  constexpr int azimuths = 512;
  const double last = std::min(pi / 2, lobe.normals().reach_rad());
  double sum = 0;
  for (int i = 0; i < azimuths; ++i) {
    const double phi = 2 * pi * (i + 0.5) / azimuths, c_phi = std::cos(phi), s_phi = std::sin(phi);
    sum += gauss_integral(0, last, [&](double theta) {
      const double s = std::sin(theta);
      const Vec3<Facet> h{s * c_phi, s * s_phi, std::cos(theta)};
      const double h_l = dot(h, k);
      const Vec3<Facet> v = 2 * h_l * h - k;
      if (h_l <= 0 || v.z <= 0)
        return 0.0;
      return s * lobe(k, v, std::min(1.0, 2 * h_l * h_l - 1), 0) * 4 * h_l *
             reflectance(facet, h_l);
    });
  }
  return sum * 2 * pi / azimuths / std::max(k.z, 1e-6);
}

AlbedoTable::AlbedoTable(const MicrofacetLobe &lobe, const FacetReflectance &facet,
                         const FacetReflectance &more) {
  for (std::size_t i = 0; i <= cells; ++i) {
    const double root = static_cast<double>(i) / cells;
    values_.push_back(directional_albedo(root * root, lobe, facet) +
                      (more ? more(root * root) : 0));
    const double simpson = i == 0 || i == cells ? 1 : i % 2 == 1 ? 4 : 2;
    mean_ += simpson * values_.back() * 4 * root * root * root / (3.0 * cells); // 2 R mu dmu
  }
}

double AlbedoTable::operator()(double n_k) const {
  if (values_.empty())
    return 0;
  const double x = std::sqrt(n_k) * cells;
  const auto i = std::clamp<std::size_t>(static_cast<std::size_t>(x), 1, cells - 2);
  return kernel::cubic(&values_[i - 1], x - static_cast<double>(i));
}

} // namespace umov
