// A star's image fitted to a frame: place, and for each place of a mosaic brightness and sky.

#include "algebra/dense.h"
#include <algorithm>
#include <cmath>
#include <umov/instrument/frame_photometry.h>

namespace umov {
namespace {

using Matrix = algebra::MatrixXd;
using Vector = algebra::VectorXd;

/// The pixels about a star with what a model says of them.
class Box {
public:
  Box(const Detector &detector, const RawFrame &frame, const PixelImage &image,
      const FramePoint &start, double radius, bool is_mosaic)
      : image_(image), fixed_(fixed_variance(detector)), excess_(excess_variance(detector)),
        places_(is_mosaic ? 4 : 1) {
    const auto from = [&](double x) {
      return std::max(0, static_cast<int>(std::ceil(x - radius)));
    };
    const auto to = [&](double x, int size) {
      return std::min(size, static_cast<int>(std::floor(x + radius)) + 1);
    };
    left_ = from(start.x), top_ = from(start.y);
    blank_ = PixelFrame::blank(std::max(0, to(start.x, frame.columns) - left_),
                               std::max(0, to(start.y, frame.rows) - top_));
    data_.resize(static_cast<Eigen::Index>(blank_.value.size()));
    for (int row = 0; row < blank_.rows; ++row)
      for (int column = 0; column < blank_.columns; ++column) {
        const auto at =
            static_cast<std::size_t>(top_ + row) * static_cast<std::size_t>(frame.columns) +
            static_cast<std::size_t>(left_ + column);
        data_(static_cast<Eigen::Index>(place_.size())) =
            electrons_of(detector, {frame.adu[at], false});
        place_.push_back(is_mosaic ? lattice_place(left_ + column, top_ + row) : 0);
        is_saturated_ =
            is_saturated_ || std::binary_search(frame.saturated.begin(), frame.saturated.end(),
                                                static_cast<std::uint32_t>(at));
      }
  }
  [[nodiscard]] bool is_saturated() const { return is_saturated_; }
  [[nodiscard]] Eigen::Index size() const { return data_.size(); }
  [[nodiscard]] Eigen::Index places() const { return places_; }
  [[nodiscard]] const Vector &data() const { return data_; }

  /// One over the variance of each pixel by the model.
  [[nodiscard]] Vector weights(const Vector &model) const {
    constexpr double least = .01; // electrons: less of them scatter no less
    return ((model.cwiseMax(least) * excess_).array() + fixed_).inverse();
  }
  /// Columns: star and sky of every place, then what a shift does to the star.
  [[nodiscard]] Matrix columns(const FramePoint &centre, const Vector &light) const {
    constexpr double step = .05; // px
    const Vector here = shape(centre);
    const Vector dx =
        (shape({centre.x + step, centre.y}) - shape({centre.x - step, centre.y})) / (2 * step);
    const Vector dy =
        (shape({centre.x, centre.y + step}) - shape({centre.x, centre.y - step})) / (2 * step);
    Matrix out = Matrix::Zero(size(), 2 * places_ + 2);
    for (Eigen::Index k = 0; k < size(); ++k) {
      const auto p = static_cast<Eigen::Index>(place_[static_cast<std::size_t>(k)]);
      out(k, p) = here(k);
      out(k, places_ + p) = 1;
      out(k, 2 * places_) = light(p) * dx(k);
      out(k, 2 * places_ + 1) = light(p) * dy(k);
    }
    return out;
  }

private:
  /// Of a star of one electron.
  [[nodiscard]] Vector shape(const FramePoint &centre) const {
    PixelFrame frame = blank_;
    image_.add(frame, centre.x - left_, centre.y - top_, {1, 1, 1, 1});
    return Eigen::Map<const Vector>(frame.value.data(), size());
  }

  const PixelImage &image_;
  double fixed_, excess_;
  Eigen::Index places_;
  int left_ = 0, top_ = 0;
  PixelFrame blank_;
  Vector data_;
  std::vector<std::size_t> place_;
  bool is_saturated_ = false;
};

/// Star and sky of every place, and the place, with their covariance.
struct Solution {
  Vector values; ///< star and sky of each place
  FramePoint centre;
  Matrix covariance;
  bool has_converged = false;
};

/// Gauss-Newton; `moves`: the place is fitted as well.
Solution solve(const Box &box, const FramePoint &start, double radius, bool moves) {
  const Eigen::Index linear = 2 * box.places(), unknowns = moves ? linear + 2 : linear;
  Solution out{Vector::Zero(linear), start, {}, !moves};
  Vector model = box.data().cwiseMax(0);
  constexpr int rounds = 25;
  for (int k = 0; k < rounds; ++k) {
    const Matrix all = box.columns(out.centre, out.values.head(box.places()));
    // The first round knows no light yet, and light that moves none yet.
    const Eigen::Index now = k == 0 ? linear : unknowns;
    const Matrix m = all.leftCols(now);
    const Vector w = box.weights(model);
    const algebra::SymmetricFactor normal(algebra::transposed_product(m, w.asDiagonal() * m));
    const Vector residual = box.data() - algebra::times(all.leftCols(linear), out.values);
    const Vector step = normal.solve(algebra::transposed_times(m, w.cwiseProduct(residual)));
    if (!normal.is_solvable() || !step.allFinite())
      return out;
    out.values += step.head(linear);
    model = algebra::times(all.leftCols(linear), out.values);
    out.covariance = normal.inverse();
    if (now == linear)
      continue;
    constexpr double longest = .5; // px in one round
    const double dx = std::clamp(step(linear), -longest, longest);
    const double dy = std::clamp(step(linear + 1), -longest, longest);
    out.centre = {out.centre.x + dx, out.centre.y + dy};
    if (std::hypot(out.centre.x - start.x, out.centre.y - start.y) > radius / 2)
      return out;
    if (std::hypot(dx, dy) < 1e-5) {
      out.has_converged = true;
      return out;
    }
  }
  return out;
}

} // namespace

StarFit fit_star(const Detector &detector, const RawFrame &frame, const PixelImage &image,
                 const FramePoint &start, double radius, bool is_mosaic) {
  const Box box(detector, frame, image, start, radius, is_mosaic);
  StarFit out;
  out.centre = start;
  out.is_saturated = box.is_saturated();
  if (box.size() < 4 * box.places())
    return out;
  Solution found = solve(box, start, radius, true);
  if (!found.has_converged) // too faint to say where it stands
    found = solve(box, start, radius, false);
  out.has_converged = found.has_converged && found.covariance.size() > 0;
  if (!out.has_converged)
    return out;
  out.centre = found.centre;
  for (Eigen::Index p = 0; p < box.places(); ++p) {
    const auto k = static_cast<std::size_t>(p);
    out.electrons[k] = found.values(p);
    out.background[k] = found.values(box.places() + p);
    out.variance[k] = found.covariance(p, p);
  }
  return out;
}

} // namespace umov
