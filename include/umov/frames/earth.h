#pragma once
// Rotations between the frames of an Earth satellite.

#include <umov/core/rotation.h>
#include <umov/time/epoch.h>

namespace umov {

/// ITRS from TEME as the SGP4 community does it: Greenwich mean sidereal time 1982 with UT1, then
/// polar motion (Vallado et al. 2006, section "Coordinate transformations").
Rotation<Itrs, Teme> itrs_from_teme(Epoch<Utc> time);
/// ITRS from GCRS: IAU 2006/2000A precession-nutation, Earth rotation angle with UT1, polar motion.
Rotation<Itrs, Gcrs> itrs_from_gcrs(Epoch<Utc> time);

} // namespace umov
