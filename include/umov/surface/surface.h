#pragma once
// A material made ready for a set of bands: what the sum over facets needs.

#include <complex>
#include <functional>
#include <memory>
#include <optional>
#include <umov/core/vec3.h>
#include <umov/optics/band.h>
#include <umov/optics/interface.h>
#include <umov/optics/stokes.h>
#include <umov/surface/material.h>
#include <vector>

namespace umov {

/// Fresnel factors of unpolarized light at one phase angle: M00 = a, M10 = b.
struct FresnelFactors {
  double a = 0, b = 0;
};

/// One reflection by a microfacet, both bases in the scattering plane.
using FacetMueller = Mueller<ScatteringPlane, ScatteringPlane>;

/// Two directions on a surface, unit vectors in its frame, and the source's size.
struct SurfaceDirections {
  Vec3<Facet> l, v;    ///< to the source and to the observer
  double l_v = 1;      ///< l.v, which the pose knows better than the components
  double disk_rad = 0; ///< angular radius of a uniform disk around l; 0: a point
};
/// From angles: theta from the normal, phi the azimuth of the observer minus that of the source,
/// counter-clockwise about the normal; `azimuth` of the source from the direction field. [rad]
SurfaceDirections directions_from_angles(double theta_i, double theta_o, double phi,
                                         double azimuth = 0);
/// From cosines, for surfaces that do not ask on which side the observer stands.
SurfaceDirections directions_from_cosines(double n_l, double n_v, double l_v);

/// A compiled material. Copies share their tables. All functions are pure and thread safe.
/// Directions at or below the horizon give 0. Stokes vectors refer to the scattering plane; where
/// there is none (phase 0 and 180, within rounding) s is any axis, and the sum over an object
/// leaves sunlight with Q = U = 0 by definition.
class Surface {
public:
  /// Tabulates masking and, where lobes need them, albedos. BadInput where a table does not cover a
  /// band or a number is impossible.
  static Result<Surface> compile(const Material &material, const std::vector<Band> &bands);

  /// w (n.l)(n.v) = D(h) G2(l,v) / 4 [1/sr] in a band: the microfacet lobe without Fresnel. Finite
  /// everywhere; 0 at phase 180.
  [[nodiscard]] double specular(std::size_t band, const SurfaceDirections &at) const;
  /// The same for every band.
  [[nodiscard]] bool is_specular_grey() const;

  /// f M (n.l)(n.v) [1/sr] of all light that is not one reflection (body, inter-reflection, haze,
  /// measured surfaces), for the incoming light `in` per unit irradiance.
  [[nodiscard]] Stokes<ScatteringPlane> diffuse(std::size_t band, const SurfaceDirections &at,
                                                const Stokes<ScatteringPlane> &in) const;
  /// The same with `mueller(band, at.l_v)` at hand, which serves every facet of a pose.
  [[nodiscard]] Stokes<ScatteringPlane> diffuse(std::size_t band, const SurfaceDirections &at,
                                                const Stokes<ScatteringPlane> &in,
                                                const FacetMueller &reflection) const;
  /// There is any such light.
  [[nodiscard]] bool has_diffuse() const;

  /// Fresnel reflection of every contributing microfacet (incidence = half the phase angle), less
  /// what goes into haze.
  [[nodiscard]] FresnelFactors fresnel(std::size_t band, double l_v) const;
  /// The whole Mueller matrix of one reflection at that phase angle (docs/theory/microfacet.md, Eq.
  /// 2).
  [[nodiscard]] FacetMueller mueller(std::size_t band, double l_v) const;
  /// Reflection of a microfacet at a cosine of incidence, less what goes into haze.
  [[nodiscard]] MuellerEntries reflection(std::size_t band, double cosine) const;
  /// Part of the area that is not haze.
  [[nodiscard]] double clear_share() const;
  /// Mueller BRDF [1/sr] of all lobes. Grazing and back directions give zeros.
  [[nodiscard]] Mueller<ScatteringPlane, ScatteringPlane> brdf(std::size_t band,
                                                               const SurfaceDirections &at) const;
  /// Parts of M00 of the BRDF, for people.
  struct Terms {
    double specular = 0, body = 0, interreflection = 0, measured = 0, haze = 0;
  };
  /// The parts in a band, for unpolarized light.
  [[nodiscard]] Terms terms(std::size_t band, const SurfaceDirections &at) const;

  /// Directional albedo of the microfacet lobe alone, Fresnel and haze included (R(k) of
  /// docs/theory/microfacet.md, Eq. 6), towards a direction in the facet frame.
  [[nodiscard]] double specular_albedo(std::size_t band, Vec3<Facet> k) const;
  /// Directional albedo of everything, for unpolarized light.
  [[nodiscard]] double albedo(std::size_t band, Vec3<Facet> k) const;
  /// The microfacet lobe with F = 1 (white furnace).
  [[nodiscard]] double furnace_albedo(Vec3<Facet> k) const;
  /// Masking P(k) of one direction.
  [[nodiscard]] double masking(Vec3<Facet> k) const;
  /// Slope of the narrowest lobe: how finely normals must be sampled; 0 for a mirror.
  [[nodiscard]] double width() const;
  /// Angle from the normal at which the lobe falls to one half [rad].
  [[nodiscard]] double half_width_rad() const;
  /// Some part of the light needs a source with a size (a mirror).
  [[nodiscard]] bool has_mirror() const;
  /// Part of the Fresnel reflection that leaves as from a mirror, into the one direction there is,
  /// at an incidence with cosine n_k: 1 for a mirror, exp(-g) for a polished surface, else 0.
  [[nodiscard]] double mirror_part(std::size_t band, double n_k) const;
  /// The microfacet lobe depends on the azimuth about the normal.
  [[nodiscard]] bool is_anisotropic() const;
  /// What it was compiled from.
  [[nodiscard]] const Material &material() const;
  /// Both are copies of one compiled surface.
  [[nodiscard]] bool is_same(const Surface &other) const { return tables_ == other.tables_; }
  /// Number of bands it was compiled for.
  [[nodiscard]] std::size_t band_count() const;
  /// Normals of the microfacet lobe of a band; null for a measured surface.
  [[nodiscard]] const Distribution *normals(std::size_t band) const;
  /// Diffuse light that is a product: factor (n.l)(n.v) profile(n.l) profile(n.v) of the source's
  /// intensity, unpolarized, with the Q/I of one reflection, or polarized about the plane of
  /// emission: factor (n.l)(n.v) profile(n.l) polarizing(n.v) (1 - (n.v)^2) (cos, sin) of twice the
  /// angle from the scattering plane are Q and U then.
  struct SeparableDiffuse {
    double factor = 0;
    std::function<double(double)> profile; ///< valid as long as this surface lives
    bool is_single_bounce = false;
    std::function<double(double)> polarizing = {}; ///< empty: not so polarized
  };
  /// All diffuse light of a band as such products; empty if some of it is of another form.
  [[nodiscard]] std::optional<std::vector<SeparableDiffuse>>
  separable_diffuse(std::size_t band) const;
  /// The smooth interface of a band.
  [[nodiscard]] const Interface &interface(std::size_t band) const;

private:
  struct Tables;
  std::shared_ptr<const Tables> tables_;
};

} // namespace umov
