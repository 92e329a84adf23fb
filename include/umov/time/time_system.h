#pragma once
// Dates of CCSDS messages: their time system stands elsewhere in the message.

#include <optional>
#include <string_view>
#include <umov/core/result.h>
#include <umov/time/epoch.h>

namespace umov {

/// Time scales that messages may name.
enum class TimeSystem { Utc, Tai, Tt, Gps, Tdb, Ut1 };

/// "UTC", "TAI", "TT" ("TDT"), "GPS", "TDB", "UT1"; empty for another.
std::optional<TimeSystem> time_system_from(std::string_view name);

/// Whether a year of the Gregorian calendar has 366 days.
bool is_leap_year(int year);

/// 366 of a leap year, else 365.
int days_in_year(int year);

/// Reads "2008-09-20T12:25:40.104192" or, with a day of the year, "2006-090T05:00:00.071" (CCSDS
/// 301.0-B-4, codes A and B); a Z at the end is allowed. BadInput for anything else, and before
/// 1972. TDB as seen from the Earth's centre (ERFA's series, Fairhead & Bretagnon 1990).
Result<Epoch<Utc>> utc_from_calendar(std::string_view text, TimeSystem system);

} // namespace umov
