#pragma once
#include <umov/core/vec3.h>
#include <umov/time/epoch.h>

namespace umov {

/// Geocentric Moon in GCRS [km], geometric (light time 1.3 s: 1 km), to about 3 arcsec and 10 km
/// (ERFA's Moon98: Chapront-Touze & Chapront's ELP 2000-82 as cut by Meeus 1998).
Vec3<Gcrs> moon_km(Epoch<Utc> time);

} // namespace umov
