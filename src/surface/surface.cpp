#include <umov/surface/surface.h>

#include "surface/body_lobe.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace umov {
namespace {

double half_angle_cosine(double l_v) { return std::sqrt(std::clamp((1 + l_v) / 2, 0.0, 1.0)); }

/// What one band of a compiled material holds.
struct BandTables {
  Interface interface { 1.0 };
  std::size_t lobe = 0; ///< into Tables::lobes
  std::optional<BodyLight> body;
  std::optional<Interreflected> interreflected;
  double wavelength_nm = 0;
  double haze_albedo = 0; ///< what haze reflects of all light
};

/// Where a table is asked for a band: within a curve one that holds its ends no further than there.
Wavelength asked_at(const IndexTable &table, const Band &band) {
  if (!table.holds_ends || !band.curve)
    return band.wavelength;
  const WavelengthRange range = range_of(table);
  return Wavelength::nm(std::clamp(band.wavelength.nm(), range.first_nm, range.last_nm));
}

Result<Interface> make_interface(const Material &material, const Band &band) {
  const auto named = [&](const Error &error) {
    return fail(ErrorCode::BadInput, fmt::format("material \"{}\", band \"{}\": {}", material.name,
                                                 band.name, error.message));
  };
  const auto eta = index_at(material.index, asked_at(material.index, band));
  if (!eta)
    return named(eta.error());
  if (material.layers.empty())
    return Interface(*eta);
  std::vector<OpticalLayer> layers;
  for (const Layer &layer : material.layers) {
    const auto film = index_at(layer.index, asked_at(layer.index, band));
    if (!film)
      return named(film.error());
    layers.push_back({*film, layer.thickness_nm, layer.is_coherent});
  }
  return Interface(*eta, std::move(layers), band.wavelength);
}

/// Slopes seen at a wavelength over those at the reference (lobes.md, Eq. 10).
double slope_factor(const Material &material, Wavelength wavelength) {
  if (!material.apparent_roughness || !material.apparent_roughness->hurst)
    return 1;
  const double h = *material.apparent_roughness->hurst;
  return std::pow(material.apparent_roughness->reference_nm / wavelength.nm(), (1 - h) / h);
}

} // namespace

struct Surface::Tables {
  Material material;
  std::vector<MicrofacetLobe> lobes;                       ///< one, or one per band
  std::vector<std::shared_ptr<const AlbedoTable>> furnace; ///< per lobe, where needed
  std::optional<MicrofacetLobe> mirror;                    ///< of a polished surface
  std::vector<BandTables> bands;
  bool has_diffuse = false;
  double clear_share = 1; ///< of the area, the rest being haze

  /// Part of the light that meets a polished surface as a mirror (lobes.md, Eq. 11).
  [[nodiscard]] double mirror_share(const BandTables &band, double n_l, double n_v) const {
    if (!mirror)
      return 0;
    const double root =
        2 * pi * *material.apparent_roughness->rms_height_nm * (n_l + n_v) / band.wavelength_nm;
    return std::exp(-root * root);
  }
};

namespace {

FacetReflectance reflectance_of(const Interface &interface) {
  return [&interface](double cosine) { return interface.reflection(std::min(cosine, 1.0)).a; };
}

/// Light from below the surface, if the material has any. `out` must stay where it is.
Result<void> add_body(const Material &material, const Band &band, const MicrofacetLobe &lobe,
                      BandTables &out) {
  if (!material.body)
    return {};
  const auto reflectance =
      value_at(material.body->reflectance, band.wavelength, "the body reflectance");
  if (!reflectance)
    return fail(ErrorCode::BadInput, fmt::format("material \"{}\", band \"{}\": {}", material.name,
                                                 band.name, reflectance.error().message));
  if (material.body->is_polarized)
    out.body.emplace(*reflectance, out.interface);
  else if (out.interface.is_void())
    out.body.emplace(*reflectance, AlbedoTable()); // exactly R_sub / pi
  else
    out.body.emplace(*reflectance,
                     AlbedoTable(lobe, reflectance_of(out.interface),
                                 out.interreflected ? FacetReflectance([&out](double n_k) {
                                   return out.interreflected->albedo(n_k);
                                 })
                                                    : FacetReflectance{}));
  return {};
}

} // namespace

Result<Surface> Surface::compile(const Material &material, const std::vector<Band> &bands) {
  UMOV_TRY(check_material(material));
  auto tables = std::make_shared<Tables>();
  tables->material = material;
  if (material.measured) {
    for (const Band &band : bands) {
      if (band.wavelength.nm() < material.measured->first_nm() ||
          band.wavelength.nm() > material.measured->last_nm())
        return fail(ErrorCode::BadInput,
                    fmt::format("material \"{}\" was measured at {:g}-{:g} nm; band \"{}\" needs "
                                "{:g} nm. Extrapolation is off.",
                                material.name, material.measured->first_nm(),
                                material.measured->last_nm(), band.name, band.wavelength.nm()));
      tables->bands.push_back({});
      tables->bands.back().wavelength_nm = band.wavelength.nm();
    }
    tables->has_diffuse = true;
    Surface out;
    out.tables_ = std::move(tables);
    return out;
  }
  UMOV_ASSIGN(normals, make_distribution(material.distribution));
  const bool is_grey = !material.apparent_roughness || !material.apparent_roughness->hurst;
  if (material.apparent_roughness && material.apparent_roughness->rms_height_nm) {
    UMOV_ASSIGN(mirror, make_distribution({"mirror", {}, {}, {}}));
    tables->mirror.emplace(mirror, material.shadowing);
  }
  tables->bands.reserve(bands.size()); // callbacks below point into it
  for (const Band &band : bands) {
    UMOV_ASSIGN(interface, make_interface(material, band));
    BandTables &out = tables->bands.emplace_back();
    out.interface = std::move(interface);
    out.wavelength_nm = band.wavelength.nm();
    if (!is_grey)
      tables->lobes.emplace_back(normals->scaled(slope_factor(material, band.wavelength)),
                                 material.shadowing);
    else if (tables->lobes.empty())
      tables->lobes.emplace_back(normals, material.shadowing);
    out.lobe = tables->lobes.size() - 1;
    if (material.haze)
      out.haze_albedo =
          material.haze->share * (material.haze->is_white ? 1 : out.interface.mean_reflectance());
    const MicrofacetLobe &lobe = tables->lobes.back();
    if (material.interreflection != Interreflection::None) {
      if (tables->furnace.size() < tables->lobes.size())
        tables->furnace.push_back(std::make_shared<AlbedoTable>(lobe, FacetReflectance{}));
      out.interreflected.emplace(tables->furnace.back(), out.interface.mean_reflectance());
    }
    UMOV_TRY(add_body(material, band, lobe, out));
  }
  tables->clear_share = material.haze ? 1 - material.haze->share : 1;
  tables->has_diffuse =
      material.body || material.haze || material.interreflection != Interreflection::None;
  Surface out;
  out.tables_ = std::move(tables);
  return out;
}

double Surface::specular(std::size_t band, const SurfaceDirections &at) const {
  if (tables_->lobes.empty())
    return 0;
  const BandTables &own = tables_->bands[band];
  const double facets = tables_->lobes[own.lobe](at.l, at.v, at.l_v, at.disk_rad);
  if (!tables_->mirror)
    return facets;
  const double share = tables_->mirror_share(own, at.l.z, at.v.z);
  return (1 - share) * facets + share * (*tables_->mirror)(at.l, at.v, at.l_v, at.disk_rad);
}

bool Surface::is_specular_grey() const { return tables_->lobes.size() < 2 && !tables_->mirror; }

bool Surface::has_diffuse() const { return tables_->has_diffuse; }

Stokes<ScatteringPlane> Surface::diffuse(std::size_t band, const SurfaceDirections &at,
                                         const Stokes<ScatteringPlane> &in) const {
  const Material &material = tables_->material;
  const bool is_as_reflected = (material.haze && material.haze->is_polarized) ||
                               material.interreflection == Interreflection::SingleBounceQ;
  return diffuse(band, at, in, is_as_reflected ? mueller(band, at.l_v) : FacetMueller{});
}

Stokes<ScatteringPlane> Surface::diffuse(std::size_t band, const SurfaceDirections &at,
                                         const Stokes<ScatteringPlane> &in,
                                         const FacetMueller &reflection) const {
  if (!tables_->has_diffuse || !(at.l.z > 0 && at.v.z > 0))
    return {};
  const BandTables &own = tables_->bands[band];
  Stokes<ScatteringPlane> out;
  if (tables_->material.measured) {
    const double azimuth = std::atan2(at.v.y, at.v.x) - std::atan2(at.l.y, at.l.x);
    const auto m =
        (*tables_->material.measured)(own.wavelength_nm, std::acos(std::min(at.l.z, 1.0)),
                                      std::acos(std::min(at.v.z, 1.0)), azimuth);
    const double scale = at.l.z * at.v.z;
    Mueller<ScatteringPlane, ScatteringPlane> matrix;
    for (std::size_t k = 0; k < 16; ++k)
      matrix.m[k / 4][k % 4] = scale * m[k];
    out = matrix * in;
  }
  if (own.body)
    out += (*own.body)(at, in);
  if (own.interreflected) {
    const double value = (*own.interreflected)(at.l.z, at.v.z);
    if (tables_->material.interreflection == Interreflection::SingleBounceQ) {
      const double r = reflection.m[0][0];
      out += (reflection * in) * (r > 0 ? value / r : 0);
    } else {
      out += Stokes<ScatteringPlane>{value * in.i, 0, 0, 0};
    }
  }
  if (!(own.haze_albedo > 0))
    return out;
  const double haze = own.haze_albedo / pi * at.l.z * at.v.z, r = reflection.m[0][0];
  out = out * tables_->clear_share;
  if (tables_->material.haze->is_polarized && r > 0)
    out += (reflection * in) * (haze / r);
  else
    out += Stokes<ScatteringPlane>{haze * in.i, 0, 0, 0};
  return out;
}

MuellerEntries Surface::reflection(std::size_t band, double cosine) const {
  MuellerEntries out = tables_->bands[band].interface.reflection(cosine);
  out.a *= tables_->clear_share;
  out.b *= tables_->clear_share;
  out.z *= tables_->clear_share;
  return out;
}

double Surface::clear_share() const { return tables_->clear_share; }

FresnelFactors Surface::fresnel(std::size_t band, double l_v) const {
  const MuellerEntries f = reflection(band, half_angle_cosine(l_v));
  return {f.a, f.b};
}

FacetMueller Surface::mueller(std::size_t band, double l_v) const {
  return reflection(band, half_angle_cosine(l_v)).matrix();
}

Mueller<ScatteringPlane, ScatteringPlane> Surface::brdf(std::size_t band,
                                                        const SurfaceDirections &at) const {
  const double n_l = at.l.z, n_v = at.v.z;
  if (!(n_l > 0 && n_v > 0))
    return {};
  // Divided one by one: the product of two denormal cosines would underflow.
  const double w = specular(band, at) / n_l / n_v;
  auto out = mueller(band, at.l_v);
  for (auto &row : out.m)
    for (double &entry : row)
      entry *= w;
  for (std::size_t c = 0; c < 4 && tables_->has_diffuse; ++c) {
    const Stokes<ScatteringPlane> in{c == 0 ? 1.0 : 0, c == 1 ? 1.0 : 0, c == 2 ? 1.0 : 0,
                                     c == 3 ? 1.0 : 0};
    const auto s = diffuse(band, at, in);
    const double column[4] = {s.i, s.q, s.u, s.v};
    for (std::size_t r = 0; r < 4; ++r)
      out.m[r][c] += column[r] / n_l / n_v;
  }
  return out;
}

Surface::Terms Surface::terms(std::size_t band, const SurfaceDirections &at) const {
  Terms out;
  const double n_l = at.l.z, n_v = at.v.z;
  if (!(n_l > 0 && n_v > 0))
    return out;
  const BandTables &own = tables_->bands[band];
  const Stokes<ScatteringPlane> sunlight{1, 0, 0, 0};
  out.specular = specular(band, at) / n_l / n_v * fresnel(band, at.l_v).a;
  if (own.body)
    out.body = tables_->clear_share * (*own.body)(at, sunlight).i / n_l / n_v;
  if (own.interreflected)
    out.interreflection = tables_->clear_share * (*own.interreflected)(n_l, n_v) / n_l / n_v;
  out.haze = own.haze_albedo / pi;
  if (tables_->material.measured)
    out.measured = diffuse(band, at, sunlight).i / n_l / n_v;
  return out;
}

double Surface::specular_albedo(std::size_t band, Vec3<Facet> k) const {
  if (tables_->lobes.empty())
    return 0;
  const BandTables &own = tables_->bands[band];
  const auto facet = reflectance_of(own.interface);
  const double facets = directional_albedo(k, tables_->lobes[own.lobe], facet);
  const double share = tables_->mirror_share(own, k.z, k.z);
  return tables_->clear_share * ((1 - share) * facets + share * facet(k.z));
}

double Surface::albedo(std::size_t band, Vec3<Facet> k) const {
  if (tables_->material.measured)
    return tables_->material.measured->albedo(tables_->bands[band].wavelength_nm,
                                              std::acos(std::clamp(k.z, 0.0, 1.0)));
  const BandTables &own = tables_->bands[band];
  double below = 0;
  if (own.interreflected)
    below += own.interreflected->albedo(k.z);
  if (own.body)
    below += own.body->albedo(k.z);
  return specular_albedo(band, k) + tables_->clear_share * below + own.haze_albedo;
}

double Surface::furnace_albedo(Vec3<Facet> k) const {
  return tables_->lobes.empty() ? 0 : directional_albedo(k, tables_->lobes.front(), {});
}

double Surface::masking(Vec3<Facet> k) const {
  return tables_->lobes.empty() ? 1 : tables_->lobes.front().normals().masking(k);
}

double Surface::width() const {
  if (tables_->mirror)
    return 0;
  double narrowest = 1;
  for (const MicrofacetLobe &lobe : tables_->lobes)
    narrowest = std::min(narrowest, lobe.normals().width());
  return narrowest;
}

double Surface::half_width_rad() const {
  return tables_->mirror          ? 0
         : tables_->lobes.empty() ? pi / 2
                                  : tables_->lobes.front().normals().half_width_rad();
}

bool Surface::has_mirror() const {
  return tables_->mirror ||
         (!tables_->lobes.empty() && tables_->lobes.front().normals().is_mirror());
}

double Surface::mirror_part(std::size_t band, double n_k) const {
  if (tables_->mirror)
    return tables_->mirror_share(tables_->bands[band], n_k, n_k);
  return has_mirror() ? 1 : 0;
}

bool Surface::is_anisotropic() const {
  return !tables_->lobes.empty() && !tables_->lobes.front().normals().is_isotropic();
}

const Material &Surface::material() const { return tables_->material; }

const Distribution *Surface::normals(std::size_t band) const {
  return tables_->lobes.empty() ? nullptr : &tables_->lobes[tables_->bands[band].lobe].normals();
}

std::optional<std::vector<Surface::SeparableDiffuse>>
Surface::separable_diffuse(std::size_t band) const {
  const BandTables &own = tables_->bands[band];
  if (tables_->material.measured)
    return {};
  std::vector<SeparableDiffuse> out;
  if (own.body) {
    out.push_back({tables_->clear_share * own.body->factor(),
                   [&own](double n_k) { return own.body->entering(n_k); }});
    if (own.body->is_polarized())
      out.back().polarizing = [&own](double n_k) { return own.body->polarizing(n_k); };
  }
  if (own.interreflected)
    out.push_back({tables_->clear_share * own.interreflected->factor(),
                   [&own](double n_k) { return own.interreflected->lost(n_k); },
                   tables_->material.interreflection == Interreflection::SingleBounceQ});
  if (own.haze_albedo > 0)
    out.push_back(
        {own.haze_albedo / pi, [](double) { return 1.0; }, tables_->material.haze->is_polarized});
  return out;
}

std::size_t Surface::band_count() const { return tables_->bands.size(); }
const Interface &Surface::interface(std::size_t band) const {
  return tables_->bands[band].interface;
}

SurfaceDirections directions_from_angles(double theta_i, double theta_o, double phi,
                                         double azimuth) {
  const auto sine = [](double theta) { return theta == pi / 2 ? 1 : std::sin(theta); };
  const auto cosine = [](double theta) { // exact at the horizon, where cos(pi/2) is not
    return theta == pi / 2 ? 0 : std::cos(theta);
  };
  SurfaceDirections out;
  const double s_i = sine(theta_i), c_i = cosine(theta_i), s_o = sine(theta_o),
               c_o = cosine(theta_o);
  out.l = {s_i * std::cos(azimuth), s_i * std::sin(azimuth), c_i};
  out.v = {s_o * std::cos(azimuth + phi), s_o * std::sin(azimuth + phi), c_o};
  out.l_v = std::clamp(c_i * c_o + s_i * s_o * std::cos(phi), -1.0, 1.0);
  return out;
}

SurfaceDirections directions_from_cosines(double n_l, double n_v, double l_v) {
  const double s_l = std::sqrt(std::max(0.0, (1 - n_l) * (1 + n_l)));
  SurfaceDirections out;
  out.l = {s_l, 0, n_l};
  const double s_v2 = std::max(0.0, (1 - n_v) * (1 + n_v));
  const double x = s_l > 1e-12 ? std::clamp((l_v - n_l * n_v) / s_l, -1.0, 1.0) : std::sqrt(s_v2);
  out.v = {x, std::sqrt(std::max(0.0, s_v2 - x * x)), n_v};
  out.l_v = l_v;
  return out;
}

} // namespace umov
