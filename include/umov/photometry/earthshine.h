#pragma once
#include <umov/core/quantity.h>

namespace umov {

/// Irradiance by sunlight that a Lambert Earth of one albedo sends to an object, in units of the
/// solar irradiance: each visible patch is a source of radiance albedo/pi times the cosine of the
/// Sun there. Light curves do not hold it: each patch has a scattering plane of its own.
struct Earthshine {
  double on_nadir_facet = 0; ///< on a surface that faces the Earth's centre
  double omnidirectional =
      0; ///< on a surface that faces every patch (a small sphere, per cross section)
};

/// `distance_km`: object to the Earth's centre, above `earth_radius_km`; `sun_zenith`: of the Sun
/// at the point below the object.
Earthshine earthshine(double albedo, double distance_km, Angle sun_zenith,
                      double earth_radius_km = 6378.137);

} // namespace umov
