#pragma once
// A trail as a light curve: cut across into pieces as long as a star is wide.

#include <umov/instrument/frame_photometry.h>
#include <umov/instrument/pixel_image.h>

namespace umov {

/// The pixels of an aperture about a trail, piece by piece along it.
struct TrailSlices {
  std::size_t count = 1;
  int columns = 0, rows = 0;
  std::vector<std::int32_t> of_pixel; ///< the piece of each, -1 outside
  std::vector<double> pixels;         ///< of each piece
};
/// Cuts an aperture into pieces of `length_px` or a little more, as many as fit; one where the
/// trail is shorter. What lies beyond an end belongs to the first or last piece.
TrailSlices cut_trail(const FrameAperture &aperture, int columns, int rows, double length_px);

/// What each piece holds, as `sum_frame`; `whole`: of the aperture, whose ring tells the sky.
std::vector<std::array<FrameSum, 4>> sum_slices(const Detector &detector, const RawFrame &frame,
                                                const TrailSlices &slices, bool is_mosaic,
                                                const std::array<FrameSum, 4> &whole);
/// Shares of a star's light, the star at `at`, that fall into each piece: on the pixels of each
/// place of a mosaic.
std::vector<LatticeValues> shares_in(const TrailSlices &slices, const PixelImage &image,
                                     const FramePoint &at);

} // namespace umov
