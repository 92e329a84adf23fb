#include <umov/instrument/pixel_image.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>

namespace umov {
namespace {

constexpr double moffat_exponent = 4.765; // Trujillo et al. 2001

/// Light per square pixel at a distance from the centre, for the whole of 1.
double surface(ImageProfile profile, double fwhm, double r2) {
  const double f2 = fwhm * fwhm;
  if (profile == ImageProfile::Gauss)
    return 4 * std::log(2.) / (pi * f2) * std::exp(-4 * std::log(2.) * r2 / f2);
  const double scale = 4 * (std::exp2(1 / moffat_exponent) - 1) / f2;
  return scale * (moffat_exponent - 1) / pi * std::pow(1 + scale * r2, -moffat_exponent);
}

/// Sums of the light from the corner of a square to each line of a fine grid: that of any box is
/// four of them.
class LightSums {
public:
  LightSums(ImageProfile profile, double fwhm, int half_cells, double cell)
      : half_(half_cells), side_(2 * half_cells + 1),
        sum_(static_cast<std::size_t>(side_) * static_cast<std::size_t>(side_)) {
    const std::vector<double> quadrant = cells(profile, fwhm, cell);
    for (int y = 1; y < side_; ++y) {
      double row = 0;
      for (int x = 1; x < side_; ++x) {
        row += quadrant[at_cell(x - 1 - half_) + at_cell(y - 1 - half_) * unsigned(half_)];
        sum_[index(x, y)] = sum_[index(x, y - 1)] + row;
      }
    }
  }
  /// Of the cells [x0, x1) by [y0, y1), counted from the centre.
  [[nodiscard]] double box(int x0, int x1, int y0, int y1) const {
    const auto at = [&](int x, int y) { return sum_[index(x + half_, y + half_)]; };
    return at(x1, y1) - at(x0, y1) - at(x1, y0) + at(x0, y0);
  }

private:
  /// Light of the cells of one quadrant, by two Gauss points each way: the others mirror it.
  [[nodiscard]] std::vector<double> cells(ImageProfile profile, double fwhm, double cell) const {
    const double reach = cell / std::sqrt(12.);
    std::vector<double> out;
    for (int y = 0; y < half_; ++y)
      for (int x = 0; x < half_; ++x) {
        double sum = 0;
        for (const double dy : {-reach, reach})
          for (const double dx : {-reach, reach}) {
            const double px = (x + .5) * cell + dx, py = (y + .5) * cell + dy;
            sum += surface(profile, fwhm, px * px + py * py);
          }
        out.push_back(sum * cell * cell / 4);
      }
    return out;
  }
  [[nodiscard]] static std::size_t at_cell(int k) {
    return static_cast<std::size_t>(k < 0 ? -1 - k : k);
  }
  [[nodiscard]] std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(side_) +
           static_cast<std::size_t>(x);
  }
  int half_, side_;
  std::vector<double> sum_;
};

/// Steps of a pixel: an even number, so that a pixel's edge lies on the grid.
int steps_for(double fwhm) { return 2 * std::clamp(static_cast<int>(std::ceil(8 / fwhm)), 1, 4); }

/// Weights of four equal steps -1, 0, 1, 2 at t in [0, 1).
std::array<double, 4> cubic(double t) {
  return {-t * (t - 1) * (t - 2) / 6, (t + 1) * (t - 1) * (t - 2) / 2, -(t + 1) * t * (t - 2) / 2,
          (t + 1) * t * (t - 1) / 6};
}

} // namespace

PixelFrame PixelFrame::blank(int columns, int rows) {
  return {columns, rows,
          std::vector<double>(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows))};
}

PixelImage::PixelImage(ImageProfile profile, double fwhm_px)
    : fwhm_(std::clamp(fwhm_px, narrowest_image_px, widest_image_px)) {
  // A Moffat image of this exponent has 7e-6 of its light beyond six widths.
  const double widths = profile == ImageProfile::Gauss ? 2.2 : 6;
  reach_ = static_cast<int>(std::ceil(widths * fwhm_)) + 1;
  side_ = 2 * reach_ + 1;
  steps_ = steps_for(fwhm_);
  const LightSums sums(profile, fwhm_, (reach_ + 3) * steps_, 1. / steps_);
  const int phases = steps_ + 3, half = steps_ / 2;
  table_.reserve(static_cast<std::size_t>(phases * phases) *
                 static_cast<std::size_t>(side_ * side_));
  for (int py = -1; py < steps_ + 2; ++py)
    for (int px = -1; px < steps_ + 2; ++px)
      for (int row = -reach_; row <= reach_; ++row)
        for (int column = -reach_; column <= reach_; ++column) {
          const int x = column * steps_ - px, y = row * steps_ - py;
          table_.push_back(sums.box(x - half, x + half, y - half, y + half));
        }
}

const double *PixelImage::stamp(int phase_x, int phase_y) const {
  const int at = (phase_y + 1) * (steps_ + 3) + phase_x + 1;
  return table_.data() + static_cast<std::size_t>(at) * static_cast<std::size_t>(side_ * side_);
}

void PixelImage::add(PixelFrame &frame, double x, double y, const LatticeValues &light) const {
  const double whole_x = std::floor(x), whole_y = std::floor(y);
  if (!(std::abs(whole_x) < 1e6 && std::abs(whole_y) < 1e6))
    return;
  const double fine_x = (x - whole_x) * steps_, fine_y = (y - whole_y) * steps_;
  const int phase_x = std::min(static_cast<int>(fine_x), steps_ - 1);
  const int phase_y = std::min(static_cast<int>(fine_y), steps_ - 1);
  const auto weight_x = cubic(fine_x - phase_x), weight_y = cubic(fine_y - phase_y);
  const double *stamps[16];
  double weights[16];
  for (int b = 0; b < 4; ++b)
    for (int a = 0; a < 4; ++a) {
      stamps[4 * b + a] = stamp(phase_x - 1 + a, phase_y - 1 + b);
      weights[4 * b + a] =
          weight_x[static_cast<std::size_t>(a)] * weight_y[static_cast<std::size_t>(b)];
    }
  const int left = static_cast<int>(whole_x) - reach_, top = static_cast<int>(whole_y) - reach_;
  const int from = std::max(0, -left), to = std::min(side_, frame.columns - left);
  std::vector<double> line(static_cast<std::size_t>(side_));
  for (int row = std::max(0, -top); row < std::min(side_, frame.rows - top) && from < to; ++row) {
    std::fill(line.begin(), line.end(), 0);
    for (int k = 0; k < 16; ++k) {
      const double *source = stamps[k] + row * side_;
      const double weight = weights[k];
      for (int c = from; c < to; ++c)
        line[static_cast<std::size_t>(c)] += weight * source[c];
    }
    double *out = frame.value.data() + frame.index(0, top + row);
    const double even = light[lattice_place(left, top + row)];
    const double odd = light[lattice_place(left + 1, top + row)];
    for (int c = from; c < to; ++c) // interpolation may go below 0 by a rounding in the wings
      out[left + c] +=
          std::max(0., line[static_cast<std::size_t>(c)]) * ((c & 1) != 0 ? odd : even);
  }
}

struct PixelImages::Store {
  std::mutex guard;
  std::map<int, PixelImage> known;
};

PixelImages::PixelImages(ImageProfile profile)
    : profile_(profile), store_(std::make_shared<Store>()) {}

const PixelImage &PixelImages::of(double fwhm_px) {
  constexpr double step = .01; // of the logarithm: within half a per cent
  const int key = static_cast<int>(std::lround(std::log(fwhm_px) / step));
  const std::lock_guard lock(store_->guard);
  return store_->known.try_emplace(key, profile_, std::exp(key * step)).first->second;
}

} // namespace umov
