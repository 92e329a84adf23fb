#include <umov/time/epoch.h>

#include "time/bounds.h"

#include <array>
#include <cmath>
#include <erfa.h>
#include <fmt/format.h>
#include <umov/time/typed.h>

namespace umov {
namespace {

constexpr double day_s = 86400;
constexpr double mjd_zero = 2400000.5;

/// Length of the UTC day that holds a quasi-JD [s]: 86401 when it ends in a leap second.
double day_length(double jd) {
  int year = 0, month = 0, day = 0;
  double fraction = 0, today = 0, tomorrow = 0;
  const double midnight = std::floor(jd - 0.5) + 0.5;
  eraJd2cal(midnight, 0, &year, &month, &day, &fraction);
  eraDat(year, month, day, 0, &today);
  eraJd2cal(midnight + 1, 0, &year, &month, &day, &fraction);
  eraDat(year, month, day, 0, &tomorrow);
  return day_s + tomorrow - today;
}

/// Fraction of the day by the clock: the quasi-JD stretches a day with a leap second.
double clock_mjd_fraction(Epoch<Utc> time, double &whole) {
  const double days = (time.jd1 - mjd_zero) + time.jd2;
  whole = std::floor(days);
  const double fraction = ((time.jd1 - mjd_zero) - whole) + time.jd2;
  return fraction * day_length(time.jd1 + time.jd2) / day_s;
}

struct Reader {
  std::string_view text;
  std::size_t at = 0;

  /// `count` digits, or -1.
  int digits(int count) {
    int value = 0;
    for (int i = 0; i < count; ++i, ++at) {
      if (at >= text.size() || text[at] < '0' || text[at] > '9')
        return -1;
      value = value * 10 + (text[at] - '0');
    }
    return value;
  }
  bool skip(char wanted) {
    if (at < text.size() && text[at] == wanted) {
      ++at;
      return true;
    }
    return false;
  }
  /// Digits after a decimal point, as a fraction.
  double fraction() {
    double value = 0, scale = 0.1;
    for (; at < text.size() && text[at] >= '0' && text[at] <= '9'; ++at, scale /= 10)
      value += scale * (text[at] - '0');
    return value;
  }
};

struct Civil {
  int year, month, day, hour, minute;
  double second;
  int offset_min = 0;
  bool has_offset = false;
};

/// Empty if the text is not of the form.
bool read_civil(std::string_view text, Civil &out) {
  Reader r{text};
  out.year = r.digits(4);
  if (out.year < 0 || !r.skip('-') || (out.month = r.digits(2)) < 0 || !r.skip('-') ||
      (out.day = r.digits(2)) < 0)
    return false;
  if (!(r.skip('T') || r.skip('t') || r.skip(' ')) || (out.hour = r.digits(2)) < 0 ||
      !r.skip(':') || (out.minute = r.digits(2)) < 0)
    return false;
  out.second = 0;
  if (r.skip(':')) {
    const int whole = r.digits(2);
    if (whole < 0)
      return false;
    out.second = whole + (r.skip('.') ? r.fraction() : 0);
  }
  if (r.skip('Z') || r.skip('z')) {
    out.has_offset = true;
  } else if (r.at < text.size() && (text[r.at] == '+' || text[r.at] == '-')) {
    const int sign = text[r.at++] == '-' ? -1 : 1;
    const int hours = r.digits(2);
    const int minutes = r.skip(':') ? r.digits(2) : -1;
    if (hours < 0 || hours > 15 || minutes < 0 || minutes > 59)
      return false;
    out.offset_min = sign * (60 * hours + minutes);
    out.has_offset = true;
  }
  return r.at == text.size();
}

tl::unexpected<Error> bad_time(std::string_view text, const std::string &problem) {
  return fail(ErrorCode::BadInput, fmt::format("\"{}\" {}", text, problem));
}

/// A day without a time: "2018-01-21".
bool is_date(std::string_view text) {
  bool out = text.size() == 10;
  for (std::size_t i = 0; i < text.size() && out; ++i)
    out = i == 4 || i == 7 ? text[i] == '-' : text[i] >= '0' && text[i] <= '9';
  return out;
}

} // namespace

Result<Epoch<Utc>> utc_from_iso(std::string_view text) {
  Civil c{};
  if (text.size() > 64 || !read_civil(text, c))
    return bad_time(
        text.substr(0, 64),
        fmt::format("is not a time; ISO 8601 such as {}Z was expected",
                    is_date(text) ? std::string(text) + "T00:00:00" : "2018-01-21T04:00:00"));
  if (!c.has_offset)
    return bad_time(text,
                    fmt::format("has no zone, so it could be local time or UTC. Write {}Z for "
                                "UTC, or add an offset such as -10:00.",
                                text));
  if (c.year < 1972)
    return bad_time(text, "is before 1972, when UTC got its leap seconds; give a later time");
  Epoch<Utc> out;
  const int status =
      eraDtf2d("UTC", c.year, c.month, c.day, c.hour, c.minute, c.second, &out.jd1, &out.jd2);
  if (status < 0 || status >= 2)
    return bad_time(text, status >= 2 || status == -6
                              ? "has a second that this minute does not have (60 only in a leap "
                                "second)"
                              : "is not in the calendar; check month, day, hour and minute");
  if (c.offset_min != 0)
    out = plus_seconds(out, -60.0 * c.offset_min);
  if (const std::string why = outside_dates(out); !why.empty())
    return bad_time(text, why);
  return out;
}

Result<Epoch<Utc>> utc_from_iso_or_day(std::string_view text) {
  if (!is_date(text))
    return utc_from_iso(text);
  auto begin = utc_from_iso(std::string(text) + "T00:00:00Z");
  if (!begin) { // the day is quoted as it was typed
    std::string &said = begin.error().message;
    said.erase(said.find("T00:00:00Z"), std::string_view("T00:00:00Z").size());
  }
  return begin;
}

std::string to_iso(Epoch<Utc> time, int digits) {
  int year = 0, month = 0, day = 0;
  std::array<int, 4> clock{};
  eraD2dtf("UTC", digits, time.jd1, time.jd2, &year, &month, &day, clock.data());
  return fmt::format("{:04}-{:02}-{:02}T{:02}:{:02}:{:02}.{:0{}}Z", year, month, day, clock[0],
                     clock[1], clock[2], clock[3], digits);
}

std::string to_iso_microseconds(Epoch<Utc> time) {
  std::string text = to_iso(time);
  const auto back = utc_from_iso(text);
  return back && std::abs(seconds_between(*back, time)) < 1e-6 ? text : to_iso(time, 6);
}

std::string to_iso_exact(Epoch<Utc> time) {
  for (const int digits : {3, 6}) {
    const std::string text = to_iso(time, digits);
    // Half a nanosecond: what nine digits could not tell either.
    if (const auto back = utc_from_iso(text);
        back && std::abs(seconds_between(*back, time)) < 5e-10)
      return text;
  }
  return to_iso(time, 9);
}

double mjd(Epoch<Utc> time) {
  double whole = 0;
  const double fraction = clock_mjd_fraction(time, whole);
  return whole + fraction;
}

Epoch<Tai> tai_from(Epoch<Utc> time) {
  Epoch<Tai> out;
  eraUtctai(time.jd1, time.jd2, &out.jd1, &out.jd2);
  return out;
}

Epoch<Utc> utc_from(Epoch<Tai> time) {
  Epoch<Utc> out;
  eraTaiutc(time.jd1, time.jd2, &out.jd1, &out.jd2);
  return out;
}

Epoch<Tt> tt_from(Epoch<Utc> time) {
  const Epoch<Tai> tai = tai_from(time);
  Epoch<Tt> out;
  eraTaitt(tai.jd1, tai.jd2, &out.jd1, &out.jd2);
  return out;
}

Epoch<Utc> plus_seconds(Epoch<Utc> time, double seconds) {
  Epoch<Tai> tai = tai_from(time);
  // Whole days go to the large part, so that the small one keeps its nanoseconds.
  const double days = std::floor(tai.jd2 + seconds / day_s);
  tai.jd2 = (tai.jd2 - days) + seconds / day_s;
  tai.jd1 += days;
  return utc_from(tai);
}

double seconds_between(Epoch<Utc> a, Epoch<Utc> b) {
  const Epoch<Tai> x = tai_from(a), y = tai_from(b);
  return ((x.jd1 - y.jd1) + (x.jd2 - y.jd2)) * day_s;
}

Epoch<Utc> utc_from_year_day(int year, double day_of_year) {
  double zero = 0, january = 0;
  eraCal2jd(year, 1, 1, &zero, &january);
  const double whole = std::floor(day_of_year);
  const double midnight = zero + january + (whole - 1);
  // A day of year as a double is good to 3e-14 d. One that is a decimal of eight places, as element
  // sets have it, to that, means that decimal.
  double fraction = day_of_year - whole;
  if (const double decimal = std::round(fraction * 1e8) / 1e8; std::abs(fraction - decimal) < 6e-14)
    fraction = decimal;
  // The element set's fraction counts days of 86,400 s; the quasi-JD may have a longer one.
  return {midnight, fraction * day_s / day_length(midnight)};
}

double clock_days_between(Epoch<Utc> a, Epoch<Utc> b) {
  double whole_a = 0, whole_b = 0;
  const double fraction_a = clock_mjd_fraction(a, whole_a);
  const double fraction_b = clock_mjd_fraction(b, whole_b);
  return (whole_a - whole_b) + (fraction_a - fraction_b);
}

} // namespace umov
