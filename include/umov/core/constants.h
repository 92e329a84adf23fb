#pragma once
// Constants shared by several modules, each with source, year and unit.

namespace umov::constants {

inline constexpr double au_km = 149597870.7;              ///< IAU 2012 Resolution B2 [km]
inline constexpr double sun_radius_km = 695700.0;         ///< IAU 2015 Resolution B3, nominal [km]
inline constexpr double wgs84_a_km = 6378.137;            ///< WGS 84 (NIMA TR8350.2, 2000) [km]
inline constexpr double wgs84_f = 1 / 298.257223563;      ///< WGS 84 flattening
inline constexpr double speed_of_light_km_s = 299792.458; ///< SI definition [km/s]
inline constexpr double planck_j_s = 6.62607015e-34;      ///< SI definition [J s]
inline constexpr double earth_rate_rad_s = 7.292115e-5;   ///< WGS 84, rotation of the Earth [rad/s]

} // namespace umov::constants
