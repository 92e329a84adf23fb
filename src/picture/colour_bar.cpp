#include <umov/picture/keyframe.h>

#include "picture/position_angle.h"

#include <array>
#include <cmath>
#include <string_view>
#include <umov/core/quantity.h>

namespace umov {
namespace {

/// Letters of 3 x 5 points, rows from the top, the left one of a row in the highest of three bits.
constexpr std::string_view letters = "0123456789%o"; // o: degrees
constexpr std::array<std::array<std::uint8_t, 5>, 12> shapes{{{7, 5, 5, 5, 7},
                                                              {2, 6, 2, 2, 7},
                                                              {7, 1, 7, 4, 7},
                                                              {7, 1, 3, 1, 7},
                                                              {5, 5, 7, 1, 1},
                                                              {7, 4, 7, 1, 7},
                                                              {7, 4, 7, 5, 7},
                                                              {7, 1, 2, 2, 2},
                                                              {7, 5, 7, 5, 7},
                                                              {7, 5, 7, 1, 7},
                                                              {5, 1, 2, 4, 5},
                                                              {7, 5, 7, 0, 0}}};
constexpr Rgb ink{225, 228, 235};

struct Canvas {
  std::span<std::uint8_t> rgb;
  std::uint32_t side;

  void fill(std::uint32_t x, std::uint32_t y, std::uint32_t width, std::uint32_t height,
            Rgb colour) {
    for (std::uint32_t row = y; row < std::min(y + height, side); ++row)
      for (std::uint32_t column = x; column < std::min(x + width, side); ++column)
        for (std::size_t k = 0; k < 3; ++k)
          rgb[3 * (std::size_t{row} * side + column) + k] =
              static_cast<std::uint8_t>(std::lround(colour[k]));
  }
  void write(std::uint32_t x, std::uint32_t y, std::uint32_t point, std::string_view text) {
    for (const char letter : text) {
      const auto &shape = shapes[letters.find(letter)];
      for (std::uint32_t row = 0; row < 5; ++row)
        for (std::uint32_t column = 0; column < 3; ++column)
          if ((shape[row] >> (2 - column) & 1) != 0)
            fill(x + column * point, y + row * point, point, point, ink);
      x += 4 * point;
    }
  }
};

} // namespace

void draw_colour_bar(std::span<std::uint8_t> rgb, std::uint32_t side, KeyFrameShading shading) {
  const bool is_angle = shading == KeyFrameShading::PositionAngle;
  constexpr std::uint32_t side_min = 160; // below, the letters would reach the object
  if ((!is_angle && shading != KeyFrameShading::Polarization) || side < side_min)
    return;
  Canvas canvas{rgb, side};
  // The corner that a round object leaves free.
  const std::uint32_t left = side / 50, top = side * 3 / 4, height = side * 11 / 50,
                      width = side / 40, point = std::max(1u, side / 320);
  for (std::uint32_t row = 0; row < height; ++row) {
    const double value = 1 - (row + 0.5) / height;
    canvas.fill(left, top + row, width, 1,
                is_angle ? position_angle_rgb(pi * value, 1) : polarization_rgb(value));
  }
  const std::array<std::string_view, 3> texts =
      is_angle ? std::array<std::string_view, 3>{"180o", "90", "0"}
               : std::array<std::string_view, 3>{"100%", "50", "0"};
  for (std::uint32_t k = 0; k < 3; ++k)
    canvas.write(left + width + 2 * point, top + k * (height - 5 * point) / 2, point, texts[k]);
}

} // namespace umov
