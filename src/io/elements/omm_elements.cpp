// Fields to elements, each with its unit and range.

#include "io/elements/omm_message.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <umov/core/quantity.h>
#include <umov/core/text.h>
#include <umov/time/epoch.h>
#include <umov/time/time_system.h>

namespace umov::omm {

Result<void> put(Message &message, const std::string &file, const std::string &key, Field field) {
  const std::size_t line = field.line;
  if (const auto it = message.fields.find(key); it != message.fields.end())
    return fail(ErrorCode::BadInput,
                fmt::format("{} stands twice{}. Keep one of them.", key,
                            it->second.line > 0 ? fmt::format(", first in line {}", it->second.line)
                                                : std::string()),
                {file, line});
  message.fields.emplace(key, std::move(field));
  return {};
}

namespace {

class Fields {
public:
  Fields(const Message &message, const std::string &file) : message_(message), file_(file) {}

  [[nodiscard]] const Field *find(const std::string &key) const {
    const auto it = message_.fields.find(key);
    return it == message_.fields.end() || it->second.text.empty() ? nullptr : &it->second;
  }
  /// "KEY is "FOUND", expected EXPECTED."
  [[nodiscard]] tl::unexpected<Error> refuse(const std::string &key, const std::string &expected,
                                             const std::string &hint = "") const {
    const Field *field = find(key);
    const Where where{file_, field != nullptr && field->line > 0 ? field->line : message_.line};
    const std::string remedy = field == nullptr ? "Add it, or fetch the set again."
                                                : "Correct it, or fetch the set again.";
    const std::string found =
        field == nullptr ? "is missing" : fmt::format("is \"{}\"", field->text.substr(0, 60));
    return fail(ErrorCode::BadInput,
                fmt::format("message {}{}: {} {}, expected {}. {}", message_.number, name(), key,
                            found, expected, hint.empty() ? remedy : hint),
                where);
  }
  [[nodiscard]] Result<double> number(const std::string &key, const std::string &unit,
                                      const std::string &expected, double low, double high) const {
    const Field *field = find(key);
    if (field == nullptr)
      return refuse(key, expected);
    if (!field->unit.empty() && !unit.empty() && field->unit != unit)
      return fail(ErrorCode::BadInput,
                  fmt::format("message {}{}: {} is in \"{}\", expected {}", message_.number, name(),
                              key, field->unit, unit),
                  {file_, field->line});
    const auto value = parse_number(field->text);
    if (!value || !(*value >= low && *value <= high))
      return refuse(key, expected);
    return *value;
  }
  [[nodiscard]] Result<int> whole(const std::string &key, double high, int otherwise) const {
    if (find(key) == nullptr)
      return otherwise;
    UMOV_ASSIGN(value,
                number(key, "", fmt::format("a whole number from 0 to {:g}", high), 0, high));
    if (value != std::floor(value))
      return refuse(key, "a whole number");
    return static_cast<int>(value);
  }
  [[nodiscard]] std::string text(const std::string &key) const {
    const Field *field = find(key);
    return field == nullptr ? std::string() : field->text;
  }

private:
  [[nodiscard]] std::string name() const {
    const std::string object = text("OBJECT_NAME");
    return object.empty() ? std::string() : fmt::format(" ({})", object.substr(0, 40));
  }
  const Message &message_;
  const std::string &file_;
};

/// SGP4's elements mean something in one frame and one time scale only.
Result<void> check_metadata(const Fields &fields, Metadata metadata) {
  struct Rule {
    const char *key;
    std::vector<std::string> known;
    const char *hint;
  };
  const Rule rules[] = {
      {"CENTER_NAME", {"EARTH"}, "SGP4 is of the Earth. Fetch a set of SGP4."},
      {"REF_FRAME",
       {"TEME"},
       "SGP4's elements are of the true equator and mean equinox. Fetch a set of SGP4."},
      {"TIME_SYSTEM", {"UTC"}, "Give the epoch in UTC."},
      {"MEAN_ELEMENT_THEORY",
       {"SGP4", "SGP/SGP4", "SGP"},
       "Elements of another theory would be propagated wrongly. Fetch a set of SGP4."},
  };
  for (const Rule &rule : rules) {
    if (fields.find(rule.key) == nullptr && metadata == Metadata::Optional)
      continue;
    if (std::find(rule.known.begin(), rule.known.end(), fields.text(rule.key)) == rule.known.end())
      return fields.refuse(rule.key, rule.known.front(), rule.hint);
  }
  UMOV_ASSIGN(type, fields.whole("EPHEMERIS_TYPE", 9, 0));
  if (type != 0 && type != 2 && type != 3)
    return fields.refuse("EPHEMERIS_TYPE", "0 (SGP4)",
                         type == 4 ? "Type 4 is SGP4-XP. Fetch the SGP4 set of this object." : "");
  return {};
}

Result<void> read_epoch(const Fields &fields, ElementSet &out) {
  const std::string text = fields.text("EPOCH");
  const auto epoch = utc_from_calendar(text, TimeSystem::Utc);
  if (!epoch)
    return fields.refuse("EPOCH", "a date such as 2018-01-20T12:25:40.104192",
                         fields.find("EPOCH") == nullptr ? "" : epoch.error().message);
  out.epoch = *epoch;
  out.epoch_year = static_cast<int>(parse_number(text.substr(0, 4)).value_or(0));
  out.epoch_day_of_year = 1 + clock_days_between(*epoch, utc_from_year_day(out.epoch_year, 1.0));
  // Catalogues make their epochs from a TLE's eight decimals of a day. What is that decimal to a
  // nanosecond is that decimal: the set is then the same to the last bit, whatever its form.
  const double decimal = parse_number(fmt::format("{:.8f}", out.epoch_day_of_year)).value_or(0);
  const Epoch<Utc> meant = utc_from_year_day(out.epoch_year, decimal);
  if (text.find(":60") == std::string::npos &&
      std::abs(clock_days_between(*epoch, meant)) * 86400 < 1e-9) {
    out.epoch_day_of_year = decimal;
    out.epoch = meant;
  }
  return {};
}

} // namespace

Result<ElementSet> elements_of(const Message &message, const std::string &file, Metadata metadata) {
  const Fields fields(message, file);
  UMOV_TRY(check_metadata(fields, metadata));
  ElementSet out;
  out.line = message.line;
  for (const char *key : {"OBJECT_NAME", "OBJECT_ID"})
    if (fields.find(key) == nullptr)
      return fields.refuse(key, "a name");
  out.name = printable(fields.text("OBJECT_NAME"));
  out.international_designator = printable(fields.text("OBJECT_ID"));
  UMOV_TRY(read_epoch(fields, out));
  constexpr double huge = 1e30;
  UMOV_ASSIGN(motion,
              fields.number("MEAN_MOTION", "rev/day", "revolutions per day above 0", 1e-9, 100));
  UMOV_ASSIGN(shape, fields.number("ECCENTRICITY", "", "0 to below 1", 0, 1 - 1e-12));
  UMOV_ASSIGN(inclination, fields.number("INCLINATION", "deg", "0 to 180 deg", 0, 180));
  const auto turn = [&](const char *key) -> Result<double> {
    UMOV_ASSIGN(value, fields.number(key, "deg", "0 to 360 deg", 0, 360));
    return Angle::degrees(value == 360 ? 0.0 : value).radians();
  };
  UMOV_ASSIGN(raan, turn("RA_OF_ASC_NODE"));
  UMOV_ASSIGN(perigee, turn("ARG_OF_PERICENTER"));
  UMOV_ASSIGN(anomaly, turn("MEAN_ANOMALY"));
  UMOV_ASSIGN(bstar, fields.number("BSTAR", "1/ER", "the drag term B*", -huge, huge));
  UMOV_ASSIGN(dot, fields.number("MEAN_MOTION_DOT", "rev/day**2", "a number", -huge, huge));
  UMOV_ASSIGN(ddot, fields.number("MEAN_MOTION_DDOT", "rev/day**3", "a number", -huge, huge));
  UMOV_ASSIGN(norad, fields.whole("NORAD_CAT_ID", 999'999'999, 0));
  UMOV_ASSIGN(set_number, fields.whole("ELEMENT_SET_NO", 1e9, 0));
  UMOV_ASSIGN(revolution, fields.whole("REV_AT_EPOCH", 1e9, 0));
  UMOV_ASSIGN(type, fields.whole("EPHEMERIS_TYPE", 9, 0));
  out.mean_motion = motion * (2 * pi / 1440);
  out.eccentricity = shape;
  out.inclination = Angle::degrees(inclination).radians();
  out.raan = raan;
  out.argument_of_perigee = perigee;
  out.mean_anomaly = anomaly;
  out.bstar = bstar;
  out.mean_motion_dot = dot;
  out.mean_motion_ddot = ddot;
  out.norad_cat_id = norad;
  out.element_number = set_number;
  out.revolution = revolution;
  out.ephemeris_type = type;
  const std::string classification = printable(fields.text("CLASSIFICATION_TYPE"));
  if (!classification.empty()) // a letter, of which KVN and TLE write one byte
    out.classification = (classification[0] & 0x80) == 0 ? classification[0] : '?';
  return out;
}

} // namespace umov::omm
