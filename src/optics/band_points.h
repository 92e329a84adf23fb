#pragma once
// Private: the points that integrals over a band are summed at.

#include <umov/optics/passband.h>

namespace umov {

struct BandPoint {
  double wavelength_nm = 0;
  double weight = 0; ///< response times step (trapezoid)
};

/// The points of the curve, those of the solar spectrum and of `also_at` within it, in their order:
/// curves have one every 10 nm, between which a product of two is not linear.
std::vector<BandPoint> band_points(const Passband &band, const std::vector<double> &also_at);

} // namespace umov
