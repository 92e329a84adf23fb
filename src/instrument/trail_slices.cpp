#include <umov/instrument/trail_slices.h>

#include <algorithm>
#include <cmath>

namespace umov {
namespace {

/// How far along a path the nearest of its points is, and how far from it, squared.
struct Along {
  double distance = 0, squared = 0;
};

Along along(const FramePoint &p, const std::vector<FramePoint> &path) {
  Along out{0, std::pow(p.x - path.front().x, 2) + std::pow(p.y - path.front().y, 2)};
  double before = 0;
  for (std::size_t k = 1; k < path.size(); ++k) {
    const FramePoint &a = path[k - 1];
    const double dx = path[k].x - a.x, dy = path[k].y - a.y, length = std::hypot(dx, dy);
    if (!(length > 0))
      continue;
    const double t = std::clamp(((p.x - a.x) * dx + (p.y - a.y) * dy) / (length * length), 0., 1.);
    const double squared = std::pow(p.x - a.x - t * dx, 2) + std::pow(p.y - a.y - t * dy, 2);
    if (squared < out.squared)
      out = {before + t * length, squared};
    before += length;
  }
  return out;
}

double length_of(const std::vector<FramePoint> &path) {
  double out = 0;
  for (std::size_t k = 1; k < path.size(); ++k)
    out += std::hypot(path[k].x - path[k - 1].x, path[k].y - path[k - 1].y);
  return out;
}

} // namespace

TrailSlices cut_trail(const FrameAperture &aperture, int columns, int rows, double length_px) {
  TrailSlices out;
  out.columns = columns;
  out.rows = rows;
  out.of_pixel.assign(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows), -1);
  const double length = length_of(aperture.path);
  out.count = static_cast<std::size_t>(std::max(1., std::floor(length / length_px)));
  out.pixels.assign(out.count, 0);
  const double r2 = aperture.radius * aperture.radius;
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column) {
      const Along found = along({double(column), double(row)}, aperture.path);
      if (found.squared > r2)
        continue;
      const double part = length > 0 ? found.distance / length : 0;
      const std::size_t piece =
          std::min(out.count - 1, static_cast<std::size_t>(part * static_cast<double>(out.count)));
      out.of_pixel[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
                   static_cast<std::size_t>(column)] = static_cast<std::int32_t>(piece);
      ++out.pixels[piece];
    }
  return out;
}

std::vector<std::array<FrameSum, 4>> sum_slices(const Detector &d, const RawFrame &frame,
                                                const TrailSlices &slices, bool is_mosaic,
                                                const std::array<FrameSum, 4> &whole) {
  std::vector<std::array<FrameSum, 4>> out(slices.count);
  for (int row = 0; row < frame.rows; ++row)
    for (int column = 0; column < frame.columns; ++column) {
      const std::size_t at =
          static_cast<std::size_t>(row) * static_cast<std::size_t>(frame.columns) +
          static_cast<std::size_t>(column);
      if (slices.of_pixel[at] < 0)
        continue;
      FrameSum &sum = out[static_cast<std::size_t>(slices.of_pixel[at])]
                         [is_mosaic ? lattice_place(column, row) : 0];
      sum.electrons += electrons_of(d, {frame.adu[at], false});
      sum.adu += frame.adu[at] - zero_adu(d);
      ++sum.pixels;
      sum.is_saturated = sum.is_saturated || std::ranges::binary_search(
                                                 frame.saturated, static_cast<std::uint32_t>(at));
    }
  for (auto &slice : out)
    for (std::size_t p = 0; p < 4; ++p) {
      const double part = whole[p].pixels > 0 ? slice[p].pixels / whole[p].pixels : 0;
      slice[p].sky = part * whole[p].sky;
      slice[p].sky_sd = part * whole[p].sky_sd;
    }
  return out;
}

std::vector<LatticeValues> shares_in(const TrailSlices &slices, const PixelImage &image,
                                     const FramePoint &at) {
  std::vector<LatticeValues> out(slices.count, LatticeValues{});
  // The star alone on the pixels that it reaches.
  const int reach = image.reach() + 1;
  const int left = std::max(0, static_cast<int>(std::floor(at.x)) - reach);
  const int top = std::max(0, static_cast<int>(std::floor(at.y)) - reach);
  const int right = std::min(slices.columns, static_cast<int>(std::ceil(at.x)) + reach + 1);
  const int bottom = std::min(slices.rows, static_cast<int>(std::ceil(at.y)) + reach + 1);
  if (right <= left || bottom <= top)
    return out;
  PixelFrame near = PixelFrame::blank(right - left, bottom - top);
  image.add(near, at.x - left, at.y - top, {1, 1, 1, 1});
  for (int row = top; row < bottom; ++row)
    for (int column = left; column < right; ++column) {
      const std::int32_t piece =
          slices.of_pixel[static_cast<std::size_t>(row) * static_cast<std::size_t>(slices.columns) +
                          static_cast<std::size_t>(column)];
      if (piece >= 0)
        out[static_cast<std::size_t>(piece)][lattice_place(column, row)] +=
            near.value[near.index(column - left, row - top)];
    }
  return out;
}

} // namespace umov
