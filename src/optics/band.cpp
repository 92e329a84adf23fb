#include <umov/optics/band.h>

#include <algorithm>
#include <fmt/format.h>
#include <umov/core/embedded.h>
#include <umov/core/text.h>

UMOV_EMBEDDED(solar_spectrum)

namespace umov {
namespace {

/// The compiled-in table; its form is fixed, so there is nothing to report.
Spectrum parse_solar_spectrum() {
  Spectrum out;
  std::string_view text = solar_spectrum();
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    const std::size_t space = line.find(' ');
    if (line.starts_with('#') || space == std::string_view::npos)
      continue;
    const auto um = parse_number(line.substr(0, space));
    const auto value = parse_number(line.substr(space + 1));
    if (um && value) { // the line of column names is no number
      out.wavelength_nm.push_back(*um * 1000);
      out.value.push_back(*value / 1000);
    }
  }
  return out;
}

} // namespace

const Spectrum &sunlight() {
  static const Spectrum table = parse_solar_spectrum();
  return table;
}

bool has_curve(const std::vector<Band> &bands) {
  return std::any_of(bands.begin(), bands.end(), [](const Band &band) { return band.curve; });
}

Result<Band> band_of(Passband curve) {
  UMOV_ASSIGN(sun, sunlight_in(curve));
  Band out{curve.name, Wavelength::nm(sun.effective_nm)};
  out.curve = std::make_shared<const Passband>(std::move(curve));
  return out;
}

Result<std::vector<Band>> bands_from(const std::vector<std::string> &set) {
  std::vector<Band> bands;
  for (const std::string &name : set) {
    if (name == "paper_rgb") {
      for (const int nm : {425, 550, 650})
        bands.push_back({fmt::format("nm:{}", nm), Wavelength::nm(nm)});
      continue;
    }
    const auto nm =
        name.starts_with("nm:") ? parse_number(std::string_view(name).substr(3)) : std::nullopt;
    if (!nm)
      return fail(ErrorCode::BadInput,
                  fmt::format("\"{}\" is no wavelength; \"paper_rgb\" or \"nm:NUMBER\" (such as "
                              "\"nm:550\") was expected",
                              name));
    if (!(*nm >= 10 && *nm <= 1e6))
      return fail(ErrorCode::BadInput,
                  fmt::format("band \"{}\": {} nm; 10 to 1000000 nm was expected. Is it in um?",
                              name, *nm));
    bands.push_back({name, Wavelength::nm(*nm)});
  }
  UMOV_TRY(check_band_set(bands));
  return bands;
}

Result<void> check_band_set(const std::vector<Band> &bands) {
  for (std::size_t i = 0; i < bands.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (bands[i].name == bands[j].name)
        return fail(ErrorCode::BadInput,
                    fmt::format("band \"{}\" stands twice; leave one out", bands[i].name));
  if (bands.empty())
    return fail(ErrorCode::BadInput, "no band; give \"paper_rgb\" or a list such as [\"nm:550\"]");
  return {};
}

Result<double> solar_irradiance(Wavelength wavelength) {
  const Spectrum &table = sunlight();
  const double nm = wavelength.nm();
  if (!(nm >= table.wavelength_nm.front() && nm <= table.wavelength_nm.back()))
    return fail(ErrorCode::BadInput,
                fmt::format("the solar spectrum (ASTM E490) covers {}-{} nm; {} nm was asked for",
                            table.wavelength_nm.front(), table.wavelength_nm.back(), nm));
  const auto next =
      std::upper_bound(table.wavelength_nm.begin(), table.wavelength_nm.end() - 1, nm);
  const auto i = static_cast<std::size_t>(next - table.wavelength_nm.begin());
  const double x0 = table.wavelength_nm[i - 1], x1 = table.wavelength_nm[i];
  const double t = (nm - x0) / (x1 - x0);
  return (1 - t) * table.value[i - 1] + t * table.value[i];
}

Result<double> solar_irradiance(const Band &band) {
  if (!band.curve)
    return solar_irradiance(band.wavelength);
  UMOV_ASSIGN(sun, sunlight_in(*band.curve));
  return sun.value;
}

Result<double> zero_irradiance(const Band &band, MagnitudeSystem system) {
  if (band.curve)
    return zero_irradiance(*band.curve, system);
  // AB and ST of a band so narrow that it is its wavelength.
  const double nm = band.wavelength.nm();
  return zero_irradiance(Passband{band.name, {0.999 * nm, nm, 1.001 * nm}, {0, 1, 0}, 0, "", ""},
                         system);
}

} // namespace umov
