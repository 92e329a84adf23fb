#include "paper/pictures.h"

#include <cmath>
#include <umov/io/png.h>

namespace umov {
namespace {

/// Rasters in red, green and blue light.
Result<std::vector<KeyFrameRaster>> trace_colours(const Scene &scene, const PictureView &view,
                                                  unsigned threads) {
  constexpr std::size_t red_green_blue[] = {2, 1, 0};
  KeyFrameOptions options;
  options.size = view.size;
  options.samples = 3;
  options.half_width_m = view.half_width_m;
  options.threads = threads;
  return trace_key_frames(scene, Occluder(scene.mesh),
                          {{normalized(view.sun), normalized(view.observer)}, view.up}, options,
                          red_green_blue);
}

} // namespace

PictureView view_from(Vec3<Body> observer, Vec3<Body> up, double phase_deg, double sun_side_deg) {
  const Vec3<Body> v = normalized(observer), y = normalized(up - v * dot(up, v)), x = cross(y, v);
  const Vec3<Body> side = x * std::cos(sun_side_deg * degree) + y * std::sin(sun_side_deg * degree);
  return {v * std::cos(phase_deg * degree) + side * std::sin(phase_deg * degree), v, up};
}

Result<std::string> picture_png(const Scene &scene, const PictureView &view, PictureStyle style,
                                unsigned threads) {
  UMOV_ASSIGN(colours, trace_colours(scene, view, threads));
  const double white = common_exposure(colours);
  if (style == PictureStyle::Colour) {
    UMOV_ASSIGN(rgb, shade_colour(colours, white));
    return encode_png(view.size, view.size, rgb);
  }
  const KeyFrameShading shading = style == PictureStyle::Intensity ? KeyFrameShading::Intensity
                                  : style == PictureStyle::Polarization
                                      ? KeyFrameShading::Polarization
                                      : KeyFrameShading::Material;
  return encode_png(view.size, view.size, shade(colours[1], shading, white));
}

Result<std::string> picture_through_polarizer(const Scene &scene, const PictureView &view,
                                              bool is_perpendicular, unsigned threads) {
  UMOV_ASSIGN(colours, trace_colours(scene, view, threads));
  const double white = common_exposure(colours) / 2; // an ideal polarizer halves unpolarized light
  for (KeyFrameRaster &raster : colours)
    apply_polarizer(raster, is_perpendicular);
  UMOV_ASSIGN(rgb, shade_colour(colours, white));
  return encode_png(view.size, view.size, rgb);
}

} // namespace umov
