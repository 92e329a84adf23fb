#include <umov/instrument/mirrors.h>
#include <umov/instrument/telescope.h>

#include <algorithm>
#include <cmath>

namespace umov {
namespace {

constexpr double arcsec = pi / 180 / 3600;

} // namespace

double collecting_area_m2(const Telescope &t) {
  return pi / 4 * t.aperture_m * t.aperture_m * (1 - t.obstruction * t.obstruction);
}

double pixel_scale_arcsec(const Telescope &t, double pixel_um) {
  return pixel_um * 1e-6 / t.focal_length_m / arcsec;
}

Angle axis_from_zenith(const Telescope &t, Angle x_axis, Angle parallactic_angle, Angle altitude,
                       Angle azimuth) {
  if (t.mount == Mount::AltAz && !t.has_derotator)
    return x_axis;
  const Angle from_zenith = Angle::radians(x_axis.radians() - parallactic_angle.radians());
  if (t.port == TelescopePort::Train && !is_mirrored(t))
    return Angle::radians(from_zenith.radians() +
                          trace_train(t.train, {}, altitude, azimuth).zenith.radians());
  // The mirror swaps the hand and the altitude turns the image: done twice, both are undone.
  return axis_on_sky(t, from_zenith, altitude, azimuth);
}

Angle axis_on_sky(const Telescope &t, Angle axis, Angle altitude, Angle azimuth) {
  switch (t.port) {
  case TelescopePort::Train: {
    const double turned =
        axis.radians() - trace_train(t.train, {}, altitude, azimuth).zenith.radians();
    return Angle::radians(is_mirrored(t) ? -turned : turned);
  }
  case TelescopePort::NasmythRight:
    return Angle::radians(altitude.radians() - axis.radians());
  case TelescopePort::NasmythLeft:
    return Angle::radians(-altitude.radians() - axis.radians());
  case TelescopePort::Cassegrain:
    break;
  }
  return axis;
}

std::size_t port_mirrors(const Telescope &t) {
  if (t.port == TelescopePort::Train)
    return t.train.mirrors.size();
  return t.port == TelescopePort::Cassegrain ? 0 : 1;
}

bool is_mirrored(const Telescope &t) { return port_mirrors(t) % 2 == 1; }

double share_inside(ImageProfile profile, double radius_fwhm) {
  const double diameters = 2 * radius_fwhm;
  if (profile == ImageProfile::Gauss)
    return 1 - std::exp2(-diameters * diameters);
  constexpr double beta = 4.765;
  const double scale = std::exp2(1 / beta) - 1;
  return 1 - std::pow(1 + scale * diameters * diameters, 1 - beta);
}

double seeing_fwhm_arcsec(const Seeing &seeing, double nm, double airmass) {
  const double at_zenith = seeing.arcsec * std::pow(seeing.at_nm / 500, 0.2);
  const double free = at_zenith * std::pow(airmass, 0.6) * std::pow(nm / 500, -0.2);
  if (seeing.outer_scale_m <= 0)
    return free;
  const double r0 = 0.976 * nm * 1e-9 / (free * arcsec);
  // The fit is of r0 below a tenth of the outer scale; there the root is .19 at least.
  const double ratio = std::min(r0 / seeing.outer_scale_m, 0.1);
  return free * std::sqrt(1 - 2.183 * std::pow(ratio, 0.356));
}

double trail_length_px(double rate_rad_s, double exposure_s, double arcsec_per_px) {
  return rate_rad_s / arcsec * exposure_s / arcsec_per_px;
}

} // namespace umov
