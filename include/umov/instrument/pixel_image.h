#pragma once
// A star's image on square pixels.

#include <array>
#include <memory>
#include <umov/instrument/telescope.h>
#include <vector>

namespace umov {

/// Numbers on the pixels of a detector, row by row; x along a row, pixel (0, 0) about x = y = 0.
struct PixelFrame {
  int columns = 0, rows = 0;
  std::vector<double> value;
  /// All 0.
  static PixelFrame blank(int columns, int rows);
  /// Where a pixel stands.
  [[nodiscard]] std::size_t index(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
           static_cast<std::size_t>(column);
  }
};

/// Full widths at half maximum that an image may have [px].
inline constexpr double narrowest_image_px = 0.5, widest_image_px = 64;

/// A number for each place in a 2 x 2 mosaic, 2 (row mod 2) + column mod 2; all alike without one.
using LatticeValues = std::array<double, 4>;
/// The place of a pixel.
inline std::size_t lattice_place(int column, int row) {
  return 2 * static_cast<std::size_t>(row & 1) + static_cast<std::size_t>(column & 1);
}

/// The light of a star in each pixel (a box that answers evenly), for a star at any phase: a table
/// at fractions of a pixel, between them by cubics. Within 7e-5 of the peak for widths of 2 px or
/// more; beyond `reach` pixels, where less than 1e-5 of the light lies, there is none.
class PixelImage {
public:
  /// A width of 0.5 to 64 px.
  PixelImage(ImageProfile profile, double fwhm_px);
  /// Full width at half maximum, before pixels.
  [[nodiscard]] double fwhm_px() const { return fwhm_; }
  /// Half the side of what it covers.
  [[nodiscard]] int reach() const { return reach_; }
  /// Adds a star at (x, y); what falls beside the frame is lost.
  void add(PixelFrame &frame, double x, double y, const LatticeValues &light) const;

private:
  [[nodiscard]] const double *stamp(int phase_x, int phase_y) const;
  double fwhm_;
  int reach_, side_, steps_;  ///< pixels of a stamp's side; phases of a pixel
  std::vector<double> table_; ///< [phase y][phase x][row][column], phases from -1 to steps + 1
};

/// One image for all widths within half a per cent: made once, from any thread.
class PixelImages {
public:
  /// Of one profile.
  explicit PixelImages(ImageProfile profile);
  /// The nearest; lives as long as this.
  const PixelImage &of(double fwhm_px);

private:
  struct Store;
  ImageProfile profile_;
  std::shared_ptr<Store> store_;
};

} // namespace umov
