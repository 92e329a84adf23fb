#pragma once
// Half-widths of what is derived from Stokes parameters, for tables and figures alike.

#include <algorithm>
#include <cmath>
#include <umov/core/quantity.h>
#include <umov/lightcurve/compute.h>

namespace umov {

/// Position angle of the normal of the scattering plane in a frame.
inline Angle scattering_axis(const ObservingGeometry &g, PolarizationFrame frame) {
  return frame == PolarizationFrame::AltAz        ? g.pa_scat_altaz
         : frame == PolarizationFrame::Scattering ? Angle()
                                                  : g.pa_scat_equatorial;
}

/// Half-widths of the derived numbers, in the frame of their values: those of Stokes parameters in
/// the scattering frame, carried over to first order, all at their worst together.
class DerivedErrors {
public:
  /// Of a sample, which must live.
  explicit DerivedErrors(const LightCurveSample &s) : s_(s), i_(s.half_width.i / s.intensity) {}

  /// Of the magnitude.
  [[nodiscard]] double mag() const { return 2.5 * std::log10(1 + i_); }
  /// Of q or u: the axes of the sky stand at `cosine`, `sine` of twice the angle from Q.
  [[nodiscard]] double part(double value, double cosine, double sine) const {
    return (std::abs(cosine) * s_.half_width.q + std::abs(sine) * s_.half_width.u) / s_.intensity +
           std::abs(value) * i_;
  }
  /// Of V/I.
  [[nodiscard]] double v() const {
    return s_.half_width.v / s_.intensity + std::abs(s_.sky.v) * i_;
  }
  /// Of the degree of linear polarization.
  [[nodiscard]] double p() const {
    return s_.p > 0 ? part(s_.p, s_.scattering.q / s_.p, s_.scattering.u / s_.p) : part(0, 1, 1);
  }
  /// Of the position angle; 90 where nothing is known of it.
  [[nodiscard]] double pa_deg() const {
    const double across = part(0, s_.scattering.u / s_.p, s_.scattering.q / s_.p);
    return std::min(90.0, 0.5 * std::atan2(across, s_.p) * (180 / pi));
  }

private:
  const LightCurveSample &s_;
  double i_; ///< of I, relative
};

} // namespace umov
