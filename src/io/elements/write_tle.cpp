#include "io/elements/write_tle.h"

#include <cmath>
#include <cstdlib>
#include <fmt/format.h>
#include <map>
#include <umov/core/quantity.h>
#include <umov/core/text.h>
#include <umov/time/time_system.h>
#include <utility>

namespace umov {
namespace {

std::string catalogue_number(int number) {
  constexpr std::string_view letters = "ABCDEFGHJKLMNPQRSTUVWXYZ";
  if (number < 100'000)
    return fmt::format("{:05}", number);
  return fmt::format("{}{:04}", letters[static_cast<std::size_t>(number / 10'000 - 10)],
                     number % 10'000);
}

/// "1998-067A" as "98067A  "; what is of neither writing is cut to eight columns.
std::string designator(const std::string &text) {
  if (text.size() >= 9 && text[4] == '-')
    return fmt::format("{:<8.8}", text.substr(2, 2) + text.substr(5));
  return fmt::format("{:<8.8}", text == "UNKNOWN" ? "" : text);
}

/// 0.13161e-4 as " 13161-4": five digits and a power of ten.
std::string implied_decimal(double value) {
  if (value == 0)
    return " 00000-0";
  int power = static_cast<int>(std::floor(std::log10(std::abs(value)))) + 1;
  auto digits = std::llround(std::abs(value) * std::pow(10.0, 5 - power));
  if (digits >= 100'000) { // rounded up to the next power
    digits /= 10;
    ++power;
  }
  if (power < -9)
    return " 00000-0";
  return fmt::format("{}{:05}{}{}", value < 0 ? '-' : ' ', digits, power > 0 ? '+' : '-',
                     std::abs(power));
}

/// -0.00002182 as "-.00002182".
std::string fraction(double value) {
  std::string text = fmt::format("{:.8f}", std::abs(value));
  return (value < 0 ? "-" : " ") + text.substr(1);
}

std::string with_checksum(const std::string &line) {
  int sum = 0;
  for (const char c : line)
    sum += c >= '0' && c <= '9' ? c - '0' : c == '-' ? 1 : 0;
  return line + static_cast<char>('0' + sum % 10) + "\n";
}

std::string degrees(double radians) {
  double value = radians * 180 / pi;
  if (value >= 359.99995) // would be printed as 360
    value = 0;
  return fmt::format("{:8.4f}", value);
}

/// An epoch of a year's end rounds up to the first day of the next year.
struct TleEpoch {
  int year = 0;
  double day = 1;
};

TleEpoch epoch_of(const ElementSet &set) {
  constexpr double half_of_last_digit = 5e-9;
  if (set.epoch_day_of_year >= days_in_year(set.epoch_year) + 1 - half_of_last_digit)
    return {set.epoch_year + 1, 1};
  return {set.epoch_year, set.epoch_day_of_year};
}

/// A day of the year of eight decimals has no place for a leap second: what lies within one, or
/// rounds up to it, would be read as the midnight after it, a second late.
bool is_lost_in_leap_second(const ElementSet &set) {
  const TleEpoch epoch = epoch_of(set);
  const Epoch<Utc> read = utc_from_year_day(epoch.year, std::round(epoch.day * 1e8) * 1e-8);
  const double by_clock = 86400 * clock_days_between(read, set.epoch);
  return std::abs(seconds_between(read, set.epoch) - by_clock) > 0.5;
}

std::string lines_of(const ElementSet &set) {
  const TleEpoch epoch = epoch_of(set);
  const std::string number = catalogue_number(set.norad_cat_id);
  const std::string first =
      fmt::format("1 {}{} {} {:02}{:012.8f} {} {} {} {} {:4}", number, set.classification,
                  designator(set.international_designator), epoch.year % 100, epoch.day,
                  fraction(set.mean_motion_dot), implied_decimal(set.mean_motion_ddot),
                  implied_decimal(set.bstar), set.ephemeris_type % 10, set.element_number % 10'000);
  const std::string second = fmt::format(
      "2 {} {} {} {:07} {} {} {:11.8f}{:5}", number, degrees(set.inclination), degrees(set.raan),
      std::min(std::llround(set.eccentricity * 1e7), 9'999'999LL), degrees(set.argument_of_perigee),
      degrees(set.mean_anomaly), set.mean_motion / (2 * pi / 1440), set.revolution % 100'000);
  return (set.name.empty() ? "" : set.name + "\n") + with_checksum(first) + with_checksum(second);
}

/// What the columns of a TLE do not hold of a set; nothing where they hold all.
std::string beyond_columns(const ElementSet &set) {
  constexpr int alpha5_max = 339'999;
  constexpr double exponent_max = 0.999995e9; // five digits and an exponent of one
  const int number = set.norad_cat_id;
  const double motion = set.mean_motion / (2 * pi / 1440);
  if (number > alpha5_max)
    return fmt::format("catalogue number {} does not fit a TLE, whose five columns end at Z9999 = "
                       "{}",
                       number, alpha5_max);
  if (const int year = epoch_of(set).year; year < 1957 || year > 2056) // 60 is read as 1960
    return fmt::format("the epoch of {} is in {}; the two digits of a TLE's year mean 1957 to 2056",
                       number, year);
  if (!(std::abs(set.mean_motion_dot) < 0.999999995)) // the columns begin with the point
    return fmt::format("the first derivative of the mean motion of {} is {:g} rev/d2; a TLE holds "
                       "less than 1",
                       number, set.mean_motion_dot);
  if (!(motion > 5e-9 && motion < 99.999999995))
    return fmt::format("the mean motion of {} is {:g} rev/d; a TLE holds 1e-8 to below 100", number,
                       motion);
  for (const auto &[what, value] :
       {std::pair("B*", set.bstar),
        std::pair("the second derivative of the mean motion", set.mean_motion_ddot)})
    if (!(std::abs(value) < exponent_max))
      return fmt::format("{} of {} is {:g}; a TLE holds less than 1e9", what, number, value);
  if (is_lost_in_leap_second(set))
    return fmt::format("the epoch of {} is {}, at a leap second or rounds to one, which a TLE's "
                       "day of the year does "
                       "not tell from the second after it",
                       number, to_iso_microseconds(set.epoch));
  return "";
}

/// Names of the fields in which two sets differ.
std::vector<const char *> differences(const ElementSet &a, const ElementSet &b) {
  std::vector<const char *> out;
  const auto compare = [&](const char *name, double x, double y) {
    if (x != y)
      out.push_back(name);
  };
  compare("mean motion", a.mean_motion, b.mean_motion);
  compare("eccentricity", a.eccentricity, b.eccentricity);
  compare("inclination", a.inclination, b.inclination);
  compare("right ascension of the node", a.raan, b.raan);
  compare("argument of perigee", a.argument_of_perigee, b.argument_of_perigee);
  compare("mean anomaly", a.mean_anomaly, b.mean_anomaly);
  compare("B*", a.bstar, b.bstar);
  compare("first derivative of the mean motion", a.mean_motion_dot, b.mean_motion_dot);
  compare("second derivative of the mean motion", a.mean_motion_ddot, b.mean_motion_ddot);
  compare("element number", a.element_number, b.element_number);
  compare("revolution number", a.revolution, b.revolution);
  if (std::abs(clock_days_between(a.epoch, b.epoch)) * 86400 > 1e-6)
    out.push_back("epoch (to 0.4 ms)");
  return out;
}

} // namespace

Result<std::string> tle_of(const std::vector<ElementSet> &sets, Diagnostics &diagnostics) {
  std::string out;
  for (const ElementSet &set : sets) {
    if (const std::string beyond = beyond_columns(set); !beyond.empty())
      return fail(ErrorCode::BadInput, beyond + ". Write OMM instead (.json, .xml, .kvn or .csv).");
    out += lines_of(set);
  }
  Diagnostics of_own;
  UMOV_ASSIGN(read, read_tle(out, "the TLE", {}, of_own));
  std::map<std::string, std::size_t> lost;
  for (std::size_t k = 0; k < sets.size(); ++k)
    for (const char *field : differences(sets[k], read[k]))
      ++lost[field];
  for (const auto &[field, count] : lost)
    diagnostics.warn(fmt::format("the columns of a TLE do not hold all digits: {} of {}", field,
                                 counted(count, "set")),
                     {});
  return out;
}

} // namespace umov
