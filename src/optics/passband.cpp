#include <umov/optics/passband.h>

#include "optics/band_points.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <umov/core/constants.h>
#include <umov/core/expects.h>

namespace umov {

double value_at(const Spectrum &spectrum, double nm) {
  const auto &x = spectrum.wavelength_nm;
  if (x.size() < 2 || !(nm >= x.front() && nm <= x.back()))
    return 0;
  const auto next = std::upper_bound(x.begin() + 1, x.end() - 1, nm);
  const auto i = static_cast<std::size_t>(next - x.begin());
  const double t = (nm - x[i - 1]) / (x[i] - x[i - 1]);
  return (1 - t) * spectrum.value[i - 1] + t * spectrum.value[i];
}

std::vector<BandPoint> band_points(const Passband &band, const std::vector<double> &also_at) {
  const Spectrum response{band.wavelength_nm, band.response};
  std::vector<double> at = band.wavelength_nm;
  for (const auto *more : {&sunlight().wavelength_nm, &also_at})
    for (const double nm : *more)
      if (nm > band.wavelength_nm.front() && nm < band.wavelength_nm.back())
        at.push_back(nm);
  std::sort(at.begin(), at.end());
  at.erase(std::unique(at.begin(), at.end()), at.end());
  std::vector<BandPoint> out;
  for (std::size_t i = 0; i < at.size(); ++i) {
    const double step = (at[std::min(i + 1, at.size() - 1)] - at[i > 0 ? i - 1 : 0]) / 2;
    out.push_back({at[i], value_at(response, at[i]) * step});
  }
  return out;
}

namespace {

Result<void> check_curve(const std::vector<double> &nm, const std::vector<double> &response) {
  const auto problem = [](const std::string &text) { return fail(ErrorCode::BadInput, text); };
  UMOV_EXPECTS(nm.size() == response.size());
  if (nm.size() < 2)
    return problem(fmt::format("{} of a curve; two or more were expected",
                               nm.empty() ? "no point" : "one point"));
  for (std::size_t i = 0; i < nm.size(); ++i) {
    if (!(nm[i] > 0) || !std::isfinite(nm[i]))
      return problem(fmt::format("wavelength {:g}; a positive number was expected", nm[i]));
    if (i > 0 && !(nm[i] > nm[i - 1]))
      return problem(fmt::format("wavelength {:g} nm follows {:g} nm; increasing ones were "
                                 "expected. Sort them and leave repeated ones out.",
                                 nm[i], nm[i - 1]));
    if (!(response[i] >= 0))
      return problem(fmt::format("response {:g} at {:g} nm; 0 or more was expected. Replace the "
                                 "noise of a measured blocking range by 0.",
                                 response[i], nm[i]));
    if (!(response[i] <= 1.5))
      return problem(fmt::format("response {:g} at {:g} nm; 0 to 1 was expected. Is it in per "
                                 "cent? Divide by 100.",
                                 response[i], nm[i]));
  }
  if (constexpr double longest = 1e6; nm.back() > longest) // 1 mm: an energy curve is cut into nm
    return problem(fmt::format("wavelength {:g} nm; at most {:g} nm was expected. Which unit are "
                               "they in?",
                               nm.back(), longest));
  if (nm.back() < 10)
    return problem(fmt::format("wavelengths {:g} to {:g} nm; are they in micrometres? Say um.",
                               nm.front(), nm.back()));
  if (std::ranges::all_of(response, [](double r) { return r == 0; }))
    return problem("the response is 0 everywhere; some of 0 to 1 was expected. Is it the right "
                   "column?");
  return {};
}

/// Which of the points count: all but zeros beyond the first one at either end.
std::pair<std::ptrdiff_t, std::ptrdiff_t> support(const std::vector<double> &response) {
  const auto is_some = [](double r) { return r > 0; };
  const auto first = std::find_if(response.begin(), response.end(), is_some);
  const auto last = std::find_if(response.rbegin(), response.rend(), is_some);
  const auto begin = first == response.begin() ? 0 : first - response.begin() - 1;
  const auto end = last == response.rbegin() ? static_cast<std::ptrdiff_t>(response.size())
                                             : static_cast<std::ptrdiff_t>(response.size()) -
                                                   (last - response.rbegin()) + 1;
  return {begin, end};
}

/// An energy curve as one of photons (Eq. 1): only its course matters, at the peak it stays what it
/// was. Between its points, where it is linear, the quotient is not: some are put in.
Passband photon_response(const Passband &energy) {
  const auto peak = std::max_element(energy.response.begin(), energy.response.end());
  const double at_peak =
      energy.wavelength_nm[static_cast<std::size_t>(peak - energy.response.begin())];
  Passband out = energy;
  out.wavelength_nm.clear();
  out.response.clear();
  for (std::size_t i = 0; i < energy.wavelength_nm.size(); ++i) {
    const double nm = energy.wavelength_nm[i], value = energy.response[i];
    const std::size_t last = energy.wavelength_nm.size() - 1, next = std::min(i + 1, last);
    const double step = energy.wavelength_nm[next] - nm, rise = energy.response[next] - value;
    const double parts = i == last ? 1 : std::clamp(std::ceil(step), 1.0, 64.0); // of 1 nm
    for (double k = 0; k < parts; ++k) {
      const double at = nm + step * (k / parts);
      out.wavelength_nm.push_back(at);
      out.response.push_back((value + rise * (k / parts)) * at_peak / at);
    }
  }
  return out;
}

/// Integral of R lambda^power over the band.
double moment(const Passband &band, double power) {
  double sum = 0;
  for (const BandPoint &p : band_points(band, {}))
    sum += p.weight * std::pow(p.wavelength_nm, power);
  return sum;
}

} // namespace

Result<Passband> make_passband(std::string name, std::vector<double> wavelength_nm,
                               std::vector<double> response, DetectorKind kind) {
  UMOV_TRY(check_curve(wavelength_nm, response));
  const auto [begin, end] = support(response);
  Passband out;
  out.name = std::move(name);
  out.wavelength_nm.assign(wavelength_nm.begin() + begin, wavelength_nm.begin() + end);
  out.response.assign(response.begin() + begin, response.begin() + end);
  return kind == DetectorKind::Energy ? photon_response(out) : out;
}

Passband gaussian_passband(std::string name, double centre_nm, double full_width_nm) {
  Passband out;
  out.name = std::move(name);
  for (int i = -50; i <= 50; ++i) {
    const double x = i / 40.; // in full widths
    out.wavelength_nm.push_back(centre_nm + x * full_width_nm);
    out.response.push_back(std::exp2(-4 * x * x));
  }
  return out;
}

Passband multiplied(const Passband &band, const Spectrum &transmission) {
  const Spectrum response{band.wavelength_nm, band.response};
  Passband out = band;
  out.wavelength_nm.clear();
  out.response.clear();
  for (const BandPoint &p : band_points(band, transmission.wavelength_nm)) {
    const double factor = value_at(transmission, p.wavelength_nm);
    out.wavelength_nm.push_back(p.wavelength_nm);
    out.response.push_back(value_at(response, p.wavelength_nm) * factor);
  }
  return out;
}

double pivot_nm(const Passband &band) { return std::sqrt(moment(band, 1) / moment(band, -1)); }

Result<BandMean> mean_in(const Passband &band, const Spectrum &spectrum, const std::string &what) {
  const double first = band.wavelength_nm.front(), last = band.wavelength_nm.back();
  const auto &known = spectrum.wavelength_nm;
  if (known.empty() || first < known.front() || last > known.back())
    return fail(ErrorCode::BadInput,
                fmt::format("band \"{}\" needs {:g}-{:g} nm; {} covers {:g}-{:g} nm", band.name,
                            first, last, what, known.empty() ? 0 : known.front(),
                            known.empty() ? 0 : known.back()));
  double response = 0, sum = 0, sum1 = 0, sum2 = 0;
  for (const BandPoint &p : band_points(band, known)) {
    const double photons = p.weight * p.wavelength_nm;
    const double light = photons * value_at(spectrum, p.wavelength_nm);
    response += photons;
    sum += light;
    sum1 += light * p.wavelength_nm;
    sum2 += light * p.wavelength_nm * p.wavelength_nm;
  }
  if (!(sum > 0))
    return fail(ErrorCode::BadInput,
                fmt::format("{} has no light in band \"{}\"", what, band.name));
  const double mean = sum1 / sum;
  return BandMean{sum / response, mean, std::sqrt(std::max(0.0, sum2 / sum - mean * mean))};
}

Result<BandMean> sunlight_in(const Passband &band) {
  return mean_in(band, sunlight(), "the solar spectrum (ASTM E490)");
}

const char *name_of(MagnitudeSystem system) {
  switch (system) {
  case MagnitudeSystem::AB:
    return "AB";
  case MagnitudeSystem::ST:
    return "ST";
  case MagnitudeSystem::Vega:
    return "Vega";
  }
  return "";
}

namespace {

constexpr double ab_zero = 3631e-26;            ///< [W m-2 Hz-1], Oke & Gunn 1983
constexpr double st_zero = 3.6307805477010e-11; ///< [W m-2 nm-1], Koornneef et al. 1986: 21.1 mag

} // namespace

Result<double> zero_irradiance(const Passband &band, MagnitudeSystem system) {
  const double light_nm_s = constants::speed_of_light_km_s * 1e12;
  const double pivot = pivot_nm(band);
  switch (system) {
  case MagnitudeSystem::AB: // per Hz to per nm: c / pivot^2
    return ab_zero * light_nm_s / (pivot * pivot);
  case MagnitudeSystem::ST:
    return st_zero;
  case MagnitudeSystem::Vega:
    break;
  }
  if (!(band.vega_zero > 0))
    return fail(ErrorCode::BadInput,
                fmt::format("band \"{}\" has no zero point in the Vega system; take "
                            "mag_system = \"AB\"",
                            band.name));
  return band.vega_zero;
}

double ab_zero_photons(const Passband &band) {
  return ab_zero / constants::planck_j_s * moment(band, -1);
}

} // namespace umov
