#include <umov/instrument/mirrors.h>
#include <umov/instrument/telescope.h>

#include <algorithm>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>

namespace umov {
namespace {

constexpr double arcsec = pi / 180 / 3600;
constexpr double moffat_beta = 4.765; // Trujillo et al. 2001

/// The profile's square is this many times that of its width where it falls to half: 1 at half a
/// width, for both profiles.
double moffat_scale() { return std::exp2(1 / moffat_beta) - 1; }

/// Radius [full widths] that holds a share of the light.
double radius_of(ImageProfile profile, double share) {
  const double square = profile == ImageProfile::Gauss
                            ? -std::log2(1 - share)
                            : (std::pow(1 - share, 1 / (1 - moffat_beta)) - 1) / moffat_scale();
  return std::sqrt(square) / 2;
}

using Quadrature = boost::math::quadrature::gauss<double, 20>;

/// Light at the distance rho beyond the radius r from a point that runs along L: its share, over
/// that circle and the run, that is within r of the path. Where it lies at (rho cos a, rho sin a)
/// from the point, the path's neighbourhood takes it until it is cos a rho - sqrt(r^2 - rho^2
/// sin^2 a) from an end.
double taken_by_path(double rho, double r, double length) {
  const double cosine = (rho * rho - length * length - r * r) / (2 * length * r);
  const double at_end = std::sqrt(std::max(0.0, 1 - cosine * cosine));
  const double widest = std::asin(std::min(1.0, r / rho * (cosine > 0 ? at_end : 1)));
  const auto taken = [&](double angle) {
    const double across = rho * std::sin(angle);
    return 1 - (rho * std::cos(angle) - std::sqrt(std::max(0.0, r * r - across * across))) / length;
  };
  return 2 / pi * Quadrature::integrate(taken, 0., widest);
}

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
  return 1 - std::pow(1 + moffat_scale() * diameters * diameters, 1 - moffat_beta);
}

double share_along(ImageProfile profile, double r, double length) {
  double out = share_inside(profile, r);
  if (!(length > 0))
    return out;
  // Beyond a right angle's distance the far end of the path begins to lose it too.
  double from = out;
  for (const double reach : {std::hypot(r, length), r + length}) {
    const double to = share_inside(profile, reach);
    if (to > from)
      out += Quadrature::integrate(
          [&](double share) { return taken_by_path(radius_of(profile, share), r, length); }, from,
          to);
    from = to;
  }
  return out;
}

double peak_along(ImageProfile profile, double length) {
  const bool is_gauss = profile == ImageProfile::Gauss;
  const double point =
      is_gauss ? 4 * std::log(2.) / pi : 4 * moffat_scale() * (moffat_beta - 1) / pi;
  if (!(length > 0))
    return point;
  constexpr double edge = 4; // widths: a hundred-thousandth of the light is farther away
  const double half = length / 2;
  const auto along = [&](double x) {
    return is_gauss ? std::exp2(-4 * x * x)
                    : std::pow(1 + moffat_scale() * 4 * x * x, -moffat_beta);
  };
  return point * Quadrature::integrate(along, 0., std::min(half, edge)) / half;
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
