#include <umov/io/keyframe.h>

#include "io/report/colours.h"

#include <algorithm>
#include <cmath>

namespace umov {
namespace {

constexpr Rgb sky{10, 12, 18};
constexpr Rgb unlit_far{26, 32, 48}, unlit_near{58, 70, 100}; // edge-on and face-on
constexpr double knee = 0.02; // share of white where asinh turns from linear to logarithmic

double tone_of(double radiance, double white) {
  return std::min(1., std::asinh(radiance / (knee * white)) / std::asinh(1 / knee));
}

Rgb intensity_rgb(const KeyFrameSample &s, double white) {
  const Rgb ground = mix(unlit_far, unlit_near, s.facing);
  const double tone = tone_of(s.radiance, white);
  // Hue tells light from no light: slate is unlit, warm grey is reflected sunlight.
  return mix(ground, {255, 250, 240}, tone);
}

Rgb sample_rgb(const KeyFrameSample &s, KeyFrameShading shading, double white) {
  if (s.material == no_index)
    return sky;
  switch (shading) {
  case KeyFrameShading::Intensity:
    return intensity_rgb(s, white);
  case KeyFrameShading::Polarization:
    return std::isnan(s.p) ? mix(unlit_far, unlit_near, s.facing) : polarization_rgb(s.p);
  case KeyFrameShading::Material:
    break;
  }
  const double shadow = s.is_lit ? 1 : 0.45;
  return mix(sky, material_rgb(s.material), (0.5 + 0.5 * s.facing) * shadow);
}

/// Mean over the samples of each pixel.
template <class Colour>
std::vector<std::uint8_t> pixels(std::size_t side, std::size_t samples, Colour &&colour) {
  const std::size_t size = side / samples;
  std::vector<std::uint8_t> out(3 * size * size);
  for (std::size_t y = 0; y < size; ++y)
    for (std::size_t x = 0; x < size; ++x) {
      Rgb sum{};
      for (std::size_t i = 0; i < samples * samples; ++i) {
        const std::size_t row = y * samples + i / samples, column = x * samples + i % samples;
        const Rgb c = colour(row * side + column);
        for (std::size_t k = 0; k < 3; ++k)
          sum[k] += c[k];
      }
      for (std::size_t k = 0; k < 3; ++k)
        out[3 * (y * size + x) + k] =
            static_cast<std::uint8_t>(std::lround(sum[k] / static_cast<double>(samples * samples)));
    }
  return out;
}

} // namespace

double common_exposure(std::span<const KeyFrameRaster> rasters) {
  std::vector<float> lit;
  for (const KeyFrameRaster &raster : rasters)
    for (const KeyFrameSample &s : raster.points)
      if (s.radiance > 0)
        lit.push_back(s.radiance);
  if (lit.empty())
    return 1;
  const std::size_t rank = std::min(lit.size() - 1, lit.size() * 99 / 100);
  std::nth_element(lit.begin(), lit.begin() + static_cast<std::ptrdiff_t>(rank), lit.end());
  return lit[rank];
}

std::vector<std::uint8_t> shade(const KeyFrameRaster &raster, KeyFrameShading shading,
                                double white) {
  return pixels(raster.side, raster.samples,
                [&](std::size_t i) { return sample_rgb(raster.points[i], shading, white); });
}

Result<std::vector<std::uint8_t>> shade_colour(std::span<const KeyFrameRaster> red_green_blue,
                                               double white) {
  if (red_green_blue.size() != 3)
    return fail(ErrorCode::BadInput, "a picture in colour takes three bands");
  const KeyFrameRaster &first = red_green_blue[0];
  for (const KeyFrameRaster &raster : red_green_blue)
    if (raster.side != first.side || raster.samples != first.samples)
      return fail(ErrorCode::BadInput, "the bands of a picture in colour differ in size");
  return pixels(first.side, first.samples, [&](std::size_t i) {
    Rgb out = sky;
    if (first.points[i].material == no_index)
      return out;
    const Rgb ground = mix(unlit_far, unlit_near, first.points[i].facing);
    for (std::size_t k = 0; k < 3; ++k) {
      const double tone = tone_of(red_green_blue[k].points[i].radiance, white);
      out[k] = ground[k] * (1 - tone) + 255 * tone;
    }
    return out;
  });
}

void apply_polarizer(KeyFrameRaster &raster, bool is_perpendicular) {
  for (KeyFrameSample &s : raster.points) {
    const float q = is_perpendicular ? s.q : -s.q;
    s.radiance *= (1 + q) / 2;
    if (s.radiance > 0) {
      s.q = is_perpendicular ? 1.f : -1.f;
      s.u = 0;
      s.p = 1;
    }
  }
}

} // namespace umov
