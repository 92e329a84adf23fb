#include <umov/surface/material.h>

#include "surface/lookup.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace umov {
namespace {

tl::unexpected<Error> problem(const Material &material, const std::string &text) {
  return fail(ErrorCode::BadInput, "material \"" + material.name + "\": " + text);
}

Result<void> check_wavelengths(const Material &material, const std::vector<double> &nm,
                               std::size_t values, const char *what) {
  if (values == 0 || (nm.empty() ? values != 1 : nm.size() != values))
    return problem(material, fmt::format("{} wavelengths and {} values of {}; as many of both were "
                                         "expected (or one value and no wavelength)",
                                         nm.size(), values, what));
  for (std::size_t i = 0; i < nm.size(); ++i) {
    if (!(nm[i] > 0) || !std::isfinite(nm[i]))
      return problem(material, fmt::format("wavelength {} nm of {}; a positive number was expected",
                                           nm[i], what));
    if (nm[i] < 10)
      return problem(material, fmt::format("wavelength {} nm of {} is very short; is the table in "
                                           "um? Multiply by 1000.",
                                           nm[i], what));
    if (i > 0 && !(nm[i] > nm[i - 1]))
      return problem(material, fmt::format("wavelength {} nm of {} follows {} nm; increasing ones "
                                           "were expected. Sort them and leave repeated ones out.",
                                           nm[i], what, nm[i - 1]));
  }
  return {};
}

} // namespace

Result<void> check(const Material &material) {
  UMOV_TRY(check_wavelengths(material, material.index.wavelength_nm, material.index.eta.size(),
                             "the index"));
  for (const auto &eta : material.index.eta) {
    if (!(eta.real() > 0) || !std::isfinite(eta.real()))
      return problem(material, fmt::format("n = {}; a positive number was expected", eta.real()));
    if (!(eta.imag() >= 0) || !std::isfinite(eta.imag()))
      return problem(material, fmt::format("k = {}; 0 or more was expected (n + ik, k > 0 absorbs)",
                                           eta.imag()));
  }
  if (!(material.exponent >= 0 && material.exponent <= 1e9))
    return problem(material, fmt::format("m = {}; 0 to 1e9 was expected", material.exponent));
  if (material.body) {
    UMOV_TRY(check_wavelengths(material, material.body->wavelength_nm,
                               material.body->reflectance.size(), "the body reflectance"));
    for (const double r : material.body->reflectance)
      if (!(r >= 0 && r <= 1))
        return problem(material, fmt::format("body reflectance {}; 0 to 1 was expected", r));
  }
  return {};
}

Result<Segment> find_segment(const std::vector<double> &x, double at) {
  if (x.empty())
    return Segment{0, 0, 0};
  if (!(at >= x.front() && at <= x.back()))
    return fail(ErrorCode::BadInput, "");
  const auto next = std::upper_bound(x.begin(), x.end(), at);
  const auto high = static_cast<std::size_t>(std::min(next, x.end() - 1) - x.begin());
  const std::size_t low = next == x.end() ? high : high - 1;
  return Segment{low, high, high == low ? 0 : (at - x[low]) / (x[high] - x[low])};
}

Result<std::complex<double>> index_at(const IndexTable &table, Wavelength wavelength) {
  const auto segment = find_segment(table.wavelength_nm, wavelength.nm());
  if (!segment)
    return fail(ErrorCode::BadInput,
                fmt::format("index \"{}\" covers {}-{} nm; {} nm was asked for. Extrapolation is "
                            "off.",
                            table.name, table.wavelength_nm.front(), table.wavelength_nm.back(),
                            wavelength.nm()));
  const auto &[low, high, t] = *segment;
  return (1 - t) * table.eta[low] + t * table.eta[high];
}

} // namespace umov
