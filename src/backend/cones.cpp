#include "backend/scene_data.h"

#include <algorithm>
#include <cmath>

namespace umov::backend {

template <class T> Cone cone_of(const FacetGroup<T> &group) {
  Cone out;
  const auto for_each = [&](auto &&body) {
    for (std::size_t j = 0; j < lanes; ++j)
      if (group.area[j] > 0)
        body(static_cast<double>(group.nx[j]), static_cast<double>(group.ny[j]),
             static_cast<double>(group.nz[j]));
  };
  for_each([&](double x, double y, double z) {
    out.axis[0] += x;
    out.axis[1] += y;
    out.axis[2] += z;
  });
  const double length = std::hypot(out.axis[0], out.axis[1], out.axis[2]);
  double cosine = length > 1e-6 ? 1 : -1; // of the normal farthest from the axis
  for (double &a : out.axis)
    a = length > 1e-6 ? a / length : 0;
  for_each([&](double x, double y, double z) {
    cosine = std::min(cosine, x * out.axis[0] + y * out.axis[1] + z * out.axis[2]);
  });
  constexpr double rounding = 1e-5, always = -2;
  const double sine = std::sqrt(std::max(0.0, (1 - cosine) * (1 + cosine)));
  out.least = cosine > 0 ? -sine - rounding : always;
  return out;
}

template Cone cone_of(const FacetGroup<float> &);
template Cone cone_of(const FacetGroup<double> &);

} // namespace umov::backend
