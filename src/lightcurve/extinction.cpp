#include <umov/lightcurve/extinction.h>

#include <limits>
#include <umov/atmosphere/refraction.h>
#include <umov/photometry/radiometry.h>

namespace umov {

Air air_over(const SiteAir &air, const Site &site) {
  Air out = air.air;
  if (!air.has_own_pressure)
    out.pressure_hpa = standard_pressure_hpa(site.altitude_m);
  return out;
}

double band_transmission(const BandGrid &grid, std::size_t band, const Air &air, Angle altitude) {
  if (!(altitude.radians() > 0))
    return std::numeric_limits<double>::quiet_NaN();
  const double x = airmass(apparent_altitude(550, altitude, {air.pressure_hpa, 283.15, 4}));
  double out = 0;
  for (const BandTerm &term : grid.terms()[band])
    out += term.weight * transmission(grid.nodes()[term.node].wavelength.nm(), air, x);
  return out;
}

} // namespace umov
