#pragma once
// Private: the colours of an angle.

#include <umov/picture/colours.h>

namespace umov {

/// Colours of equal lightness round the circle (Ottosson 2020, Oklab: L = .72, chroma .12), pale
/// where there is little polarization.
Rgb position_angle_rgb(double pa_rad, double p);

} // namespace umov
