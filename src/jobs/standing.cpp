#include "jobs/standing.h"

#include <cmath>
#include <fmt/format.h>
#include <umov/core/quantity.h>

namespace umov::jobs {
std::string where_it_stands(const Trajectory &orbit, const Site &site, Epoch<Utc> time,
                            Angle altitude_min) {
  const auto first = orbit.at(time);
  if (!first)
    return "";
  const Vec3<Itrs> here = itrs_position_km(*first, time), place = itrs_position_km(site);
  const double site_km = norm(place),
               seen_cos = site_km / norm(here) * std::cos(altitude_min.radians());
  if (!(seen_cos < 1))
    return "";
  const Angle reach = Angle::radians(std::acos(seen_cos) - altitude_min.radians());
  constexpr double wander_deg =
      20; // of an inclined one, north and south; a GPS satellite goes round
  const auto degrees_between = [](Vec3<Itrs> a, Vec3<Itrs> b) {
    return Angle::radians(angle_between(a, b)).degrees();
  };
  for (const double hours : {0., 6., 12., 18.}) {
    const Epoch<Utc> later = plus_seconds(time, 3600 * hours);
    const auto state = orbit.at(later);
    if (!state)
      return "";
    const Vec3<Itrs> there = itrs_position_km(*state, later);
    if (degrees_between(there, here) > wander_deg ||
        degrees_between(there, place) < reach.degrees())
      return "";
  }
  const double longitude = Angle::radians(std::atan2(here.y, here.x)).degrees();
  return fmt::format(
      " It turns with the Earth and stands over longitude {:.1f} {}: above {:g} deg it "
      "is seen within {:.0f} deg of arc of there, and the site is {:.0f} deg away. Take "
      "a site that sees it",
      std::abs(longitude), longitude < 0 ? "W" : "E", altitude_min.degrees(), reach.degrees(),
      degrees_between(here, place));
}

} // namespace umov::jobs
