#include <umov/time/earth_orientation.h>

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <memory>
#include <umov/core/embedded.h>
#include <umov/core/files.h>
#include <umov/core/quantity.h>
#include <umov/core/text.h>
#include <vector>

UMOV_EMBEDDED(eop)

namespace umov {
namespace {

struct Day {
  double mjd = 0, x_arcsec = 0, y_arcsec = 0, dut1_s = 0;
  bool is_predicted = false;
};

/// Days one after the other.
struct Days {
  std::string name;
  std::vector<Day> all;
};

Epoch<Utc> at_mjd(double days) { return {2400000.5, days}; }

/// Columns of finals2000A (IERS, readme.finals2000A): MJD 8-15, flag of UT1 58, x 19-27, y 38-46,
/// UT1-UTC 59-68, counted from 1.
std::optional<Day> day_of_finals(std::string_view line) {
  if (line.size() < 68)
    return {};
  const auto number = [line](std::size_t from, std::size_t count) {
    return parse_number(trimmed(line.substr(from, count)));
  };
  const auto mjd = number(7, 8), x = number(18, 9), y = number(37, 9), dut1 = number(58, 10);
  if (!mjd || !x || !y || !dut1)
    return {};
  return Day{*mjd, *x, *y, *dut1, line[57] == 'P'};
}

std::optional<Day> day_of_csv(std::string_view line) {
  std::array<double, 5> value{};
  std::size_t count = 0;
  for (; count < value.size() && !line.empty(); ++count) {
    const std::size_t comma = std::min(line.find(','), line.size());
    const auto number = parse_number(trimmed(line.substr(0, comma)));
    if (!number)
      return {};
    value[count] = *number;
    line.remove_prefix(std::min(comma + 1, line.size()));
  }
  if (count < 4)
    return {};
  return Day{value[0], value[1], value[2], value[3], value[4] != 0};
}

bool is_plausible(const Day &day) {
  constexpr double pole_arcsec = 2, ut1_s = 1; // IERS: it stays below 0.7 arcsec and 0.9 s
  constexpr double mjd_max = 1e6;              // beyond, a day later would not be another number
  return day.mjd == std::floor(day.mjd) && std::abs(day.mjd) < mjd_max &&
         std::abs(day.x_arcsec) <= pole_arcsec && std::abs(day.y_arcsec) <= pole_arcsec &&
         std::abs(day.dut1_s) <= ut1_s;
}

/// By how much UT1-UTC grows within a day; a leap second at its end is no part of that. Before 1972
/// UTC made steps of tenths of a second, which are (nobody is asked about those days).
double growth_s(const Day &a, const Day &b) {
  const double change = b.dut1_s - a.dut1_s;
  return change - std::round(change);
}

/// The length of the day has been off by up to 4 ms since 1962 (IERS EOP C04). A change of tenths
/// of a second is a slip, and half of one would be taken for a leap second.
constexpr double growth_most_s = 0.1;

bool is_continuous(const Day &a, const Day &b) {
  constexpr double leap_seconds_since = 41317; // 1 January 1972
  constexpr double step_most_s = 0.25;         // of UTC before: a tenth, and what the day adds
  const double change = std::abs(b.dut1_s - a.dut1_s);
  return a.mjd < leap_seconds_since ? change <= step_most_s
                                    : std::abs(growth_s(a, b)) <= growth_most_s && change < 1.5;
}

constexpr const char *expected_form =
    "IERS finals2000A, or columns mjd,x_arcsec,y_arcsec,ut1_utc_s for one day after the other";

Result<Days> parse(std::string_view text, const std::string &name) {
  Days out{name, {}};
  const bool is_csv = text.substr(0, 4096).find(',') != std::string_view::npos;
  for (std::size_t number = 1; !text.empty(); ++number) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    std::string_view line = text.substr(0, end);
    if (line.ends_with('\r'))
      line.remove_suffix(1);
    text.remove_prefix(std::min(end + 1, text.size()));
    const auto day = is_csv ? day_of_csv(line) : day_of_finals(line);
    const Where place{name, number, 0};
    if (!day) {
      // Comments, names of columns; the days of finals2000A that have no prediction yet.
      const bool is_head = out.all.empty() || line.empty() || line.front() == '#';
      if (is_head || (!is_csv && trimmed(line.size() < 68 ? "" : line.substr(58, 10)).empty()))
        continue;
      return fail(ErrorCode::BadInput,
                  fmt::format("no day can be read here; {} was expected", expected_form), place);
    }
    if (!is_plausible(*day) || (!out.all.empty() && day->mjd != out.all.back().mjd + 1))
      return fail(ErrorCode::BadInput,
                  fmt::format("MJD {:.0f} with pole {:g}, {:g} arcsec and UT1-UTC {:g} s; {} was "
                              "expected, within 2 arcsec and 1 s",
                              day->mjd, day->x_arcsec, day->y_arcsec, day->dut1_s, expected_form),
                  place);
    if (!out.all.empty() && !is_continuous(out.all.back(), *day))
      return fail(ErrorCode::BadInput,
                  fmt::format("UT1-UTC goes from {:g} to {:g} s within a day; a change of up to {} "
                              "s, or of one more where a leap second is, was expected. Correct the "
                              "line, or take finals2000A of the IERS.",
                              out.all.back().dut1_s, day->dut1_s, growth_most_s),
                  place);
    out.all.push_back(*day);
  }
  if (out.all.size() < 2)
    return fail(ErrorCode::BadInput,
                fmt::format("no table of Earth orientation; {} was expected", expected_form),
                {name, 1, 0});
  return out;
}

const std::shared_ptr<const Days> &built_in() {
  static const auto days =
      std::make_shared<const Days>(parse(eop(), "IERS finals2000A, compiled in").value());
  return days;
}

std::shared_ptr<const Days> &in_use() {
  static std::shared_ptr<const Days> days = built_in();
  return days;
}

EarthOrientation oriented(const Day &day, bool is_covered) {
  constexpr double arcsec = pi / 648000;
  return {day.dut1_s, day.x_arcsec * arcsec, day.y_arcsec * arcsec, is_covered};
}

/// By how much UT1-UTC may be off `days` after the last one of a table: the day has been up to 3 ms
/// longer or shorter than 86,400 s since 1973 (IERS EOP C04), and leap seconds keep it below 0.9 s.
double error_after_s(double days) { return std::min(0.9, 0.003 * days); }

} // namespace

EarthOrientation earth_orientation(Epoch<Utc> time) {
  const std::vector<Day> &days = in_use()->all;
  const double at = mjd(time);
  if (!(at >= days.front().mjd))
    return {0, 0, 0, false};
  // The last midnight may be that after a leap second, of which the day before knows nothing.
  if (at >= days.back().mjd)
    return oriented(days.back(), at == days.back().mjd);
  const auto i = std::min(static_cast<std::size_t>(at - days.front().mjd), days.size() - 2);
  const Day &a = days[i], &b = days[i + 1];
  const double t = at - a.mjd;
  // Across a leap second UT1-UTC jumps by one; within the day before, it does not yet.
  return oriented({at, a.x_arcsec + t * (b.x_arcsec - a.x_arcsec),
                   a.y_arcsec + t * (b.y_arcsec - a.y_arcsec), a.dut1_s + t * growth_s(a, b)},
                  true);
}

EarthOrientationTable earth_orientation_table() {
  const Days &days = *in_use();
  const auto predicted = std::find_if(days.all.begin(), days.all.end(),
                                      [](const Day &day) { return day.is_predicted; });
  const Day &measured = predicted == days.all.begin() ? days.all.front() : *(predicted - 1);
  return {days.name, at_mjd(days.all.front().mjd), at_mjd(days.all.back().mjd),
          at_mjd(measured.mjd)};
}

Result<void> use_earth_orientation(std::string_view text, const std::string &name) {
  UMOV_ASSIGN(days, parse(text, name));
  in_use() = std::make_shared<const Days>(std::move(days));
  return {};
}

void use_built_in_earth_orientation() { in_use() = built_in(); }

Result<void> use_earth_orientation_file(const std::filesystem::path &file) {
  UMOV_ASSIGN(text, read_file(file));
  return use_earth_orientation(text, file.string());
}

void warn_if_outside_eop(Epoch<Utc> first, Epoch<Utc> last, Diagnostics &diagnostics) {
  const EarthOrientationTable table = earth_orientation_table();
  constexpr double equator_m_per_s = 465.1; // 7.292115e-5 rad/s times 6,378,137 m
  for (const Epoch<Utc> time : {first, last}) {
    if (earth_orientation(time).is_covered)
      continue;
    const bool is_after = mjd(time) > mjd(table.last);
    const double error_s = is_after ? error_after_s(mjd(time) - mjd(table.last)) : 0.9;
    diagnostics.warn(fmt::format(
        "{} is {} the table of Earth orientation ({} to {}): UT1-UTC and polar motion are {}, "
        "which "
        "is off by up to {:.2g} s or {:.0f} m at the equator. A newer finals2000A of the IERS can "
        "be given as [earth] eop or --eop.",
        to_iso(time), is_after ? "after" : "before", to_iso(table.first).substr(0, 10),
        to_iso(table.last).substr(0, 10), is_after ? "held" : "taken as 0", error_s,
        std::ceil(error_s * equator_m_per_s)));
    return;
  }
}

} // namespace umov
