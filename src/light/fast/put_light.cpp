#include "light/fast/state.h"

#include <algorithm>

namespace umov {
void put_light(const BandLight &light, double scale, bool has_plane, bool has_u_or_v,
               std::size_t row, StokesTable &out) {
  const std::size_t n = light.size(), first = row * n;
  out.is_dark[row] = 0;
  const auto half_width = [&](double variance, std::size_t b) {
    return backend::half_width(variance, light.i[b], light.bias[b], scale);
  };
  for (std::size_t b = 0; b < n; ++b) {
    out.i[first + b] = light.i[b] * scale;
    out.q[first + b] = has_plane ? light.q[b] * scale : 0;
    out.i_err[first + b] = half_width(light.var_i[b], b);
    out.q_err[first + b] = half_width(light.var_q[b], b);
  }
  for (std::size_t b = 0; has_u_or_v && b < n; ++b) {
    out.u[first + b] = has_plane ? light.u[b] * scale : 0;
    out.v[first + b] = light.v[b] * scale;
    out.u_err[first + b] = half_width(light.var_u[b], b);
    out.v_err[first + b] = half_width(light.var_v[b], b);
  }
}

bool has_any_light(const BandLight &light) {
  return std::any_of(light.i.begin(), light.i.end(), [](double i) { return i > 0; });
}

void put_darkness(std::size_t row, StokesTable &out) {
  out.is_dark[row] = 1;
  for (auto *column : {&out.i, &out.q, &out.i_err, &out.q_err})
    std::fill_n(column->begin() + static_cast<std::ptrdiff_t>(row * out.bands), out.bands, 0);
}

} // namespace umov
