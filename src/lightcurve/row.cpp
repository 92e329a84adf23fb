#include "lightcurve/row.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <umov/core/constants.h>
#include <umov/lightcurve/shown_magnitude.h>
#include <umov/photometry/refracted_shadow.h>

namespace umov {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// Position angle in [0, 180) deg of linear polarization, NaN where there is none.
double position_angle_deg(double q, double u) {
  if (!(q * q + u * u > 0))
    return nan;
  const double angle = 0.5 * std::atan2(u, q) * (180 / pi);
  return angle < 0 ? (angle + 180 < 180 ? angle + 180 : 0) : angle;
}

/// Sunlight at the object in a band, in parts of that outside all shadows.
double sunlight(const LightCurveRequest &request, const ObservingGeometry &g, const Band &band) {
  if (!request.has_refracted_shadow)
    return g.sunlit;
  const double distance = norm(g.gcrs_km);
  const Vec3<Gcrs> down = -1 * g.gcrs_km / distance;
  // The ellipsoid's radius under the limb that the Sun stands over.
  const Vec3<Gcrs> side = g.to_sun - down * dot(g.to_sun, down);
  const double limb = std::acos(std::min(1.0, constants::wgs84_a_km / distance));
  const double up = norm(side) > 1e-12 ? normalized(side).z : 0;
  const double sine = -down.z * std::cos(limb) + up * std::sin(limb); // of the limb's latitude
  const double radius = constants::wgs84_a_km * (1 - constants::wgs84_f * sine * sine);
  const Angle disk = Angle::radians(std::asin(constants::sun_radius_km / g.sun_distance_km));
  return refracted_sunlight(disk, radius, distance, Angle::radians(angle_between(g.to_sun, down)),
                            band.wavelength) *
         sunlit_beside_moon(g.time, g.gcrs_km, g.sun_gcrs_km);
}

} // namespace

const char *name_of(PolarizationFrame frame) {
  switch (frame) {
  case PolarizationFrame::Equatorial:
    return "equatorial";
  case PolarizationFrame::AltAz:
    return "altaz";
  case PolarizationFrame::Scattering:
    break;
  }
  return "scattering";
}

const char *name_of(SecondSource source) { return source == SecondSource::Moon ? "moon" : "earth"; }

bool has_magnitude_limit(const LightCurveSample &sample) {
  return sample.magnitude >= faintest_magnitude ||
         (!std::isnan(sample.magnitude) && !is_known(sample.intensity, sample.half_width));
}

ShownMagnitude shown_magnitude(const BandResult &light, const PhotometricBand &colour,
                               const LightPath &path) {
  if (!(path.sunlit > 0))
    return {observed_light(light.stokes.i, colour, path).magnitude, false};
  const bool is_told = is_known(light.stokes.i, light.half_width);
  const double told = light.stokes.i + (is_told ? 0 : light.half_width.i);
  const double magnitude = observed_light(told, colour, path).magnitude;
  // fmin takes the limit for the NaN of tails that underflow, too.
  return {std::fmin(magnitude, faintest_magnitude), !is_told || !(magnitude < faintest_magnitude)};
}

LightCurveSample sample_from(const BandResult &band, const PhotometricBand &colour,
                             const ObservingGeometry &geometry, const LightCurveRequest &request,
                             bool is_dark) {
  const PolarizationFrame frame = request.frame;
  LightCurveSample out;
  out.intensity = band.stokes.i;
  out.half_width = band.half_width;
  const LightPath path{geometry.sun_distance_km, geometry.range_km,
                       sunlight(request, geometry, colour.band)};
  const ObservedLight observed = observed_light(band.stokes.i, colour, path);
  out.irradiance = observed.irradiance;
  out.magnitude = is_dark ? observed.magnitude : shown_magnitude(band, colour, path).magnitude;
  if (is_dark || !(band.stokes.i > 0)) {
    out.sky = {nan, nan, nan, nan};
    out.scattering = {nan, nan, nan, nan};
    out.p = out.dop = out.pa_deg = nan;
    return out;
  }
  out.scattering = band.stokes * (1 / band.stokes.i);
  const Angle axis = frame == PolarizationFrame::Equatorial ? geometry.pa_scat_equatorial
                     : frame == PolarizationFrame::AltAz    ? geometry.pa_scat_altaz
                                                            : Angle();
  out.sky = rotate_to<SkyNorth>(out.scattering, Angle::radians(-axis.radians()));
  const auto &s = out.scattering;
  out.p = std::sqrt(s.q * s.q + s.u * s.u);
  out.dop = std::sqrt(s.q * s.q + s.u * s.u + s.v * s.v);
  out.pa_deg = position_angle_deg(out.sky.q, out.sky.u);
  return out;
}

} // namespace umov
