#include <umov/time/epoch.h>

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <umov/core/embedded.h>
#include <umov/core/text.h>

UMOV_EMBEDDED(leap_seconds)

namespace umov {
namespace {

/// MJD of "#  File expires on 28 June 2027", or 0.
double parse_expiry() {
  static constexpr std::array<std::string_view, 12> months{
      "January", "February", "March",     "April",   "May",      "June",
      "July",    "August",   "September", "October", "November", "December"};
  constexpr std::string_view before = "expires on ";
  const std::size_t at = leap_seconds().find(before);
  if (at == std::string_view::npos)
    return 0;
  const std::string_view rest = leap_seconds().substr(at + before.size());
  const std::string_view date = rest.substr(0, rest.find('\n'));
  const std::size_t first = date.find(' '), second = date.find(' ', first + 1);
  const auto day = parse_number(date.substr(0, first));
  const auto year = parse_number(trimmed(date.substr(second + 1)));
  const auto month =
      std::find(months.begin(), months.end(), date.substr(first + 1, second - first - 1));
  if (!day || !year || month == months.end())
    return 0;
  const auto iso = utc_from_iso(
      fmt::format("{:04.0f}-{:02}-{:02.0f}T00:00:00Z", *year, month - months.begin() + 1, *day));
  return iso ? mjd(*iso) : 0;
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
