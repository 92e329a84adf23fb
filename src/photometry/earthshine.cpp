#include <umov/photometry/earthshine.h>

#include <algorithm>
#include <cmath>

namespace umov {

Earthshine earthshine(double albedo, double distance_km, Angle sun_zenith, double earth_radius_km) {
  // Over directions from the object to the cap that it sees; midpoint rule, smooth but at the
  // terminator.
  constexpr int rings = 600, spokes = 360;
  const double limb = std::asin(std::min(1.0, earth_radius_km / distance_km));
  const double cos_limb = std::cos(limb), ratio = distance_km / earth_radius_km;
  const double cs = std::cos(sun_zenith.radians()), ss = std::sin(sun_zenith.radians());
  Earthshine out;
  for (int i = 0; i < rings; ++i) {
    const double c = 1 - (1 - cos_limb) * (i + 0.5) / rings; // equal solid angles
    const double eta = std::acos(c);
    // Angle at the Earth's centre between the point below and the patch that lies in that
    // direction.
    const double central = std::asin(std::min(1.0, ratio * std::sin(eta))) - eta;
    double lit = 0;
    for (int k = 0; k < spokes; ++k) {
      const double phi = 2 * pi * (k + 0.5) / spokes;
      lit +=
          std::max(0.0, std::cos(central) * cs + std::sin(central) * ss * std::cos(phi)) / spokes;
    }
    const double part = albedo / pi * lit * 2 * pi * (1 - cos_limb) / rings;
    out.omnidirectional += part;
    out.on_nadir_facet += part * c;
  }
  return out;
}

} // namespace umov
