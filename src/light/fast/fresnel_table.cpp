#include "light/fast/fresnel_table.h"

#include "kernel/microfacet.inl.h"

#include <algorithm>
#include <cmath>

namespace umov {
namespace {

constexpr std::uint32_t steps = 1024; ///< in the cosine of incidence, from 0 to 1
constexpr double tolerance = 1e-7;
constexpr double digits = 1 << 30; ///< an incidence is told from another by its cosine

/// Reflection at an incidence, from the phase angle that has it.
MuellerEntries reflection(const Surface &surface, std::size_t band, double cosine) {
  return surface.reflection(band, std::clamp(cosine, 0.0, 1.0));
}

} // namespace

FresnelTable::FresnelTable(std::vector<const Surface *> surfaces) : surfaces_(std::move(surfaces)) {
  for (const Surface *surface : surfaces_)
    columns_ += surface->band_count();
  rows_ = steps + 1;
  values_.resize(rows_ * 2 * columns_);
  std::size_t column = 0;
  for (std::size_t s = 0; s < surfaces_.size(); ++s)
    for (std::size_t band = 0; band < surfaces_[s]->band_count(); ++band, ++column) {
      for (std::size_t row = 0; row < rows_; ++row) {
        const auto m = reflection(*surfaces_[s], band, static_cast<double>(row) / steps);
        values_[row * 2 * columns_ + column] = m.a;
        values_[row * 2 * columns_ + columns_ + column] = m.b;
      }
      double error = 0;
      for (std::size_t row = 0; row < steps; ++row) {
        const std::size_t first = std::clamp<std::size_t>(row, 1, steps - 2) - 1;
        const double x = static_cast<double>(row) + 0.5;
        const auto c = kernel::cubic_weights(x - static_cast<double>(first + 1));
        const auto m = reflection(*surfaces_[s], band, x / steps);
        double a = 0, b = 0;
        for (std::size_t k = 0; k < 4; ++k) {
          a += c.w[k] * values_[(first + k) * 2 * columns_ + column];
          b += c.w[k] * values_[(first + k) * 2 * columns_ + columns_ + column];
        }
        error = std::max({error, std::abs(a - m.a), std::abs(b - m.b)});
      }
      if (!(error <= tolerance))
        exact_.push_back({column, s, band});
    }
}

backend::ReflectionTable<double> FresnelTable::view() const {
  return {values_, static_cast<std::uint32_t>(columns_), steps};
}

void FresnelTable::put_exact(std::int64_t key, double *values) const {
  for (const Exact &e : exact_) {
    const auto m = reflection(*surfaces_[e.surface], e.band, static_cast<double>(key) / digits);
    *values++ = m.a;
    *values++ = m.b;
  }
}

void FresnelTable::at(double cos_phase, double *a, double *b, Recent &recent) const {
  const double cosine = backend::incidence_cosine(cos_phase);
  backend::reflect(view(), cosine, a, b);
  if (exact_.empty())
    return;
  constexpr std::size_t places = 256;
  constexpr std::int64_t empty = -1;
  if (recent.key.empty()) {
    recent.key.assign(places, empty);
    recent.values.resize(places * 2 * exact_.size());
  }
  // Rounded for all alike, so that what is kept is what would be computed.
  const auto key = static_cast<std::int64_t>(std::clamp(cosine, 0.0, 1.0) * digits + 0.5);
  constexpr std::uint64_t scatter = 0x9E3779B97F4A7C15ull; // Fibonacci hashing: Knuth, TAOCP 3, 6.4
  const std::size_t place = (static_cast<std::uint64_t>(key) * scatter) >> 56;
  double *values = recent.values.data() + place * 2 * exact_.size();
  if (recent.key[place] != key)
    put_exact(key, values);
  recent.key[place] = key;
  for (const Exact &e : exact_) {
    a[e.column] = *values++;
    b[e.column] = *values++;
  }
}

} // namespace umov
