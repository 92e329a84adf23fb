#pragma once
// Colours shared by the pictures and the page.

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace umov {

using Rgb = std::array<double, 3>; ///< sRGB, 0..255

/// "#rrggbb".
std::string hex(Rgb colour);
/// "#rrggbb" of the i-th material in pictures and plots: Okabe & Ito (2008), lighter again after
/// seven.
std::string material_colour(std::size_t index);

/// Colours of p = 0, 1/8, ... 1 ("#rrggbb"): viridis (Smith & van der Walt 2015, CC0).
std::vector<std::string> polarization_scale();
/// As material_colour, for lines on white: yellow, which would be lost there, is olive.
std::string plot_colour(std::size_t index);
/// As material_colour, in numbers.
Rgb material_rgb(std::size_t index);
/// The map of p, linear between its nine colours; p is clamped to 0..1.
Rgb polarization_rgb(double p);
/// Between two colours, linear in sRGB.
Rgb mix(Rgb a, Rgb b, double share_of_b);

} // namespace umov
