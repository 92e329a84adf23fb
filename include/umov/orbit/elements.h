#pragma once
// Mean elements of an orbit, as they are published.

#include <cstddef>
#include <string>
#include <umov/time/epoch.h>

namespace umov {

/// A SGP4 mean element set. Angles in radians, motion in radians per minute.
struct ElementSet {
  std::string name; ///< "" if the set has no name line
  int norad_cat_id = 0;
  std::string international_designator;
  char classification = 'U';
  int epoch_year = 0;           ///< four digits
  double epoch_day_of_year = 0; ///< 1.0 = 1 January, 0h UTC
  Epoch<Utc> epoch{};
  double mean_motion_dot = 0,
         mean_motion_ddot = 0; ///< as printed: rev/day^2 (halved), rev/day^3 (sixth)
  double bstar = 0;            ///< 1/Earth radii
  double inclination = 0, raan = 0, eccentricity = 0, argument_of_perigee = 0, mean_anomaly = 0;
  double mean_motion = 0; ///< Kozai, rad/min
  int element_number = 0, revolution = 0, ephemeris_type = 0;
  std::size_t line = 0; ///< line of its first element line in the file
};

} // namespace umov
