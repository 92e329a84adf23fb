#pragma once
// The rows of `umov signature`: one per pose and band.

#include <umov/io/table.h>
#include <umov/light/stokes_table.h>
#include <umov/scene/pose.h>
#include <umov/scene/scene.h>

namespace umov::jobs {

/// Columns that grow by one row per pose and band.
class SignatureRows {
public:
  void reserve(std::size_t rows);
  void add(std::int64_t number, const Pose &pose, const std::string &band, const BandResult &result,
           bool is_dark);
  /// All rows of a block of poses, filled side by side on `threads` threads.
  static SignatureRows of(const std::vector<std::int64_t> &numbers, const std::vector<Pose> &poses,
                          const std::vector<Band> &bands, const StokesTable &results,
                          unsigned threads);
  /// The columns with units; the notes of the project's conventions. Light that the body emits is a
  /// spectral radiant intensity, the Sun's or a laser's a ratio to their irradiance.
  Table table(bool is_emitted = false) &&;

private:
  static constexpr std::size_t number_columns = 18;
  void put(std::size_t row, std::int64_t number, const Pose &pose, const std::string &band,
           const BandResult &result, bool is_dark);
  std::vector<std::int64_t> pose_;
  std::vector<std::string> band_;
  std::vector<std::vector<double>> numbers_{number_columns};
  std::vector<Stokes<ScatteringPlane>> band_err_; ///< of bands with a curve, else empty
  std::vector<Band> bands_;
};

} // namespace umov::jobs
