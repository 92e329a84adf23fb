// Curves of bands, and how a light curve repeats.

#include "arrays.h"
#include "bindings.h"
#include "errors.h"
#include "gil.h"

#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>
#include <span>
#include <umov/jobs/band_tables.h>
#include <umov/lightcurve/periodogram.h>

namespace umov::python {
namespace {

using nb::literals::operator""_a;

Band band_of(const std::string &name, const std::string &unit, const std::string &detector) {
  PassbandForm form{unit, {}};
  if (!detector.empty())
    form.detector = detector == "energy" ? DetectorKind::Energy : DetectorKind::Photon;
  return take(jobs::band_named(name, form));
}

/// Periods [s], powers, and the best period.
nb::tuple periodogram_of(const Numbers &seconds, const Numbers &magnitudes) {
  Periodogram found;
  {
    const WithoutGil free;
    found = periodogram(std::span(seconds.data(), seconds.size()),
                        std::span(magnitudes.data(), magnitudes.size()));
  }
  const std::size_t count = found.power.size();
  return nb::make_tuple(array_from(std::move(found.period_s), {count}),
                        array_from(std::move(found.power), {count}), found.best_s);
}

} // namespace

void bind_bands(nb::module_ &m) {
  m.def("band_list", [] { return take(jobs::band_list()); });
  m.def(
      "band_table",
      [](const std::string &name, const std::string &unit, const std::string &detector) {
        return take(jobs::band_table(band_of(name, unit, detector)));
      },
      "name"_a, "unit"_a, "detector"_a);
  m.def(
      "check_bands",
      [](const std::vector<std::string> &names) { return take(bands_named(names)).size(); },
      "names"_a);
  m.def(
      "periodogram", &periodogram_of, "seconds"_a, "magnitudes"_a,
      nb::sig("def periodogram(seconds: numpy.typing.NDArray[numpy.float64], magnitudes: "
              "numpy.typing.NDArray[numpy.float64]) -> tuple[numpy.typing.NDArray[numpy.float64], "
              "numpy.typing.NDArray[numpy.float64], float]"));
}

} // namespace umov::python
