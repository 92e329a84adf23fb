#pragma once
// What a surface is made of, as the user names it.

#include <memory>
#include <optional>
#include <string>
#include <umov/core/quantity.h>
#include <umov/core/result.h>
#include <umov/core/vec3.h>
#include <umov/kernel/lobe.h>
#include <umov/optics/index.h>
#include <umov/surface/distribution.h>
#include <umov/surface/measured.h>
#include <vector>

namespace umov {

/// Light that meets several microfacets before it leaves.
enum class Interreflection {
  None,
  Unpolarized,  ///< Kulla & Conty 2017: diffuse, depolarized
  SingleBounceQ ///< the same light with the Q/I of one reflection
};

/// Light scattered below the surface: reflectance R_sub. Unpolarized: the paper's lobe (eq. 16).
/// Polarized: it leaves through the smooth interface (Baek et al. 2018).
struct BodyLobe {
  Tabulated reflectance{{}, {0}}; ///< 0..1
  bool is_polarized = false;
  bool operator==(const BodyLobe &) const = default;
};

/// The floor under every lobe: scratches, dust, edges, wires. A part of the area reflects like a
/// Lambert surface of the interface's mean reflectance, or white (docs/theory/lobes.md, Eq. 14).
struct Haze {
  double share = 0;          ///< of the area; of a white one that is its albedo
  bool is_white = false;     ///< reflects everything, whatever the interface does
  bool is_polarized = false; ///< with the Q/I of one reflection
  double low = 0, high = 0;  ///< what the share may be; both 0: not said
  bool operator==(const Haze &) const = default;
};

/// A film or layer on the substrate.
struct Layer {
  IndexTable index;
  double thickness_nm = 0;
  bool is_coherent = true; ///< false: thick against the coherence length of the light
  bool operator==(const Layer &) const = default;
};

/// How the lobe changes with wavelength. Self-affine (the paper's Fig. 13): slopes go with
/// (reference/wavelength)^((1 - hurst)/hurst). Polished: a part exp(-g) of the light meets the
/// surface as a mirror, g = (2 pi height (cos i + cos o)/wavelength)^2 (He et al. 1991).
struct ApparentRoughness {
  std::optional<double> hurst; ///< 0.5..1
  double reference_nm = 550;
  std::optional<double> rms_height_nm;
  bool operator==(const ApparentRoughness &) const = default;
};

/// What a material does to the polarization of sunlight.
struct Material {
  std::string name;
  IndexTable index = constant_index(1.5);
  std::vector<Layer> layers; ///< first on top
  DistributionChoice distribution;
  /// Direction field of an anisotropic distribution: a body axis, or the texture's first
  /// coordinate.
  std::optional<Vec3<Body>> direction;
  Shadowing shadowing = Shadowing::Ashikhmin;
  Interreflection interreflection = Interreflection::None;
  std::optional<BodyLobe> body; ///< absent: none
  std::optional<Haze> haze;     ///< absent: none
  std::optional<ApparentRoughness> apparent_roughness;
  std::shared_ptr<const MeasuredBrdf> measured; ///< instead of all of the above
  std::string measured_file;
  std::vector<std::string> remarks;         ///< what an output should say of it
  std::string description, source, assumed; ///< for people: what, from where, what is not known
  bool operator==(const Material &) const = default;
};

/// Checks numbers and lists. BadInput says what was found and expected.
Result<void> check_material(const Material &material);

/// "polarizes", "depolarizes" and how, in a few words, for `umov material list`.
std::string describe_polarization(const Material &material);

/// Wavelengths that every table of the material covers.
WavelengthRange range_of(const Material &material);

/// Table 1 of the paper: paper_au, paper_al, paper_bk7, paper_asi, paper_spectralon, paper_mylar,
/// with m = 200, ashikhmin shadowing and the paper's body lobe (product decisions).
std::vector<std::string> builtin_material_names();
/// BadInput, with the nearest name, if there is none of that name.
Result<Material> builtin_material(const std::string &name);
/// The refractive index of a built-in table by name (the same six names).
Result<IndexTable> builtin_index(const std::string &name);

} // namespace umov
