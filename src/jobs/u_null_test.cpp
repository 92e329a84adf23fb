#include "jobs/u_null_test.h"

#include <fmt/format.h>

namespace umov::jobs {

NullTest null_test_of(const ObservedCurve &curve, const EndMember &fitted) {
  std::vector<double> model(curve.samples.size(), 0);
  for (std::size_t k = 0; k < model.size() && !fitted.i.empty(); ++k) {
    const std::size_t at = curve.samples[k].epoch * curve.bands.size() + curve.samples[k].band;
    model[k] = fitted.i[at] > 0 ? fitted.u[at] / fitted.i[at] : 0;
  }
  return null_test(curve, model);
}

void note_null_test(const NullTest &u, std::vector<std::string> &notes, const std::string &whose) {
  if (u.is_flagged())
    notes.push_back(fmt::format(
        "{}U of the scattering plane is not what the best fit has: polarization of the instrument "
        "of ({:.4f} +- {:.4f}, {:.4f} +- {:.4f}) would explain it; calibrate, or suspect light "
        "between surfaces",
        whose, u.q0, u.q0_sd, u.u0, u.u0_sd));
}

} // namespace umov::jobs
