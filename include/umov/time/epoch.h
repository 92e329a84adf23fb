#pragma once
// Points in time as two-part Julian dates with their scale in the type.

#include <string>
#include <string_view>
#include <umov/core/diagnostics.h>
#include <umov/core/result.h>

namespace umov {

struct Utc {};
struct Ut1 {};
struct Tai {};
struct Tt {};

/// Two-part Julian date; jd1 is a whole or half day, jd2 a fraction: better than 1 us for
/// 1957-2056. UTC is ERFA's quasi-JD: a day with a leap second is longer.
template <class Scale> struct Epoch { double jd1 = 0, jd2 = 0; };

/// Reads "2018-01-21T04:00:00Z", with fraction, with "+hh:mm" or "-hh:mm"; ":60" only in a leap
/// second. A time without offset, before 1972 or out of the calendar is BadInput.
Result<Epoch<Utc>> utc_from_iso(std::string_view text);
/// "2018-01-21T04:00:00.000Z": milliseconds, rounded, leap seconds as :60.
std::string to_iso(Epoch<Utc> time, int digits = 3);
/// Milliseconds, or microseconds where those would lose more than one.
std::string to_iso_microseconds(Epoch<Utc> time);
/// With as many digits (3, 6 or 9) as it takes to read the same time back.
std::string to_iso_exact(Epoch<Utc> time);
/// Modified Julian date, UTC.
double mjd(Epoch<Utc> time);

/// UTC to TAI by the table of leap seconds.
Epoch<Tai> tai_from(Epoch<Utc> time);
/// TAI to UTC.
Epoch<Utc> utc_from(Epoch<Tai> time);
/// UTC to TT: TAI and 32.184 s.
Epoch<Tt> tt_from(Epoch<Utc> time);
/// `time` plus SI seconds (through TAI, so leap seconds count).
Epoch<Utc> plus_seconds(Epoch<Utc> time, double seconds);
/// a - b in SI seconds.
double seconds_between(Epoch<Utc> a, Epoch<Utc> b);
/// UTC of a civil date with seconds of day possibly beyond 86400 (as SGP4 epochs have them).
Epoch<Utc> utc_from_year_day(int year, double day_of_year);
/// a - b in days of the UTC clock, leap seconds ignored, as SGP4 counts its minutes.
double clock_days_between(Epoch<Utc> a, Epoch<Utc> b);
/// Warns once if a time is past the leap-second table's expiry (`what` names its place).
void warn_if_beyond_leap_seconds(Epoch<Utc> time, Diagnostics &diagnostics);

/// Where the table of leap seconds ends that is compiled in: after it one more may have come.
Epoch<Utc> leap_seconds_expire();

} // namespace umov
