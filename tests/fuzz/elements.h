#pragma once
// Mean elements there and back, for all their forms.

#include "fuzz/target.h"

#include <cmath>
#include <umov/core/quantity.h>
#include <umov/io/elements_file.h>
#include <vector>

namespace umov::fuzz {

/// The numbers of a set in an order.
inline std::vector<double> numbers_of(const ElementSet &set) {
  return {static_cast<double>(set.norad_cat_id),
          static_cast<double>(set.element_number),
          static_cast<double>(set.revolution),
          set.mean_motion_dot,
          set.mean_motion_ddot,
          set.bstar,
          set.inclination,
          set.raan,
          set.eccentricity,
          set.argument_of_perigee,
          set.mean_anomaly,
          set.mean_motion};
}

/// OMM keeps every number to the last bit; a name there is none of becomes UNKNOWN.
inline void check_written(const std::vector<ElementSet> &sets, ElementsForm form) {
  Diagnostics diagnostics;
  const Epoch<Utc> created{2460000.5, 0.25};
  const auto written = write_elements(sets, form, created, diagnostics);
  if (!is_read(written))
    return;
  const auto back = must(read_elements(*written, "written", {}, diagnostics),
                         "elements are written so that they can be read");
  require(back.size() == sets.size(), "as many sets are read as were written");
  for (std::size_t k = 0; k < sets.size(); ++k) {
    require(numbers_of(back[k]) == numbers_of(sets[k]), "elements keep their numbers");
    const double off_s = seconds_between(back[k].epoch, sets[k].epoch);
    require(off_s < 2e-6 && off_s > -2e-6, "elements keep their epoch to 1 us");
  }
}

/// What the columns of a TLE take can be read there, to half a unit of their last digit and what
/// degrees and revolutions a day lose as radians.
inline void check_written_as_tle(const std::vector<ElementSet> &sets) {
  Diagnostics diagnostics;
  const auto written = write_elements(sets, ElementsForm::Tle, {}, diagnostics);
  if (!is_read(written))
    return;
  const auto back = must(read_elements(*written, "written", {}, diagnostics),
                         "a TLE is written so that it can be read");
  require(back.size() == sets.size(), "a TLE holds as many sets as were written");
  constexpr double angle = 0.51e-4 * pi / 180, motion = 0.51e-8 * 2 * pi / 1440;
  for (std::size_t k = 0; k < sets.size(); ++k) {
    const ElementSet &a = back[k], &b = sets[k];
    require(a.norad_cat_id == b.norad_cat_id, "a TLE keeps the catalogue number");
    require(std::abs(a.mean_motion - b.mean_motion) < motion, "a TLE keeps the mean motion");
    require(std::abs(a.inclination - b.inclination) < angle, "a TLE keeps the inclination");
    require(std::abs(a.eccentricity - b.eccentricity) < 1.01e-7, "a TLE keeps the eccentricity");
    require(std::abs(a.mean_motion_dot - b.mean_motion_dot) < 0.51e-8, "a TLE keeps the decay");
    // Below .1e-9, the least with five digits, B* is written as 0.
    require(std::abs(a.bstar - b.bstar) <= 0.51e-4 * std::abs(b.bstar) + 1e-10, "a TLE keeps B*");
    const double off_s = seconds_between(a.epoch, b.epoch);
    require(std::abs(off_s) < 5e-4, "a TLE keeps the epoch to 0.5 ms");
  }
}

/// Reads a text of one form; others are left to their own targets.
inline void check_elements(std::string_view text, ElementsForm form) {
  if (form_of_elements(text) != form)
    return;
  for (const bool is_lenient : {false, true}) {
    Diagnostics diagnostics;
    TleOptions options;
    options.allow_bad_checksum = options.keep_going = is_lenient;
    const auto sets = read_elements(text, "input", options, diagnostics);
    if (!is_read(sets))
      continue;
    check_written(*sets, form);
    check_written_as_tle(*sets);
  }
}

} // namespace umov::fuzz
