#include <umov/time/epoch.h>

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <umov/core/embedded.h>
#include <umov/core/text.h>

UMOV_EMBEDDED(leap_seconds)

namespace umov {
namespace {

/// Calls `take` with each line of an embedded table.
template <class Take> void for_each_line(std::string_view text, Take take) {
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    take(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
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

Epoch<Utc> leap_seconds_expire() { return {2400000.5, leap_second_expiry()}; }

void warn_if_beyond_leap_seconds(Epoch<Utc> time, Diagnostics &diagnostics) {
  if (mjd(time) > leap_second_expiry())
    diagnostics.warn(fmt::format("{} is past the end of the leap-second table; a leap second after "
                                 "it would shift times by 1 s",
                                 to_iso(time)));
}

} // namespace umov
