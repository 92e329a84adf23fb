#include "io/table/light_curve_names.h"

#include <cmath>
#include <umov/time/epoch.h>
#include <utility>
#include <vector>

namespace umov {

Table with_light_curve(Table table) {
  if (!table.find("time_utc") || !table.find("I") || !table.find("I_err") || table.find("flux"))
    return table;
  std::vector<double> time, flux, error;
  for (std::size_t k = 0; k < table.rows(); ++k) {
    const auto read = utc_from_iso(table.text("time_utc", k));
    time.push_back(read ? mjd(*read) : std::nan(""));
    flux.push_back(table.number("I", k));
    error.push_back(table.number("I_err", k));
  }
  const std::string unit = table.find("I")->unit;
  table.add("time", "d", "time_utc as a modified Julian date, UTC", std::move(time));
  table.add("flux", unit, "I", std::move(flux));
  table.add("flux_err", unit, "I_err", std::move(error));
  return table;
}

} // namespace umov
