#pragma once
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <umov/optics/stokes.h>
#include <vector>

namespace umov {

/// Result in one band.
struct BandResult {
  Stokes<ScatteringPlane> stokes;     ///< [m2/sr] per unit solar irradiance
  Stokes<ScatteringPlane> half_width; ///< numerical 95 % half-widths of I, Q, U, V
};
/// I is more than three times its half-width: below that a magnitude says nothing.
inline bool is_known(double i, const Stokes<ScatteringPlane> &half_width) {
  return i > 3 * half_width.i;
}
/// p is known to 0.1.
inline bool is_p_known(double i, const Stokes<ScatteringPlane> &half_width) {
  return std::hypot(half_width.q, half_width.u) + half_width.i < 0.1 * i;
}
/// Adds light of its own error: half-widths in quadrature.
void add(const BandResult &more, BandResult &to);

/// How a pose was lit.
enum class PoseMethod : std::uint8_t {
  Exact,  ///< nothing hides anything
  Masks,  ///< looked up
  Mended, ///< looked up, with rays for the classes that were uncertain
  Rays
};

/// "exact", "masks", "mended" or "rays".
const char *name_of(PoseMethod method);

/// Results of many poses: [pose * bands + band], in the scattering plane, [m2/sr] per unit solar
/// irradiance, with 95 % half-widths.
struct StokesTable {
  std::size_t bands = 0;
  std::vector<double> i, q, u, v;
  std::vector<double> i_err, q_err, u_err, v_err;
  std::vector<char> is_dark;      ///< per pose: nothing is both lit and seen
  std::vector<PoseMethod> method; ///< per pose
  // Only where they are asked for, else empty:
  std::vector<Stokes<ScatteringPlane>> indirect; ///< of more than one surface, part of I, Q, U, V
  std::vector<double> glint_share; ///< per pose: of direct I in band 0 from flats within their lobe
  std::vector<double> material_i;  ///< [(pose * materials + material) * bands + band], direct light
  /// Of bands with a curve: what summing few wavelengths may leave out, of I, Q, U, V.
  std::vector<Stokes<ScatteringPlane>> band_err;
  /// Makes room for poses and bands; optional columns stay empty.
  void resize(std::size_t poses, std::size_t band_count);
  /// Number of poses.
  [[nodiscard]] std::size_t poses() const { return is_dark.size(); }
  /// One pose in one band.
  [[nodiscard]] BandResult at(std::size_t pose, std::size_t band) const;
  /// Sets one pose in one band.
  void put(std::size_t pose, std::size_t band, const BandResult &result);
};

/// All of a table as this machine has it in memory, to be kept while a job runs.
std::string to_bytes(const StokesTable &table);
/// The table again; false for bytes that are none.
[[nodiscard]] bool from_bytes(std::string_view bytes, StokesTable &table);

} // namespace umov
