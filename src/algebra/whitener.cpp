#include "algebra/whitener.h"

#include <cmath>

namespace umov::algebra {

void Whitener::reset(std::span<const double> variances, std::span<const double> effects,
                     std::size_t terms) {
  size_ = variances.size();
  root_.assign(size_ * size_, 0);
  log_determinant_ = 0;
  const auto c = [this](std::size_t a, std::size_t b) -> double & { return root_[a * size_ + b]; };
  for (std::size_t a = 0; a < size_; ++a) {
    c(a, a) = variances[a];
    for (std::size_t b = 0; b <= a; ++b)
      for (std::size_t t = 0; t < terms; ++t)
        c(a, b) += effects[a * terms + t] * effects[b * terms + t];
  }
  for (std::size_t a = 0; a < size_; ++a) { // Cholesky
    for (std::size_t b = 0; b < a; ++b) {
      for (std::size_t k = 0; k < b; ++k)
        c(a, b) -= c(a, k) * c(b, k);
      c(a, b) /= c(b, b);
      c(a, a) -= c(a, b) * c(a, b);
    }
    c(a, a) = std::sqrt(c(a, a));
    log_determinant_ += 2 * std::log(c(a, a));
  }
}

void Whitener::whiten(std::span<double> column) const {
  for (std::size_t a = 0; a < size_; ++a) {
    for (std::size_t b = 0; b < a; ++b)
      column[a] -= root_[a * size_ + b] * column[b];
    column[a] /= root_[a * size_ + a];
  }
}

} // namespace umov::algebra
