#pragma once
#include <cstddef>
#include <umov/light/integrator.h>
#include <vector>

namespace umov {

/// Results of many poses: [pose * bands + band], in the scattering plane, [m2/sr] per unit solar
/// irradiance, with 95 % half-widths.
struct StokesTable {
  std::size_t bands = 0;
  std::vector<double> i, q, u, v;
  std::vector<double> i_err, q_err, u_err, v_err;
  std::vector<char> is_dark; ///< per pose: nothing is both lit and seen
  void resize(std::size_t poses, std::size_t band_count);
  [[nodiscard]] BandResult at(std::size_t pose, std::size_t band) const;
};

} // namespace umov
