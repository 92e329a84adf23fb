#pragma once
// Frames as a camera hands them out.

#include <umov/instrument/detector.h>
#include <umov/instrument/pixel_image.h>

namespace umov {

/// A frame that was read out.
struct RawFrame {
  int columns = 0, rows = 0;
  std::vector<std::int32_t> adu;
  std::vector<std::uint32_t> saturated; ///< pixels, in order
};

/// Draws a frame. `light`: electrons of stars and trails; `background`: those of sky and dark in
/// every pixel. Random numbers belong to rows where there is background alone, to pixels where
/// there is more; the key's pixel is not used.
RawFrame draw_frame(const Detector &detector, const PixelFrame &light,
                    const LatticeValues &background, double exposure_s, const DrawKey &key);

} // namespace umov
