#include <umov/jobs/band_tables.h>

#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <limits>
#include <umov/optics/band_grid.h>

namespace umov::jobs {
namespace {

/// Magnitude of the Sun at 1 au; NaN where the system has no zero.
double sun_magnitude(const Band &band, double solar, MagnitudeSystem system) {
  const auto zero = zero_irradiance(band, system);
  return zero ? -2.5 * std::log10(solar / *zero) : std::numeric_limits<double>::quiet_NaN();
}

} // namespace

Result<Table> band_list() {
  std::vector<std::string> names, sources;
  std::vector<double> first, last, pivot, effective, spread, solar, ab, vega, zero;
  for (const std::string &name : passband_names()) {
    UMOV_ASSIGN(curve, find_passband(name));
    UMOV_ASSIGN(sun, sunlight_in(curve));
    UMOV_ASSIGN(band, band_of(curve));
    names.push_back(name);
    first.push_back(curve.wavelength_nm.front());
    last.push_back(curve.wavelength_nm.back());
    pivot.push_back(pivot_nm(curve));
    effective.push_back(sun.effective_nm);
    spread.push_back(sun.spread_nm);
    solar.push_back(sun.value);
    ab.push_back(sun_magnitude(band, sun.value, MagnitudeSystem::AB));
    vega.push_back(sun_magnitude(band, sun.value, MagnitudeSystem::Vega));
    zero.push_back(curve.vega_zero > 0 ? curve.vega_zero
                                       : std::numeric_limits<double>::quiet_NaN());
    sources.push_back(curve.source);
  }
  Table out;
  out.add("band", "", "as a scenario spells it", std::move(names));
  out.add("first", "nm", "where the curve begins", std::move(first));
  out.add("last", "nm", "where it ends", std::move(last));
  out.add("pivot", "nm", "pivot wavelength", std::move(pivot));
  out.add("effective", "nm", "mean wavelength of detected sunlight", std::move(effective));
  out.add("spread", "nm", "standard deviation of it", std::move(spread));
  out.add("sun", "W / (m2 nm)", "sunlight at 1 au, photon-weighted mean", std::move(solar));
  out.add("sun_ab", "mag(AB)", "the Sun at 1 au", std::move(ab));
  out.add("sun_vega", "mag", "the Sun in the Vega system; empty: no zero point", std::move(vega));
  out.add("vega_zero", "W / (m2 nm)", "irradiance of Vega magnitude 0; empty: unknown",
          std::move(zero));
  out.add("source", "", "of the curve", std::move(sources));
  return out;
}

Result<Band> band_named(const std::string &name, const PassbandForm &form) {
  UMOV_ASSIGN(bands, read_bands({{name, form}}));
  if (bands.size() == 1)
    return std::move(bands.front());
  std::vector<std::string> names;
  names.reserve(bands.size());
  for (const Band &band : bands)
    names.push_back(band.name);
  return fail(ErrorCode::Usage,
              fmt::format("\"{}\" stands for {}; name one of them", name, fmt::join(names, ", ")));
}

Result<std::string> band_text(const Band &band) {
  UMOV_ASSIGN(solar, solar_irradiance(band));
  std::string out = band.name + "\n";
  if (band.curve) {
    UMOV_ASSIGN(sun, sunlight_in(*band.curve));
    UMOV_ASSIGN(grid, BandGrid::make({band}));
    out += fmt::format("wavelengths    {:g}-{:g} nm, pivot {:.3f}, effective in sunlight {:.3f}, "
                       "standard deviation {:.3f}\n",
                       band.curve->wavelength_nm.front(), band.curve->wavelength_nm.back(),
                       pivot_nm(*band.curve), sun.effective_nm, sun.spread_nm);
    out += fmt::format("computed at    {} wavelengths to begin with\n", grid.nodes().size());
    out += fmt::format("AB 0           {:.6g} photons s-1 m-2 behind this response\n",
                       ab_zero_photons(*band.curve));
    out += "source         " + band.curve->source + "\n";
  } else {
    out += fmt::format("wavelength     {:g} nm\n", band.wavelength.nm());
  }
  out += fmt::format("sunlight       {:.6f} W m-2 nm-1 at 1 au\n", solar);
  for (const MagnitudeSystem system :
       {MagnitudeSystem::AB, MagnitudeSystem::ST, MagnitudeSystem::Vega})
    if (const auto zero = zero_irradiance(band, system))
      out += fmt::format(
          "{:<14} 0 mag = {:.6g} W m-2 nm-1{}; the Sun {:.4f}\n", name_of(system), *zero,
          system == MagnitudeSystem::Vega ? " (" + band.curve->vega_source + ")" : "",
          sun_magnitude(band, solar, system));
    else
      out += fmt::format("{:<14} no zero point\n", name_of(system));
  return out;
}

Result<Table> band_table(const Band &band) {
  Table out;
  if (band.curve) {
    out.add("wavelength", "nm", "", band.curve->wavelength_nm);
    out.add("response", "", "to photons", band.curve->response);
  } else {
    out.add("wavelength", "nm", "", std::vector<double>{band.wavelength.nm()});
    out.add("response", "", "to photons", std::vector<double>{1});
  }
  return out;
}

} // namespace umov::jobs
