#include <umov/optics/index.h>

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>

namespace umov {
namespace {

/// Beyond all matter (k of metals in the far infrared is some 1e3; 1e9 is a perfect conductor to
/// double precision); squares of far larger numbers leave its reach, and reflectances were none.
constexpr double index_max = 1e6, absorption_max = 1e9;

tl::unexpected<Error> problem(const std::string &text) { return fail(ErrorCode::BadInput, text); }

/// Sum of pairs C_i x^C_{i+1} from coefficient `from` on.
double power_series(const std::vector<double> &c, std::size_t from, double x) {
  double sum = 0;
  for (std::size_t i = from; i + 1 < c.size(); i += 2)
    sum += c[i] * std::pow(x, c[i + 1]);
  return sum;
}

/// Sum of C_i x2/(x2 - pole) with the poles C_{i+1} or their squares.
double sellmeier(const std::vector<double> &c, double x2, bool squared) {
  double sum = c[0];
  for (std::size_t i = 1; i + 1 < c.size(); i += 2)
    sum += c[i] * x2 / (x2 - (squared ? c[i + 1] * c[i + 1] : c[i + 1]));
  return sum;
}

/// n, or NaN where the formula has no value; x: wavelength [um].
double evaluate(const DispersionFormula &formula, double x) {
  std::vector<double> c = formula.coefficients;
  const double x2 = x * x;
  switch (formula.number) {
  case 1:
    return std::sqrt(1 + sellmeier(c, x2, true));
  case 2:
    return std::sqrt(1 + sellmeier(c, x2, false));
  case 3:
    return std::sqrt(c[0] + power_series(c, 1, x));
  case 4: {
    c.resize(std::max<std::size_t>(c.size(), 9), 0.0);
    double square = c[0];
    for (std::size_t i = 1; i <= 5; i += 4)
      if (c[i] != 0)
        square += c[i] * std::pow(x, c[i + 1]) / (x2 - std::pow(c[i + 2], c[i + 3]));
    return std::sqrt(square + power_series(c, 9, x));
  }
  case 5:
    return c[0] + power_series(c, 1, x);
  case 6: {
    double n = 1 + c[0];
    for (std::size_t i = 1; i + 1 < c.size(); i += 2)
      n += c[i] / (c[i + 1] - 1 / x2);
    return n;
  }
  case 7: {
    c.resize(6, 0.0);
    const double l = 1 / (x2 - 0.028);
    return c[0] + c[1] * l + c[2] * l * l + c[3] * x2 + c[4] * x2 * x2 + c[5] * x2 * x2 * x2;
  }
  case 8: {
    c.resize(4, 0.0);
    const double f = c[0] + c[1] * x2 / (x2 - c[2]) + c[3] * x2;
    return std::sqrt((1 + 2 * f) / (1 - f));
  }
  case 9: {
    c.resize(6, 0.0);
    const double d = x - c[4];
    return std::sqrt(c[0] + c[1] / (x2 - c[2]) + c[3] * d / (d * d + c[5]));
  }
  default:
    return std::numeric_limits<double>::quiet_NaN();
  }
}

WavelengthRange range_of(const Tabulated &table) {
  if (table.wavelength_nm.empty())
    return {0, std::numeric_limits<double>::infinity()};
  return {table.wavelength_nm.front(), table.wavelength_nm.back()};
}

WavelengthRange range_of(const DispersionFormula &formula) {
  return {formula.first_nm, formula.last_nm};
}

double interpolate(const Tabulated &table, double nm) {
  const auto &x = table.wavelength_nm;
  if (x.size() < 2)
    return table.value.front();
  const auto next = std::upper_bound(x.begin() + 1, x.end() - 1, nm);
  const auto high = static_cast<std::size_t>(next - x.begin());
  const double t = (nm - x[high - 1]) / (x[high] - x[high - 1]);
  return (1 - t) * table.value[high - 1] + t * table.value[high];
}

} // namespace

IndexTable constant_index(std::complex<double> eta) {
  IndexTable out;
  out.name = "constant";
  out.n = Tabulated{{}, {eta.real()}};
  out.k = {{}, {eta.imag()}};
  return out;
}

IndexTable tabulated_index(std::string name, std::vector<double> wavelength_nm,
                           const std::vector<std::complex<double>> &eta) {
  IndexTable out;
  out.name = std::move(name);
  Tabulated n{wavelength_nm, {}};
  out.k = {std::move(wavelength_nm), {}};
  for (const auto &one : eta) {
    n.value.push_back(one.real());
    out.k.value.push_back(one.imag());
  }
  out.n = std::move(n);
  return out;
}

WavelengthRange range_of(const IndexTable &table) {
  const WavelengthRange n = std::visit([](const auto &part) { return range_of(part); }, table.n);
  const WavelengthRange k = range_of(table.k);
  return {std::max(n.first_nm, k.first_nm), std::min(n.last_nm, k.last_nm)};
}

Result<double> value_at(const Tabulated &table, Wavelength wavelength, const std::string &what) {
  const WavelengthRange range = range_of(table);
  if (!(wavelength.nm() >= range.first_nm && wavelength.nm() <= range.last_nm))
    return problem(
        fmt::format("{} covers {:g}-{:g} nm; {:g} nm was asked for. Extrapolation is off.", what,
                    range.first_nm, range.last_nm, wavelength.nm()));
  return interpolate(table, wavelength.nm());
}

Result<std::complex<double>> index_at(const IndexTable &table, Wavelength wavelength) {
  const WavelengthRange range = range_of(table);
  const double nm = wavelength.nm();
  if (!(nm >= range.first_nm && nm <= range.last_nm))
    return problem(fmt::format("{} covers {:g}-{:g} nm; {:g} nm was asked for. "
                               "Extrapolation is off.",
                               table.name == "in place" ? "an index written in place"
                                                        : "index \"" + table.name + "\"",
                               range.first_nm, range.last_nm, nm));
  const auto *formula = std::get_if<DispersionFormula>(&table.n);
  const double n = formula != nullptr ? evaluate(*formula, nm / 1000)
                                      : interpolate(std::get<Tabulated>(table.n), nm);
  if (!(n >= 1 / index_max && n <= index_max))
    return problem(
        fmt::format("index \"{}\": its formula has no real n at {:g} nm", table.name, nm));
  return std::complex<double>(n, interpolate(table.k, nm));
}

Result<void> check_tabulated(const Tabulated &table, const std::string &what) {
  const auto &nm = table.wavelength_nm;
  if (table.value.empty() ||
      (nm.empty() ? table.value.size() != 1 : nm.size() != table.value.size()))
    return problem(fmt::format("{} wavelengths and {} values of {}; as many of both were expected "
                               "(or one value and no wavelength)",
                               nm.size(), table.value.size(), what));
  for (std::size_t i = 0; i < nm.size(); ++i) {
    if (!(nm[i] > 0) || !std::isfinite(nm[i]))
      return problem(
          fmt::format("wavelength {:g} nm of {}; a positive number was expected", nm[i], what));
    if (nm[i] < 10 &&
        nm.back() < 1000) // a table that goes on into the infrared may begin at X-rays
      return problem(fmt::format("wavelength {:g} nm of {} is very short; is the table in um? "
                                 "Multiply by 1000.",
                                 nm[i], what));
    if (i > 0 && !(nm[i] > nm[i - 1]))
      return problem(fmt::format("wavelength {:g} nm of {} follows {:g} nm; increasing ones were "
                                 "expected. Sort them and leave repeated ones out.",
                                 nm[i], what, nm[i - 1]));
  }
  for (const double value : table.value)
    if (!std::isfinite(value))
      return problem(fmt::format("{} is {}; a finite number was expected", what, value));
  return {};
}

namespace {

Result<void> check_formula(const DispersionFormula &formula) {
  if (formula.number < 1 || formula.number > 9)
    return problem(
        fmt::format("dispersion formula {} is unknown; 1 to 9 was expected", formula.number));
  const bool is_open = formula.number <= 6; // any number of terms
  const std::size_t most = formula.number == 8 ? 4 : 6;
  const std::size_t count = formula.coefficients.size();
  if (count < 1 || (!is_open && count > most) || (formula.number == 8 && count < 3))
    return problem(fmt::format("dispersion formula {} with {} coefficients; {} was expected",
                               formula.number, count,
                               is_open ? "1 or more" : fmt::format("up to {}", most)));
  for (const double c : formula.coefficients)
    if (!std::isfinite(c))
      return problem("a coefficient of the dispersion formula is not a finite number");
  if (!(formula.first_nm > 0) || !(formula.last_nm > formula.first_nm))
    return problem(fmt::format("the dispersion formula holds from {:g} to {:g} nm; an increasing "
                               "range was expected",
                               formula.first_nm, formula.last_nm));
  return {};
}

} // namespace

Result<void> check_index(const IndexTable &table) {
  if (const auto *formula = std::get_if<DispersionFormula>(&table.n)) {
    UMOV_TRY(check_formula(*formula));
  } else {
    const auto &n = std::get<Tabulated>(table.n);
    UMOV_TRY(check_tabulated(n, "n"));
    for (const double value : n.value)
      if (!(value >= 1 / index_max && value <= index_max))
        return problem(fmt::format("n = {:g}; a positive number, {:g} to {:g}, was expected", value,
                                   1 / index_max, index_max));
  }
  UMOV_TRY(check_tabulated(table.k, "k"));
  for (const double value : table.k.value)
    if (!(value >= 0 && value <= absorption_max))
      return problem(
          fmt::format("k = {:g}; 0 or more was expected (n + ik, k > 0 absorbs), up to {:g}", value,
                      absorption_max));
  const WavelengthRange range = range_of(table);
  if (!(range.first_nm <= range.last_nm))
    return problem(fmt::format("n and k have no wavelength in common ({:g} nm is above {:g} nm)",
                               range.first_nm, range.last_nm));
  return {};
}

} // namespace umov
