#pragma once
// Counts of a star or a trail from a frame.

#include <umov/instrument/raw_frame.h>

namespace umov {

/// A point of a frame [px].
struct FramePoint {
  double x = 0, y = 0;
};

/// Where counts are summed: pixels whose centre lies within a radius of the path of the image's
/// centre, the sky in a ring about it.
struct FrameAperture {
  std::vector<FramePoint> path;                      ///< one point, or a trail
  double radius = 0, ring_inner = 0, ring_outer = 0; ///< [px]
};

/// Of one place of the mosaic, or of all pixels.
struct FrameSum {
  double electrons = 0; ///< in the aperture, sky included
  double adu = 0;       ///< the same as numbers, the bias taken off
  double sky = 0;       ///< of them, by the ring
  double sky_sd = 0;    ///< standard deviation of that
  double pixels = 0, ring_pixels = 0;
  bool is_saturated = false;
};

/// Sums a frame; `is_mosaic`: each place by itself, else the first holds all. `masked`: light
/// other than the object's, whose pixels are left out of the ring where it is not 0; may be empty.
std::array<FrameSum, 4> sum_frame(const Detector &detector, const RawFrame &frame,
                                  const FrameAperture &aperture, bool is_mosaic,
                                  const PixelFrame &masked);
/// Part of the light of a frame that counts less sky hold: that in the aperture, less what the
/// wings put into the ring and is taken for sky (4e-5 of a trail's light). `masked` as in
/// sum_frame.
double share_of(const PixelFrame &light, double whole, const FrameAperture &aperture,
                const PixelFrame &masked = {});
/// Light within an aperture.
double light_in(const PixelFrame &light, const FrameAperture &aperture);

/// A star fitted by its image: what a mosaic's places hold does not depend on where between its
/// pixels the star stands.
struct StarFit {
  FramePoint centre;
  LatticeValues electrons{};  ///< of the whole star, as if all pixels were of the place
  LatticeValues variance{};   ///< of them, the sky's share and the place's in it
  LatticeValues background{}; ///< electrons of a pixel
  bool is_saturated = false, has_converged = false;
};
/// Fits place, brightness and background by least squares with the variance of the model, in a box
/// of `radius` about `start`. `image`: the star's.
StarFit fit_star(const Detector &detector, const RawFrame &frame, const PixelImage &image,
                 const FramePoint &start, double radius, bool is_mosaic);

} // namespace umov
