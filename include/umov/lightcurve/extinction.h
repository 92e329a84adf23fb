#pragma once
// What the air over a site takes of the light in a band.

#include <string>
#include <umov/atmosphere/air.h>
#include <umov/frames/site.h>
#include <umov/optics/band_grid.h>

namespace umov {

/// Air as it is described, over any site.
struct SiteAir {
  Air air;
  bool has_own_pressure = false; ///< else that of the site's height
  std::string file;              ///< of a measured extinction, empty: none
};
/// That over a site.
Air air_over(const SiteAir &air, const Site &site);

/// Part of sunlight in band `band` of a grid that arrives from an airless altitude, through the air
/// mass of the apparent one; NaN below the horizon. The object's own colour within the band is left
/// out (docs/theory/observing.md).
double band_transmission(const BandGrid &grid, std::size_t band, const Air &air, Angle altitude);

} // namespace umov
