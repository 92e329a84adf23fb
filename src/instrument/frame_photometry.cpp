#include <umov/instrument/frame_photometry.h>

#include <algorithm>
#include <cmath>

namespace umov {
namespace {

double squared_distance(const FramePoint &p, const FramePoint &a, const FramePoint &b) {
  const double dx = b.x - a.x, dy = b.y - a.y, length2 = dx * dx + dy * dy;
  const double t =
      length2 > 0 ? std::clamp(((p.x - a.x) * dx + (p.y - a.y) * dy) / length2, 0., 1.) : 0;
  const double x = p.x - a.x - t * dx, y = p.y - a.y - t * dy;
  return x * x + y * y;
}

double squared_distance(const FramePoint &p, const std::vector<FramePoint> &path) {
  double out = squared_distance(p, path.front(), path.front());
  for (std::size_t k = 1; k < path.size(); ++k)
    out = std::min(out, squared_distance(p, path[k - 1], path[k]));
  return out;
}

/// Calls `visit(index, place, squared distance)` for the pixels within `radius` of the path.
template <class Visit>
void for_pixels(int columns, int rows, const std::vector<FramePoint> &path, double radius,
                const Visit &visit) {
  FramePoint low = path.front(), high = path.front();
  for (const FramePoint &p : path) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y)};
  }
  const auto cut = [](double x, int last) {
    return static_cast<int>(std::clamp(x, -1., static_cast<double>(last)));
  };
  for (int row = std::max(0, cut(low.y - radius, rows)); row <= cut(high.y + radius, rows - 1);
       ++row)
    for (int column = std::max(0, cut(low.x - radius, columns));
         column <= cut(high.x + radius, columns - 1); ++column) {
      const double d2 = squared_distance({double(column), double(row)}, path);
      if (d2 <= radius * radius)
        visit(static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
                  static_cast<std::size_t>(column),
              lattice_place(column, row), d2);
    }
}

bool is_full(const RawFrame &frame, std::size_t at) {
  return std::binary_search(frame.saturated.begin(), frame.saturated.end(),
                            static_cast<std::uint32_t>(at));
}

} // namespace

std::array<FrameSum, 4> sum_frame(const Detector &d, const RawFrame &frame,
                                  const FrameAperture &aperture, bool is_mosaic,
                                  const PixelFrame &masked) {
  std::array<FrameSum, 4> out{};
  std::array<double, 4> ring{}, squares{};
  const double r2 = aperture.radius * aperture.radius;
  const double inner2 = aperture.ring_inner * aperture.ring_inner;
  for_pixels(frame.columns, frame.rows, aperture.path,
             std::max(aperture.ring_outer, aperture.radius),
             [&](std::size_t at, std::size_t place, double d2) {
               const std::size_t p = is_mosaic ? place : 0;
               const double e = electrons_of(d, {frame.adu[at], false});
               if (d2 <= r2) {
                 out[p].electrons += e;
                 out[p].adu += frame.adu[at] - zero_adu(d);
                 ++out[p].pixels;
                 out[p].is_saturated = out[p].is_saturated || is_full(frame, at);
               } else if (d2 >= inner2 && (masked.value.empty() || masked.value[at] == 0)) {
                 ring[p] += e;
                 squares[p] += e * e;
                 ++out[p].ring_pixels;
               }
             });
  for (std::size_t p = 0; p < 4; ++p) {
    const double n = out[p].ring_pixels;
    if (!(n > 1)) { // an edge or a mask took the ring: the sky is not known to be 0
      out[p].sky = out[p].sky_sd = out[p].pixels > 0 ? std::nan("") : 0;
      continue;
    }
    const double mean = ring[p] / n, variance = (squares[p] - n * mean * mean) / (n - 1);
    out[p].sky = mean * out[p].pixels;
    out[p].sky_sd = out[p].pixels * std::sqrt(std::max(0., variance) / n);
  }
  return out;
}

double light_in(const PixelFrame &light, const FrameAperture &aperture) {
  double out = 0;
  for_pixels(light.columns, light.rows, aperture.path, aperture.radius,
             [&](std::size_t at, std::size_t, double) { out += light.value[at]; });
  return out;
}

double share_of(const PixelFrame &light, double whole, const FrameAperture &aperture,
                const PixelFrame &masked) {
  if (!(whole > 0))
    return 0;
  double inside = 0, ring = 0, pixels = 0, ring_pixels = 0;
  const double r2 = aperture.radius * aperture.radius;
  const double inner2 = aperture.ring_inner * aperture.ring_inner;
  for_pixels(light.columns, light.rows, aperture.path,
             std::max(aperture.ring_outer, aperture.radius),
             [&](std::size_t at, std::size_t, double d2) {
               if (d2 <= r2)
                 inside += light.value[at], ++pixels;
               else if (d2 >= inner2 && (masked.value.empty() || masked.value[at] == 0))
                 ring += light.value[at], ++ring_pixels;
             });
  return (inside - (ring_pixels > 1 ? ring / ring_pixels * pixels : 0)) / whole;
}

} // namespace umov
