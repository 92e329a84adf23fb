#include <umov/picture/keyframe.h>

#include "picture/position_angle.h"

#include <umov/picture/colours.h>

#include <algorithm>
#include <cmath>
#include <umov/core/quantity.h>
#include <umov/core/stop.h>

namespace umov {
namespace {

constexpr Rgb sky{10, 12, 18};
constexpr Rgb unlit_far{26, 32, 48}, unlit_near{58, 70, 100}; // edge-on and face-on
constexpr double knee = 0.02; // share of white where asinh turns from linear to logarithmic

double tone_of(double radiance, double white, double knee_at = knee) {
  return std::min(1., std::asinh(radiance / (knee_at * white)) / std::asinh(1 / knee_at));
}

Rgb intensity_rgb(const KeyFrameSample &s, double white) {
  const Rgb ground = mix(unlit_far, unlit_near, s.facing);
  const double tone = tone_of(s.radiance, white);
  // Hue tells light from no light: slate is unlit, warm grey is reflected sunlight.
  return mix(ground, {255, 250, 240}, tone);
}

Rgb sample_rgb(const KeyFrameSample &s, KeyFrameShading shading, double white, double pa_scat) {
  if (s.material == no_index)
    return sky;
  switch (shading) {
  case KeyFrameShading::Intensity:
    return intensity_rgb(s, white);
  case KeyFrameShading::Polarization:
    return std::isnan(s.p) ? mix(unlit_far, unlit_near, s.facing) : polarization_rgb(s.p);
  case KeyFrameShading::PositionAngle:
    return std::isnan(s.p) ? mix(unlit_far, unlit_near, s.facing)
                           : position_angle_rgb(pa_scat + std::atan2(s.u, s.q) / 2, s.p);
  case KeyFrameShading::Material:
    break;
  }
  const double shadow = s.is_lit ? 1 : 0.45;
  return mix(sky, material_rgb(s.material), (0.5 + 0.5 * s.facing) * shadow);
}

/// Mean over the samples of each pixel.
template <class Colour>
std::vector<std::uint8_t> pixels(std::size_t side, std::size_t samples,
                                 const std::atomic<bool> *cancel, Colour &&colour) {
  const std::size_t size = side / samples;
  std::vector<std::uint8_t> out(3 * size * size);
  for (std::size_t y = 0; y < size && !is_stopped(cancel); ++y)
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

Rgb position_angle_rgb(double pa_rad, double p) {
  const double chroma = 0.12 * std::min(1., p / 0.1), hue = 2 * pa_rad + 29 * pi / 180;
  const double a = chroma * std::cos(hue), b = chroma * std::sin(hue);
  const double l = std::pow(0.72 + 0.3963377774 * a + 0.2158037573 * b, 3);
  const double m = std::pow(0.72 - 0.1055613458 * a - 0.0638541728 * b, 3);
  const double s = std::pow(0.72 - 0.0894841775 * a - 1.2914855480 * b, 3);
  const auto srgb = [](double linear) {
    const double c = std::clamp(linear, 0., 1.);
    return 255 * (c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1 / 2.4) - 0.055);
  };
  return {srgb(4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s),
          srgb(-1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s),
          srgb(-0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s)};
}

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

std::vector<std::uint8_t> shade(const KeyFrameRaster &raster, KeyFrameShading shading, double white,
                                const std::atomic<bool> *cancel) {
  return pixels(raster.side, raster.samples, cancel, [&](std::size_t i) {
    return sample_rgb(raster.points[i], shading, white, raster.pa_scat_rad);
  });
}

Result<std::vector<std::uint8_t>> shade_colour(std::span<const KeyFrameRaster> red_green_blue,
                                               double white, const std::atomic<bool> *cancel) {
  if (red_green_blue.size() != 3)
    return fail(ErrorCode::BadInput, "a picture in colour takes three bands");
  const KeyFrameRaster &first = red_green_blue[0];
  for (const KeyFrameRaster &raster : red_green_blue)
    if (raster.side != first.side || raster.samples != first.samples)
      return fail(ErrorCode::BadInput, "the bands of a picture in colour differ in size");
  return pixels(first.side, first.samples, cancel, [&](std::size_t i) {
    Rgb out = sky;
    if (first.points[i].material == no_index)
      return out;
    const Rgb ground = mix(unlit_far, unlit_near, first.points[i].facing);
    for (std::size_t k = 0; k < 3; ++k) {
      // A higher knee than in grey: hues survive.
      const double tone = tone_of(red_green_blue[k].points[i].radiance, white, 0.2);
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
      s.u = s.v = 0;
      s.p = 1;
    }
  }
}

} // namespace umov
