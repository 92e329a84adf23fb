#pragma once
// A page of tracks over a site's sky: one HTML file that needs no network.

#include <string>
#include <umov/core/result.h>
#include <vector>

namespace umov {

/// A pass, as a line in the sky and a row of the table. NaN: not known.
struct SkyTrack {
  std::string id, name;
  std::string rise, culmination, set;    ///< UTC, "" where the span cuts the pass
  std::string brightest;                 ///< UTC; "" where no magnitude is known
  double altitude_max = 0;               ///< of the whole pass [deg]
  double visible_altitude = 0;           ///< the highest while visible [deg]
  double magnitude_min = 0;              ///< the brightest
  double phase_min = 0, phase_max = 0;   ///< while sunlit [deg]
  double visible_s = 0;                  ///< sunlit in a dark sky
  std::vector<double> azimuth, altitude; ///< [deg], in equal steps from rise to set
  std::vector<bool> is_sunlit;           ///< of each point
};

/// What the page says of them all.
struct SkyPage {
  std::string title;
  std::vector<SkyTrack> tracks;
  std::string order;              ///< of the table's rows at first: "mag", "alt", else by time
  std::string model;              ///< what the magnitudes are of; "": there are none
  std::vector<std::string> notes; ///< one sentence each
};

/// The sky overhead with north up and east left, tracks coloured by magnitude, and a table beside
/// it that can be sorted. Same input, same bytes.
std::string make_sky_page(const SkyPage &page);

} // namespace umov
