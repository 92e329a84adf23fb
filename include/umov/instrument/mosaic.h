#pragma once
// A star on a mosaic of analysers: each orientation samples the image at every second pixel.

#include <umov/instrument/telescope.h>

namespace umov {

/// False polarization of an unpolarized star whose light is summed over each orientation.
struct MosaicAlias {
  double q = 0, u = 0;
};

/// Strength of the alias of a Gaussian image of `fwhm_px` on square pixels.
double mosaic_alias_strength(double fwhm_px);
/// Of a star at (x, y) [px] for the layout 90 45 / 135 0, pixel (0, 0) first.
MosaicAlias mosaic_alias(double fwhm_px, double x_px, double y_px);
/// What a drift along a row or column by `length_px` leaves of it.
double drift_factor(double length_px);
/// Largest false q or u of a star whose light is summed in the pixels within `radius_px`, wherever
/// on its pixels it stands: what sampling does, and an edge that cuts each orientation elsewhere.
double mosaic_aperture_alias(ImageProfile profile, double fwhm_px, double radius_px);

} // namespace umov
