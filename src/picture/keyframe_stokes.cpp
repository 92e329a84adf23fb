#include <umov/picture/keyframe.h>

#include <umov/optics/stokes.h>

namespace umov {

std::vector<PictureChannel> stokes_channels(const KeyFrameRaster &raster,
                                            const std::string &prefix) {
  const std::size_t samples = raster.samples, size = raster.side / samples;
  std::vector<PictureChannel> out;
  for (const char *name : {"I", "Q", "U", "V", "A"})
    out.push_back({prefix + name, std::vector<float>(size * size)});
  const float share = 1.f / static_cast<float>(samples * samples);
  for (std::size_t row = 0; row < raster.side; ++row)
    for (std::size_t column = 0; column < raster.side; ++column) {
      const KeyFrameSample &s = raster.points[row * raster.side + column];
      if (s.material == no_index)
        continue;
      const std::size_t pixel = row / samples * size + column / samples;
      const Stokes<ScatteringPlane> at{s.radiance, s.radiance * s.q, s.radiance * s.u,
                                       s.radiance * s.v};
      const auto sky = rotate_to<SkyNorth>(at, Angle::radians(-raster.pa_scat_rad));
      const double parts[] = {sky.i, sky.q, sky.u, sky.v, 1};
      for (std::size_t k = 0; k < 5; ++k)
        out[k].values[pixel] += share * static_cast<float>(parts[k]);
    }
  return out;
}

} // namespace umov
