// TLE fields: columns to numbers, each with its range.

#include "io/elements/tle_line.h"

#include <algorithm>
#include <cmath>
#include <umov/core/quantity.h>
#include <umov/core/text.h>
#include <umov/time/time_system.h>

namespace umov::tle {

namespace {

/// Columns `first` to `last` (from 1, both included) of a line, with the name of what they hold.
class Field {
public:
  Field(const Line &line, const std::string &file, std::size_t first, std::size_t last,
        std::string what)
      : raw_(line.text.substr(first - 1, last - first + 1)), text_(trimmed(raw_)),
        what_(std::move(what)) {
    const std::size_t blanks = raw_.find_first_not_of(' ');
    where_ = {file, line.number, first + (blanks == std::string_view::npos ? 0 : blanks)};
  }

  [[nodiscard]] std::string_view raw() const { return raw_; }
  [[nodiscard]] std::string_view text() const { return text_; }

  /// "WHAT is "FOUND", expected EXPECTED."
  [[nodiscard]] tl::unexpected<Error> refuse(const std::string &expected,
                                             const std::string &hint) const {
    return fail(ErrorCode::BadInput,
                what_ + " is " + (text_.empty() ? "blank" : "\"" + std::string(text_) + "\"") +
                    ", expected " + expected + ". " + hint,
                where_);
  }

  [[nodiscard]] Result<double> number(const std::string &expected) const {
    const bool is_plain =
        text_.find_first_not_of("0123456789.+-") == std::string_view::npos && !text_.empty();
    const auto value = is_plain ? parse_number(text_) : std::nullopt;
    if (!value)
      return refuse(expected, "Fetch the set again.");
    return *value;
  }

  /// Whole number padded with blanks; all blank is 0 where `blank_is_zero`.
  [[nodiscard]] Result<int> whole(bool blank_is_zero) const {
    if (text_.empty() && blank_is_zero)
      return 0;
    int value = 0;
    for (const char c : text_) {
      if (!is_digit(c))
        return refuse("a whole number", "Fetch the set again.");
      value = 10 * value + (c - '0');
    }
    if (text_.empty())
      return refuse("a whole number", "Fetch the set again.");
    return value;
  }

private:
  std::string_view raw_, text_;
  std::string what_;
  Where where_;
};

/// What people meant who wrote this before four digits, where it is no letter of Alpha-5.
char meant_by(char letter) {
  if (letter == 'i' || letter == 'l' || letter == 'I')
    return '1';
  if (letter == 'o' || letter == 'O')
    return '0';
  return static_cast<char>(letter - 'a' + 'A');
}

/// Five digits, or Alpha-5: a first letter without I and O counts tens of thousands from 10 on.
Result<int> catalogue_number(const Line &line, const std::string &file) {
  const Field field(line, file, 3, 7, "the catalogue number");
  const std::string_view text = field.text();
  const auto is_letter = [](char c) { return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z'); };
  if (text.size() != 5 || !is_letter(text[0]))
    return field.whole(false);
  if (!std::ranges::all_of(text.substr(1), is_digit))
    return field.refuse("five digits, or a capital letter and four digits", "Fetch the set again.");
  constexpr std::string_view letters = "ABCDEFGHJKLMNPQRSTUVWXYZ";
  const std::size_t letter = letters.find(text[0]);
  if (letter == std::string_view::npos)
    return field.refuse("five digits, or a capital letter other than I and O and four digits",
                        std::string("Did you mean '") + meant_by(text[0]) + "'?");
  UMOV_ASSIGN(low, Field(line, file, 4, 7, "the catalogue number").whole(false));
  return (static_cast<int>(letter) + 10) * 10000 + low;
}

Result<void> read_epoch(const Line &line, const std::string &file, ElementSet &set,
                        LineNotes &notes) {
  UMOV_ASSIGN(two_digits, Field(line, file, 19, 20, "the epoch's year").whole(false));
  // Two digits turn over at 57: the first satellite flew in 1957.
  set.epoch_year = two_digits < 57 ? 2000 + two_digits : 1900 + two_digits;
  const Field day(line, file, 21, 32, "the epoch's day of year");
  const int days = days_in_year(set.epoch_year);
  const std::string expected = "1.0 to below " + std::to_string(days + 1) + " in " +
                               std::to_string(set.epoch_year) + " (1.0 is 1 January, 0h)";
  UMOV_ASSIGN(value, day.number(expected));
  if (value < 1 || value >= 367)
    return day.refuse(expected, "Fetch the set again.");
  if (value >= days + 1)
    notes.odd_epoch = "the epoch's day is " + std::string(day.text()) + ", but " +
                      std::to_string(set.epoch_year) + " has " + std::to_string(days) +
                      " days; it is read as 1 January " + std::to_string(set.epoch_year + 1) + ".";
  const bool rolls_over = value >= days + 1;
  set.epoch_year += rolls_over ? 1 : 0;
  set.epoch_day_of_year = rolls_over ? value - days : value;
  return {};
}

/// Decimal point and exponent implied: " 13161-4" is 0.13161e-4.
Result<double> implied_decimal(const Line &line, const std::string &file, std::size_t first,
                               const std::string &what) {
  const Field field(line, file, first, first + 7, what);
  const std::string expected = "a sign or blank, five digits, '+' or '-' and a digit, as in "
                               "\" 13161-4\" for 0.13161e-4";
  std::string_view text = field.text();
  const bool is_negative = text.starts_with('-');
  if (is_negative || text.starts_with('+'))
    text.remove_prefix(1);
  bool is_good = text.size() == 7 && (text[5] == '-' || text[5] == '+') && is_digit(text[6]);
  for (std::size_t i = 0; is_good && i < 5; ++i)
    is_good = is_digit(text[i]);
  if (!is_good)
    return field.refuse(expected, "Fetch the set again.");
  const std::string decimal = std::string(is_negative ? "-0." : "0.") +
                              std::string(text.substr(0, 5)) + "e" + std::string(text.substr(5));
  // parse_number takes "e-4" and "e+4" alike; the text above cannot be anything else.
  return parse_number(decimal).value_or(0);
}

Result<int> ephemeris_type(const Line &line, const std::string &file) {
  const Field field(line, file, 63, 63, "the ephemeris type");
  const std::string_view text = field.text();
  if (text.empty() || text == "0" || text == "2" || text == "3")
    return text.empty() ? 0 : text[0] - '0';
  if (text == "4")
    return field.refuse("0 (SGP4)", "Type 4 is SGP4-XP: other elements, which SGP4 would "
                                    "propagate wrongly. Fetch the SGP4 set of this object.");
  return field.refuse("0, 2 or 3 (SGP4, SDP4)", "Fetch the SGP4 set of this object.");
}

Result<double> angle(const Line &line, const std::string &file, std::size_t first, double limit,
                     const std::string &what) {
  const Field field(line, file, first, first + 7, what);
  const std::string expected = "0 to " + shortest(limit) + " deg";
  UMOV_ASSIGN(degrees, field.number(expected));
  if (degrees < 0 || degrees > limit || std::signbit(degrees))
    return field.refuse(expected, degrees < 0 && limit == 360 ? "Add 360 deg if the angle is meant."
                                                              : "Fetch the set again.");
  return Angle::degrees(limit == 360 && degrees == 360 ? 0.0 : degrees).radians();
}

Result<double> eccentricity(const Line &line, const std::string &file) {
  const Field field(line, file, 27, 33, "the eccentricity");
  const std::string expected = "seven digits after an implied \"0.\"";
  for (const char c : field.raw())
    if (!is_digit(c))
      return field.refuse(expected, "Fetch the set again.");
  return parse_number("0." + std::string(field.raw())).value_or(0);
}

Result<double> mean_motion(const Line &line, const std::string &file) {
  const Field field(line, file, 53, 63, "the mean motion");
  const std::string expected = "revolutions per day above 0";
  UMOV_ASSIGN(value, field.number(expected));
  if (!(value > 0))
    return field.refuse(expected, "Fetch the set again.");
  return value * (2 * pi / 1440);
}

} // namespace

Result<void> read_first(const Line &line, const std::string &file, ElementSet &set,
                        LineNotes &notes) {
  set.line = line.number;
  UMOV_ASSIGN(number, catalogue_number(line, file));
  set.norad_cat_id = number;
  set.classification = line.text[7] == ' ' ? 'U' : line.text[7];
  set.international_designator = trimmed(line.text.substr(9, 8));
  UMOV_TRY(read_epoch(line, file, set, notes));
  UMOV_ASSIGN(dot, Field(line, file, 34, 43, "the mean motion's first derivative")
                       .number("a fraction such as -.00001"));
  set.mean_motion_dot = dot;
  UMOV_ASSIGN(ddot, implied_decimal(line, file, 45, "the mean motion's second derivative"));
  set.mean_motion_ddot = ddot;
  UMOV_ASSIGN(bstar, implied_decimal(line, file, 54, "the drag term B*"));
  set.bstar = bstar;
  UMOV_ASSIGN(type, ephemeris_type(line, file));
  set.ephemeris_type = type;
  UMOV_ASSIGN(element_number, Field(line, file, 65, 68, "the element number").whole(true));
  set.element_number = element_number;
  return {};
}

Result<void> read_second(const Line &line, const std::string &file, ElementSet &set) {
  UMOV_ASSIGN(number, catalogue_number(line, file));
  if (number != set.norad_cat_id)
    return fail(ErrorCode::BadInput,
                "the catalogue number is " + std::to_string(number) + ", expected " +
                    std::to_string(set.norad_cat_id) + " as in line " + std::to_string(set.line) +
                    "; lines of two objects are mixed. Fetch the sets again.",
                {file, line.number, 3});
  UMOV_ASSIGN(inclination, angle(line, file, 9, 180, "the inclination"));
  set.inclination = inclination;
  UMOV_ASSIGN(raan, angle(line, file, 18, 360, "the right ascension of the node"));
  set.raan = raan;
  UMOV_ASSIGN(shape, eccentricity(line, file));
  set.eccentricity = shape;
  UMOV_ASSIGN(perigee, angle(line, file, 35, 360, "the argument of perigee"));
  set.argument_of_perigee = perigee;
  UMOV_ASSIGN(anomaly, angle(line, file, 44, 360, "the mean anomaly"));
  set.mean_anomaly = anomaly;
  UMOV_ASSIGN(motion, mean_motion(line, file));
  set.mean_motion = motion;
  UMOV_ASSIGN(revolution, Field(line, file, 64, 68, "the revolution number").whole(true));
  set.revolution = revolution;
  return {};
}

} // namespace umov::tle
