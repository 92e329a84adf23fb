#include <umov/instrument/exposure.h>

#include <algorithm>
#include <cmath>

namespace umov {

std::vector<ExposureNode> exposure_nodes(double exposure_s, double feature_s) {
  constexpr double most = 10'000; // panels: beyond it the light is a blur whatever is done
  const double wanted = feature_s > 0 ? std::ceil(exposure_s / feature_s - 1e-9) : 1;
  const auto panels = static_cast<int>(std::clamp(wanted, 1.0, most));
  const double length = exposure_s / panels, reach = std::sqrt(0.6) / 2;
  std::vector<ExposureNode> out;
  for (int k = 0; k < panels; ++k) {
    const double middle = (k + 0.5) * length - exposure_s / 2;
    out.push_back({middle - reach * length, 5. / 18 / panels});
    out.push_back({middle, 8. / 18 / panels});
    out.push_back({middle + reach * length, 5. / 18 / panels});
  }
  return out;
}

} // namespace umov
