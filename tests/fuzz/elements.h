#pragma once
// Mean elements there and back, for all their forms.

#include "fuzz/target.h"

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

/// Reads a text of one form; others are left to their own targets.
inline void check_elements(std::string_view text, ElementsForm form) {
  if (form_of_elements(text) != form)
    return;
  for (const bool is_lenient : {false, true}) {
    Diagnostics diagnostics;
    TleOptions options;
    options.allow_bad_checksum = options.keep_going = is_lenient;
    const auto sets = read_elements(text, "input", options, diagnostics);
    if (is_read(sets))
      check_written(*sets, form);
  }
}

} // namespace umov::fuzz
