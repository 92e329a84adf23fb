#include "jobs/u_null_test.h"

#include <fmt/format.h>
#include <vector>

namespace umov::jobs {

NullTest null_test_of(const ObservedCurve &curve, std::span<const double> fitted_i,
                      std::span<const double> fitted_u) {
  std::vector<double> fitted(curve.samples.size(), 0);
  for (std::size_t k = 0; k < fitted.size() && !fitted_i.empty(); ++k) {
    const std::size_t at = curve.samples[k].epoch * curve.bands.size() + curve.samples[k].band;
    fitted[k] = fitted_i[at] > 0 ? fitted_u[at] / fitted_i[at] : 0;
  }
  return null_test(curve, fitted);
}

std::optional<std::string> words_of(const NullTest &u) {
  if (!u.is_flagged())
    return std::nullopt;
  return fmt::format("U of the scattering plane is not what the best fit has: polarization of the "
                     "instrument of ({:.4f} +- {:.4f}, {:.4f} +- {:.4f}) would explain it; "
                     "calibrate, or suspect light between surfaces",
                     u.q0, u.q0_sd, u.u0, u.u0_sd);
}

} // namespace umov::jobs
