#pragma once
// Private: between which times a date can be said.

#include <string>
#include <umov/time/epoch.h>

namespace umov {

/// Why a time, in UTC and with its offset or scale taken off, cannot be written as a date; "" if it
/// can.
inline std::string outside_dates(Epoch<Utc> time) {
  constexpr double first = 2441317.5;                // 1972-01-01
  constexpr double last = 5373484.5 - 1.0 / 86400.0; // a year has four digits: 9999-12-31T23:59:59
  constexpr double rounding = 1e-15; // of the way through TAI: less than any digit that is written
  if ((time.jd1 - first) + time.jd2 < -rounding)
    return "is before 1972 in UTC, when UTC got its leap seconds; give a later time";
  return (time.jd1 - last) + time.jd2 > 0 ? "is after the year 9999 in UTC; give an earlier time"
                                          : "";
}

} // namespace umov
