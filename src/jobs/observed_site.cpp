#include "jobs/observed_site.h"

#include <algorithm>
#include <fmt/format.h>
#include <optional>
#include <umov/core/text.h>

namespace umov::jobs {
namespace {

/// Half a degree of direction to the lowest orbits, where an attitude moves as far; rounded
/// coordinates and pillars beside each other lie well within.
constexpr double apart_km = 5;

/// A number of the header; nothing where it is not there.
Result<std::optional<double>> noted(const ObservationsFile &file, const std::string &key) {
  const auto found = file.notes.find(key);
  if (found == file.notes.end() || found->second.empty())
    return std::optional<double>();
  const auto value = parse_number(found->second);
  if (!value)
    return fail(ErrorCode::BadInput,
                fmt::format("{} of the header is \"{}\"; a number was expected", key,
                            printable(found->second)),
                {file.path});
  return std::optional(*value);
}

std::string text_of(const Site &site) {
  const std::string at = fmt::format("{}, {}, {:g} m", degrees_text(site.latitude),
                                     degrees_text(site.longitude), site.altitude_m);
  return site.name.empty() ? at : fmt::format("{} ({})", printable(site.name), at);
}

} // namespace

Result<void> check_site(const ObservationsFile &file, const Scenario &scenario) {
  if (!scenario.observer ||
      std::ranges::none_of(file.rows, [](const ObservedRow &row) { return row.site.empty(); }))
    return {};
  UMOV_ASSIGN(latitude, noted(file, "site_lat_deg"));
  UMOV_ASSIGN(longitude, noted(file, "site_lon_deg"));
  UMOV_ASSIGN(altitude, noted(file, "site_alt_m"));
  if (!latitude || !longitude)
    return {};
  const auto name = file.notes.find("site");
  auto told = make_site(name == file.notes.end() ? "" : name->second, *latitude, *longitude,
                        altitude.value_or(scenario.observer->altitude_m));
  if (!told)
    return fail(ErrorCode::BadInput, "site_" + told.error().message, {file.path});
  const double apart = norm(itrs_position_km(*told) - itrs_position_km(*scenario.observer));
  if (apart < apart_km)
    return {};
  return fail(
      ErrorCode::BadInput,
      fmt::format("by its header it was taken at {}, and [observer] of {} is {}, {:.0f} km away: "
                  "directions would be those of another place. Name the place of the observations "
                  "in [observer], or mend site_lat_deg, site_lon_deg and site_alt_m of the header",
                  text_of(*told), scenario.file, text_of(*scenario.observer), apart),
      {file.path});
}

} // namespace umov::jobs
