#pragma once
#include <string>
#include <umov/core/quantity.h>
#include <umov/optics/index.h>
#include <vector>

namespace umov {

/// Where the light leaves the telescope; `Train`: behind further mirrors.
enum class TelescopePort { Cassegrain, NasmythLeft, NasmythRight, Train };
/// Where a beam goes: in the fork of an alt-azimuth mount, which turns with the azimuth (left and
/// right of who looks towards the azimuth), or over the ground. Up and down are the same in both.
enum class BeamDirection { Up, Down, Left, Right, Forward, Back, North, East, South, West };
/// A flat mirror of a train.
struct TrainMirror {
  BeamDirection to = BeamDirection::Right; ///< of the light behind it
  std::string index;                       ///< of its metal; empty: the telescope's `mirror`
};
/// The mirrors behind the telescope's own two.
struct MirrorTrain {
  std::vector<TrainMirror> mirrors;
  BeamDirection x_from = BeamDirection::Up; ///< from which the instrument's x axis is counted
};
/// What carries it.
enum class Mount { AltAz, Equatorial };

/// What the telescope follows while it exposes.
enum class Tracking { Satellite, Sidereal, Fixed };

/// A telescope.
struct Telescope {
  double aperture_m = 0;
  double obstruction = 0; ///< of the diameter
  double focal_length_m = 0;
  Tabulated throughput{{}, {1}}; ///< optics times detector, without polarizers, against wavelength
  TelescopePort port = TelescopePort::Cassegrain;
  std::string mirror = "Al_Rakic"; ///< index of the flat mirrors of its port
  MirrorTrain train;               ///< of the port `Train`
  Mount mount = Mount::AltAz;
  bool has_derotator = false; ///< turns the whole instrument with the sky
  Tracking tracking = Tracking::Satellite;
  double tracking_error_arcsec = 1; ///< of each exposure, standard deviation in x and in y
};

/// Light-collecting area [m2].
double collecting_area_m2(const Telescope &telescope);
/// Scale of the image [arcsec/px].
double pixel_scale_arcsec(const Telescope &telescope, double pixel_um);
/// Angle of the instrument's x axis in the focus: from the zenith direction, at a Nasmyth port from
/// the vertical there, in its mirrored image. `parallactic_angle`: of the zenith from the pole;
/// `altitude` and `azimuth`: where the telescope points; the azimuth matters to trains that end on
/// the ground.
Angle axis_from_zenith(const Telescope &telescope, Angle x_axis, Angle parallactic_angle,
                       Angle altitude, Angle azimuth = {});
/// Where on the sky that axis lies, from the zenith direction.
Angle axis_on_sky(const Telescope &telescope, Angle axis_from_zenith, Angle altitude,
                  Angle azimuth = {});
/// Flat mirrors between the telescope's own two and the focus.
std::size_t port_mirrors(const Telescope &telescope);
/// An odd number of mirrors shows the sky with the other hand.
bool is_mirrored(const Telescope &telescope);

/// Profile of a star's image.
enum class ImageProfile { Gauss, Moffat }; ///< Moffat with exponent 4.765 (Trujillo et al. 2001)

/// Share of the light within a radius, in full widths at half maximum.
double share_inside(ImageProfile profile, double radius_fwhm);
/// The same within a radius of the path of an image that runs evenly along `length_fwhm`.
double share_along(ImageProfile profile, double radius_fwhm, double length_fwhm);
/// Share of the light that falls on a square full width where it is brightest, per square width, of
/// an image that runs evenly along `length_fwhm`; a point where that is 0.
double peak_along(ImageProfile profile, double length_fwhm);

/// The seeing at the zenith.
struct Seeing {
  double arcsec = 1, at_nm = 500;
  double outer_scale_m = 0; ///< 0: infinite
  ImageProfile profile = ImageProfile::Moffat;
};

/// Full width at half maximum through an air mass [arcsec]: X^0.6 lambda^-0.2, narrower by the
/// outer scale (Tokovinin 2002, PASP 114, 1156, Eq. 19).
double seeing_fwhm_arcsec(const Seeing &seeing, double nm, double airmass);

/// Length of a trail [px] of an object that moves by `rate_rad_s` over the detector: against the
/// stars where those are followed, against the horizon where nothing is.
double trail_length_px(double rate_rad_s, double exposure_s, double arcsec_per_px);

} // namespace umov
