#pragma once
// Private: reflection of the microfacets of all materials and bands against the phase angle, as one
// microfacet incidence serves a whole pose.

#include "backend/colours.h"

#include <cstddef>
#include <cstdint>
#include <umov/surface/surface.h>
#include <vector>

namespace umov {

class FresnelTable {
public:
  /// What one table computed anew last, for whoever asks for many poses: those of a curve have few
  /// phase angles, whatever the attitude.
  struct Recent {
    std::vector<std::int64_t> key; ///< of each place; none: `empty`
    std::vector<double> values;    ///< [place][a and b of the columns that are not tabulated]
  };

  FresnelTable() = default;
  /// Columns in the order of the surfaces, each with all its bands. Interpolates to 1e-7; columns
  /// that need finer steps than that (thick films) are computed anew for each incidence, to the
  /// ninth digit of its cosine.
  explicit FresnelTable(std::vector<const Surface *> surfaces);

  [[nodiscard]] std::size_t columns() const { return columns_; }
  /// a and b (M00 and M10 of one reflection) of all columns; no plane at phase 0 and 180 is the
  /// caller's to know.
  void at(double cos_phase, double *a, double *b, Recent &recent) const;
  /// Some columns are computed anew for each pose.
  [[nodiscard]] bool has_exact() const { return !exact_.empty(); }
  [[nodiscard]] backend::ReflectionTable<double> view() const;

private:
  void put_exact(std::int64_t key, double *values) const;
  std::vector<const Surface *> surfaces_;
  std::size_t columns_ = 0, rows_ = 0;
  std::vector<double> values_; ///< [row][a of all columns, b of all columns]
  struct Exact {
    std::size_t column, surface, band;
  };
  std::vector<Exact> exact_;
};

} // namespace umov
