#include <umov/atmosphere/air.h>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <umov/core/embedded.h>
#include <umov/core/text.h>
#include <vector>

UMOV_EMBEDDED(gas_absorption)

namespace umov {
namespace {

/// Absorption coefficients at increasing wavelengths.
struct Gases {
  std::vector<double> nm, water, ozone, mixed;
};

/// The compiled-in table; its form is fixed, so there is nothing to report.
Gases parse_gases() {
  Gases out;
  std::string_view text = gas_absorption();
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const auto cells = csv_cells(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
    if (!cells || cells->size() != 4 || !parse_number(cells->front().text))
      continue; // comments and the names of the columns
    std::vector<double> *columns[] = {&out.nm, &out.water, &out.ozone, &out.mixed};
    for (std::size_t i = 0; i < 4; ++i)
      columns[i]->push_back(parse_number((*cells)[i].text).value_or(0));
  }
  return out;
}

/// Linear between the points x, which rise and among which nm lies.
double between(double nm, const std::vector<double> &x, const std::vector<double> &y) {
  const auto k = static_cast<std::size_t>(
      std::max<std::ptrdiff_t>(1, std::lower_bound(x.begin(), x.end(), nm) - x.begin()));
  return y[k - 1] + (y[k] - y[k - 1]) * (nm - x[k - 1]) / (x[k] - x[k - 1]);
}

/// Outside nothing is absorbed.
double at(double nm, std::vector<double> Gases::*column) {
  static const Gases table = parse_gases();
  if (!(nm >= table.nm.front() && nm <= table.nm.back()))
    return 0;
  return between(nm, table.nm, table.*column);
}

/// Beyond its ends as there.
double at(double nm, const MeasuredExtinction &table) {
  if (table.nm.empty() || table.nm.size() != table.mag.size())
    return std::nan("");
  if (nm <= table.nm.front())
    return table.mag.front();
  if (nm >= table.nm.back())
    return table.mag.back();
  return between(nm, table.nm, table.mag);
}

constexpr double sea_level_hpa = 1013.25;

} // namespace

double standard_pressure_hpa(double height_m) {
  // The troposphere's law ends at 44 km, with nothing above.
  return sea_level_hpa * std::pow(std::max(0.0, 1 - 2.25577e-5 * height_m), 5.25588);
}

double rayleigh_depth(double nm, double pressure_hpa) {
  const double um = nm / 1000, w2 = um * um;
  const double depth = 0.0021520 * (1.0455996 - 341.29061 / w2 - 0.90230850 * w2) /
                       (1 + 0.0027059889 / w2 - 85.968563 * w2);
  return depth * pressure_hpa / sea_level_hpa;
}

double aerosol_depth(double nm, const Air &air) {
  return air.aerosol_550 * std::pow(nm / 550, -air.aerosol_exponent);
}

double ozone_depth(double nm, double ozone_du) { return at(nm, &Gases::ozone) * ozone_du / 1000; }

double water_transmission(double nm, double water_cm, double airmass) {
  const double x = at(nm, &Gases::water) * water_cm * airmass;
  return std::exp(-0.2385 * x / std::pow(1 + 20.07 * x, 0.45));
}

double mixed_gas_transmission(double nm, double pressure_hpa, double airmass) {
  const double x = at(nm, &Gases::mixed) * airmass * pressure_hpa / sea_level_hpa;
  return std::exp(-1.41 * x / std::pow(1 + 118.3 * x, 0.45));
}

double extinction_mag(double nm, const Air &air) {
  if (air.measured)
    return at(nm, *air.measured);
  const double depth =
      rayleigh_depth(nm, air.pressure_hpa) + aerosol_depth(nm, air) + ozone_depth(nm, air.ozone_du);
  return 2.5 / std::log(10.) * depth;
}

double transmission(double nm, const Air &air, double airmass) {
  const double smooth = std::pow(10, -0.4 * extinction_mag(nm, air) * airmass);
  if (air.measured)
    return smooth;
  return smooth * water_transmission(nm, air.water_cm, airmass) *
         mixed_gas_transmission(nm, air.pressure_hpa, airmass);
}

} // namespace umov
