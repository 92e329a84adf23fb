#include <umov/time/time_system.h>

#include "time/bounds.h"

#include <array>
#include <cmath>
#include <erfa.h>
#include <fmt/format.h>
#include <string>
#include <umov/time/earth_orientation.h>

namespace umov {
namespace {

/// Three digits as a number, or -1.
int three_digits(std::string_view text) {
  int value = 0;
  for (const char c : text.substr(0, 3)) {
    if (c < '0' || c > '9')
      return -1;
    value = value * 10 + (c - '0');
  }
  return value;
}

/// "2020-064T10:34:41.4" as "2020-03-04T10:34:41.4"; any other text as it is.
std::string with_month(std::string_view text) {
  if (text.size() < 9 || text[4] != '-' || text[8] != 'T')
    return std::string(text);
  const int thousands = three_digits(text), units = text[3] - '0',
            day = three_digits(text.substr(5));
  if (thousands < 0 || units < 0 || units > 9)
    return std::string(text);
  const int year = 10 * thousands + units;
  if (day < 1 || day > days_in_year(year))
    return std::string(text);
  const std::array<int, 12> days{
      31, is_leap_year(year) ? 29 : 28, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31};
  int rest = day;
  std::size_t month = 0;
  while (rest > days[month])
    rest -= days[month++];
  return fmt::format("{}-{:02}-{:02}{}", text.substr(0, 4), month + 1, rest, text.substr(8));
}

/// The same reading of the clock on a scale without leap seconds: days since the epoch of JD.
Epoch<Tai> as_even_days(Epoch<Utc> reading) {
  int year = 0, month = 0, day = 0;
  std::array<int, 4> clock{};
  // Nine digits are what the text could hold.
  eraD2dtf("UTC", 9, reading.jd1, reading.jd2, &year, &month, &day, clock.data());
  Epoch<Tai> out;
  eraCal2jd(year, month, day, &out.jd1, &out.jd2);
  out.jd1 += out.jd2;
  out.jd2 = (3600.0 * clock[0] + 60.0 * clock[1] + clock[2] + 1e-9 * clock[3]) / 86400;
  return out;
}

Epoch<Tai> tai_from(Epoch<Tai> date, TimeSystem system) {
  Epoch<Tai> out = date;
  switch (system) {
  case TimeSystem::Gps:
    out.jd2 += 19.0 / 86400; // since 1980
    break;
  case TimeSystem::Tt:
    eraTttai(date.jd1, date.jd2, &out.jd1, &out.jd2);
    break;
  case TimeSystem::Tdb: {
    // At the Earth's centre the observer's terms vanish.
    const double ahead = eraDtdb(date.jd1, date.jd2, 0, 0, 0, 0);
    double tt1 = 0, tt2 = 0;
    eraTdbtt(date.jd1, date.jd2, ahead, &tt1, &tt2);
    eraTttai(tt1, tt2, &out.jd1, &out.jd2);
    break;
  }
  default:
    break;
  }
  return out;
}

} // namespace

int days_in_year(int year) { return is_leap_year(year) ? 366 : 365; }

bool is_leap_year(int year) { return (year % 4 == 0 && year % 100 != 0) || year % 400 == 0; }

std::optional<TimeSystem> time_system_from(std::string_view name) {
  constexpr std::array<std::pair<std::string_view, TimeSystem>, 7> known{
      {{"UTC", TimeSystem::Utc},
       {"TAI", TimeSystem::Tai},
       {"TT", TimeSystem::Tt},
       {"TDT", TimeSystem::Tt},
       {"GPS", TimeSystem::Gps},
       {"TDB", TimeSystem::Tdb},
       {"UT1", TimeSystem::Ut1}}};
  for (const auto &[text, system] : known)
    if (name == text)
      return system;
  return std::nullopt;
}

Result<Epoch<Utc>> utc_from_calendar(std::string_view text, TimeSystem system) {
  if (text.size() > 64)
    return fail(ErrorCode::BadInput, "a date has at most 64 characters");
  std::string date = with_month(text);
  if (date.find('T') != std::string::npos && !date.ends_with('Z'))
    date += 'Z';
  if (date.find_first_of("+") != std::string::npos || date.find('-', 11) != std::string::npos)
    return fail(ErrorCode::BadInput,
                fmt::format("\"{}\" has an offset; its time system stands in the message", text));
  UMOV_ASSIGN(reading, utc_from_iso(date));
  if (system == TimeSystem::Utc)
    return reading;
  const Epoch<Tai> even = as_even_days(reading);
  Epoch<Utc> out;
  if (system != TimeSystem::Ut1)
    out = utc_from(tai_from(even, system));
  else // UT1-UTC changes by 2 ms a day: that of the same reading serves.
    eraUt1utc(even.jd1, even.jd2, earth_orientation(reading).dut1_s, &out.jd1, &out.jd2);
  if (const std::string why = outside_dates(out); !why.empty())
    return fail(ErrorCode::BadInput, fmt::format("\"{}\" {}", text, why));
  return out;
}

} // namespace umov
