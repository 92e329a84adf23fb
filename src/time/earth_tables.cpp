#include <umov/time/epoch.h>

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <umov/core/embedded.h>
#include <umov/core/quantity.h>
#include <umov/core/text.h>
#include <vector>

UMOV_EMBEDDED(leap_seconds)
UMOV_EMBEDDED(eop)

namespace umov {
namespace {

struct EopRow {
  double mjd, x_arcsec, y_arcsec, dut1_s;
};

/// Calls `take` with each line of an embedded table.
template <class Take> void for_each_line(std::string_view text, Take take) {
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    take(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
}

std::vector<EopRow> parse_eop() {
  std::vector<EopRow> rows;
  for_each_line(eop(), [&](std::string_view line) {
    std::array<double, 4> value{};
    for (double &v : value) {
      const std::size_t comma = std::min(line.find(','), line.size());
      const auto number = parse_number(line.substr(0, comma));
      if (!number) // comments and column names
        return;
      v = *number;
      line.remove_prefix(std::min(comma + 1, line.size()));
    }
    rows.push_back({value[0], value[1], value[2], value[3]});
  });
  return rows;
}

const std::vector<EopRow> &eop_rows() {
  static const std::vector<EopRow> rows = parse_eop();
  return rows;
}

/// MJD of "#  File expires on 28 June 2027", or 0.
double parse_expiry() {
  static constexpr std::array<std::string_view, 12> months{
      "January", "February", "March",     "April",   "May",      "June",
      "July",    "August",   "September", "October", "November", "December"};
  double out = 0;
  for_each_line(leap_seconds(), [&](std::string_view line) {
    const std::size_t at = line.find("expires on ");
    if (at == std::string_view::npos)
      return;
    const std::string_view date = line.substr(at + 11);
    const std::size_t first = date.find(' '), second = date.find(' ', first + 1);
    const auto day = parse_number(date.substr(0, first));
    const auto year = parse_number(trimmed(date.substr(second + 1)));
    const auto month =
        std::find(months.begin(), months.end(), date.substr(first + 1, second - first - 1));
    if (!day || !year || month == months.end())
      return;
    const auto iso = utc_from_iso(
        fmt::format("{:04.0f}-{:02}-{:02.0f}T00:00:00Z", *year, month - months.begin() + 1, *day));
    out = iso ? mjd(*iso) : 0;
  });
  return out;
}

double leap_second_expiry() {
  static const double expiry = parse_expiry();
  return expiry;
}

} // namespace

EarthOrientation earth_orientation(Epoch<Utc> time) {
  const std::vector<EopRow> &rows = eop_rows();
  const double at = mjd(time);
  if (!(at >= rows.front().mjd && at <= rows.back().mjd))
    return {0, 0, 0, false};
  const auto i = std::min(static_cast<std::size_t>(at - rows.front().mjd), rows.size() - 2);
  const EopRow &a = rows[i], &b = rows[i + 1];
  const double t = (at - a.mjd) / (b.mjd - a.mjd);
  // Across a leap second UT1-UTC jumps by one; within the day before, it does not yet.
  const double step = std::round(b.dut1_s - a.dut1_s);
  constexpr double arcsec = pi / 648000;
  return {a.dut1_s + t * (b.dut1_s - step - a.dut1_s),
          (a.x_arcsec + t * (b.x_arcsec - a.x_arcsec)) * arcsec,
          (a.y_arcsec + t * (b.y_arcsec - a.y_arcsec)) * arcsec, true};
}

EarthTables earth_tables() {
  const auto at = [](double days) { return Epoch<Utc>{2400000.5, days}; };
  return {at(eop_rows().front().mjd), at(eop_rows().back().mjd), at(leap_second_expiry())};
}

void warn_if_beyond_leap_seconds(Epoch<Utc> time, Diagnostics &diagnostics) {
  if (mjd(time) > leap_second_expiry())
    diagnostics.warn(fmt::format("{} is past the end of the leap-second table; a leap second after "
                                 "it would shift times by 1 s",
                                 to_iso(time)));
}

void warn_if_outside_eop(Epoch<Utc> first, Epoch<Utc> last, Diagnostics &diagnostics) {
  for (const Epoch<Utc> time : {first, last})
    if (!earth_orientation(time).is_covered) {
      diagnostics.warn(fmt::format("{} is outside the Earth orientation table ({:.0f}-{:.0f} MJD): "
                                   "UT1-UTC and polar motion are taken as 0, which is up to 0.9 s "
                                   "or 420 m at the equator",
                                   to_iso(time), eop_rows().front().mjd, eop_rows().back().mjd));
      return;
    }
}

} // namespace umov
