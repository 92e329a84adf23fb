#include <umov/surface/surface.h>

#include "kernel/fresnel.inl.h"
#include "kernel/microfacet.inl.h"
#include "surface/albedo.h"
#include "surface/lookup.h"
#include "surface/masking.h"

#include <cmath>
#include <fmt/format.h>
#include <umov/optics/fresnel.h>

namespace umov {
namespace {

double specular_weight(const Masking &masking, const Material &material, double n_l, double n_v,
                       double l_v, double n_h);

} // namespace

struct Surface::Tables {
  Material material;
  Masking masking;
  std::vector<std::complex<double>> eta; ///< per band
  std::vector<BodyTable> body;           ///< per band; empty without a body lobe

  explicit Tables(const Material &m) : material(m), masking(m.exponent) {}
  [[nodiscard]] SpecularWeight weight() const {
    return [this](double n_l, double n_v, double l_v, double n_h) {
      return specular_weight(masking, material, n_l, n_v, l_v, n_h);
    };
  }
};

namespace {

double half_angle_cosine(double l_v) { return std::sqrt(std::clamp((1 + l_v) / 2, 0.0, 1.0)); }

Result<double> body_reflectance(const Material &material, const Band &band) {
  const BodyLobe &body = *material.body;
  const auto segment = find_segment(body.wavelength_nm, band.wavelength.nm());
  if (!segment)
    return fail(ErrorCode::BadInput,
                fmt::format("material \"{}\": the body reflectance covers {}-{} nm; band \"{}\" "
                            "needs {} nm. Extrapolation is off.",
                            material.name, body.wavelength_nm.front(), body.wavelength_nm.back(),
                            band.name, band.wavelength.nm()));
  return (1 - segment->t) * body.reflectance[segment->low] +
         segment->t * body.reflectance[segment->high];
}

/// D G2 / 4 with the material's combination of the two maskings.
double specular_weight(const Masking &masking, const Material &material, double n_l, double n_v,
                       double l_v, double n_h) {
  if (!(n_l > 0 && n_v > 0 && n_h > 0))
    return 0;
  const double d = kernel::blinn_phong(n_h, material.exponent);
  const double p_l = masking(std::min(n_l, 1.0)), p_v = masking(std::min(n_v, 1.0));
  const auto azimuth = [&] { return kernel::cos_azimuth(n_l, n_v, l_v); };
  switch (material.shadowing) {
  case Shadowing::Ashikhmin:
    return d * kernel::ashikhmin(p_l, p_v, azimuth()) / 4;
  case Shadowing::Smith:
    return d * kernel::smith(p_l, p_v) / 4;
  case Shadowing::SmithDirectional:
    return d * kernel::smith_directional(p_l, p_v, azimuth()) / 4;
  case Shadowing::Separable:
    return d * kernel::separable(p_l, p_v) / 4;
  }
  return 0;
}

} // namespace

Result<Surface> Surface::compile(const Material &material, const std::vector<Band> &bands) {
  UMOV_TRY(check(material));
  auto tables = std::make_shared<Tables>(material);
  for (const Band &band : bands) {
    auto eta = index_at(material.index, band.wavelength);
    if (!eta)
      return fail(ErrorCode::BadInput, fmt::format("material \"{}\", band \"{}\": {}",
                                                   material.name, band.name, eta.error().message));
    tables->eta.push_back(*eta);
    if (material.body) {
      UMOV_ASSIGN(reflectance, body_reflectance(material, band));
      tables->body.emplace_back(reflectance, material.exponent, *eta, tables->weight());
    }
  }
  Surface out;
  out.tables_ = std::move(tables);
  return out;
}

double Surface::specular(double n_l, double n_v, double l_v) const {
  return specular_weight(tables_->masking, tables_->material, n_l, n_v, l_v,
                         kernel::half_cosine(n_l, n_v, l_v));
}

bool Surface::has_body() const { return !tables_->body.empty(); }

double Surface::body(std::size_t band, double n_l, double n_v) const {
  if (tables_->body.empty() || !(n_l > 0 && n_v > 0))
    return 0;
  return tables_->body[band](std::min(n_l, 1.0), std::min(n_v, 1.0));
}

FresnelFactors Surface::fresnel(std::size_t band, double l_v) const {
  const auto eta = tables_->eta[band];
  const auto f = kernel::reflection(
      kernel::fresnel(half_angle_cosine(l_v), kernel::Complex<double>{eta.real(), eta.imag()}));
  // At phase 0 and 180 (within rounding of the cosine) there is no scattering plane: no
  // polarization by definition.
  const bool has_plane = std::abs(l_v) < 1 - 1e-15;
  return {f.a, has_plane ? f.b : 0};
}

Mueller<ScatteringPlane, ScatteringPlane> Surface::mueller(std::size_t band, double l_v) const {
  return fresnel_mueller(half_angle_cosine(l_v), tables_->eta[band]);
}

Mueller<ScatteringPlane, ScatteringPlane> Surface::brdf(std::size_t band, double n_l, double n_v,
                                                        double l_v) const {
  if (!(n_l > 0 && n_v > 0))
    return {};
  // Divided one by one: the product of two denormal cosines would underflow.
  const double w = specular(n_l, n_v, l_v) / n_l / n_v;
  auto out = mueller(band, l_v);
  for (auto &row : out.m)
    for (double &entry : row)
      entry *= w;
  out.m[0][0] += body(band, n_l, n_v) / n_l / n_v;
  return out;
}

double Surface::specular_albedo(std::size_t band, double n_k) const {
  return directional_albedo(n_k, tables_->material.exponent, &tables_->eta[band],
                            tables_->weight());
}

double Surface::furnace_albedo(double n_k) const {
  return directional_albedo(n_k, tables_->material.exponent, nullptr, tables_->weight());
}

double Surface::masking(double n_k) const { return tables_->masking(n_k); }
const Material &Surface::material() const { return tables_->material; }
std::size_t Surface::band_count() const { return tables_->eta.size(); }

} // namespace umov
