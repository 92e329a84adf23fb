#include <umov/surface/material.h>

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>

namespace umov {
namespace {

tl::unexpected<Error> problem(const Material &material, const std::string &text) {
  return fail(ErrorCode::BadInput, "material \"" + material.name + "\": " + text);
}

Result<void> named(const Material &material, const Result<void> &done, const std::string &part) {
  if (done)
    return {};
  return problem(material,
                 part.empty() ? done.error().message : part + ": " + done.error().message);
}

Result<void> check_body(const Material &material) {
  if (!material.body)
    return {};
  UMOV_TRY(
      named(material, check_tabulated(material.body->reflectance, "the body reflectance"), ""));
  for (const double r : material.body->reflectance.value)
    if (!(r >= 0 && r <= 1))
      return problem(material, fmt::format("body reflectance {}; 0 to 1 was expected", r));
  return {};
}

Result<void> check_haze(const Material &material) {
  if (!material.haze)
    return {};
  const Haze &haze = *material.haze;
  if (!(haze.share >= 0 && haze.share <= 1))
    return problem(material, fmt::format("haze {:g}; 0 to 1 was expected", haze.share));
  const bool is_known = haze.high > 0;
  if (is_known &&
      !(haze.low >= 0 && haze.low <= haze.share && haze.share <= haze.high && haze.high <= 1))
    return problem(material, fmt::format("haze {:g} is not in its range {:g} to {:g}", haze.share,
                                         haze.low, haze.high));
  if (haze.is_white && haze.is_polarized)
    return problem(material,
                   "white haze depolarizes; leave polarized out or give share, not albedo");
  return {};
}

Result<void> check_layers(const Material &material) {
  for (const Layer &layer : material.layers) {
    UMOV_TRY(named(material, check_index(layer.index), "layer " + layer.index.name));
    if (!(layer.thickness_nm >= 0 && layer.thickness_nm <= 1e9))
      return problem(material, fmt::format("layer {}: thickness {:g} nm; 0 to 1e9 was expected",
                                           layer.index.name, layer.thickness_nm));
    if (layer.is_coherent && layer.thickness_nm > 1e5)
      return problem(
          material, fmt::format("layer {}: {:g} nm is too thick to interfere; say coherent = false",
                                layer.index.name, layer.thickness_nm));
  }
  return {};
}

Result<void> check_apparent_roughness(const Material &material) {
  if (!material.apparent_roughness)
    return {};
  const ApparentRoughness &a = *material.apparent_roughness;
  if (a.hurst.has_value() == a.rms_height_nm.has_value())
    return problem(material, "apparent_roughness takes hurst or rms_height_nm, one of them");
  if (a.hurst && !(*a.hurst >= 0.3 && *a.hurst <= 1))
    return problem(material, fmt::format("hurst = {:g}; 0.3 to 1 was expected", *a.hurst));
  if (!(a.reference_nm >= 10 && a.reference_nm <= 1e6))
    return problem(material,
                   fmt::format("reference_nm = {:g}; 10 to 1e6 was expected", a.reference_nm));
  if (a.rms_height_nm && !(*a.rms_height_nm >= 0 && *a.rms_height_nm <= 1e5))
    return problem(material,
                   fmt::format("rms_height_nm = {:g}; 0 to 1e5 was expected", *a.rms_height_nm));
  return {};
}

void narrow(WavelengthRange &range, WavelengthRange by) {
  range.first_nm = std::max(range.first_nm, by.first_nm);
  range.last_nm = std::min(range.last_nm, by.last_nm);
}

} // namespace

Result<void> check_material(const Material &material) {
  if (material.measured)
    return {};
  UMOV_TRY(named(material, check_index(material.index), ""));
  UMOV_TRY(check_layers(material));
  const auto normals = make_distribution(material.distribution);
  if (!normals)
    return problem(material, normals.error().message);
  UMOV_TRY(check_body(material));
  UMOV_TRY(check_haze(material));
  UMOV_TRY(check_apparent_roughness(material));
  const bool needs_albedo = material.interreflection != Interreflection::None ||
                            (material.body && !material.body->is_polarized);
  if (!(*normals)->is_isotropic() && needs_albedo)
    return problem(material, "an anisotropic distribution goes with interreflection = \"none\" and "
                             "without an unpolarized body lobe");
  if ((*normals)->is_mirror() && material.interreflection != Interreflection::None)
    return problem(material, "a mirror has no inter-reflection; leave interreflection out");
  if ((*normals)->is_mirror() && material.apparent_roughness)
    return problem(material, "a mirror has no roughness; leave apparent_roughness out");
  return {};
}

std::string describe_polarization(const Material &material) {
  if (material.measured)
    return material.measured->has_polarization() ? "as measured"
                                                 : "depolarizes (only brightness was measured)";
  const bool is_void =
      material.layers.empty() && std::holds_alternative<Tabulated>(material.index.n) &&
      std::get<Tabulated>(material.index.n).value ==
          std::vector<double>(std::get<Tabulated>(material.index.n).value.size(), 1.0);
  std::string out = is_void ? "no interface" : "reflection polarizes";
  if (material.body)
    out += material.body->is_polarized ? "; body light p-polarized" : "; body light unpolarized";
  if (material.interreflection == Interreflection::Unpolarized)
    out += "; inter-reflection unpolarized";
  else if (material.interreflection == Interreflection::SingleBounceQ)
    out += "; inter-reflection as one reflection";
  if (material.haze)
    out += material.haze->is_polarized ? "; haze as one reflection" : "; haze unpolarized";
  return out;
}

WavelengthRange range_of(const Material &material) {
  if (material.measured)
    return {material.measured->first_nm(), material.measured->last_nm()};
  WavelengthRange range = range_of(material.index);
  for (const Layer &layer : material.layers)
    narrow(range, range_of(layer.index));
  if (material.body && !material.body->reflectance.wavelength_nm.empty())
    narrow(range, {material.body->reflectance.wavelength_nm.front(),
                   material.body->reflectance.wavelength_nm.back()});
  return range;
}

} // namespace umov
