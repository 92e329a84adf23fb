#include "io/mesh/gltf/placement.h"

#include "io/mesh/gltf/document.h"

#include <cmath>
#include <fmt/format.h>

namespace umov::mesh_io::gltf {
namespace {

/// `N` finite numbers under a key, or `fallback`.
template <std::size_t N>
Result<std::array<double, N>> numbers(const Document &document, const Json &node, const char *key,
                                      const std::string &place, std::array<double, N> fallback) {
  const auto found = node.find(key);
  if (found == node.end())
    return fallback;
  bool is_good = found->is_array() && found->size() == N;
  for (std::size_t k = 0; is_good && k < N; ++k) {
    is_good = (*found)[k].is_number();
    fallback[k] = is_good ? (*found)[k].get<double>() : 0;
    is_good = is_good && std::abs(fallback[k]) <= 1e12;
  }
  if (!is_good)
    return document.bad(place + "." + key, "something else",
                        fmt::format("a list of {} numbers up to 1e12", N));
  return fallback;
}

} // namespace

Result<Placement> placement_of(const Document &document, std::size_t node) {
  const std::string place = fmt::format("nodes[{}]", node);
  const Json &json = document.entry("nodes", node);
  Placement out;
  if (json.contains("matrix")) {
    UMOV_ASSIGN(m, numbers<16>(document, json, "matrix", place, {}));
    for (std::size_t k = 0; k < 3; ++k)
      out.column[k] = {m[4 * k], m[4 * k + 1], m[4 * k + 2]};
    out.origin = {m[12], m[13], m[14]};
    if (m[3] != 0 || m[7] != 0 || m[11] != 0 || m[15] != 1)
      return document.bad(place + ".matrix", "projective", "a last row of 0, 0, 0, 1");
    return out;
  }
  UMOV_ASSIGN(t, numbers<3>(document, json, "translation", place, {0, 0, 0}));
  UMOV_ASSIGN(q, numbers<4>(document, json, "rotation", place, {0, 0, 0, 1}));
  UMOV_ASSIGN(s, numbers<3>(document, json, "scale", place, {1, 1, 1}));
  const double length = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  if (!(std::abs(length - 1) < 1e-2)) // exporters write few digits
    return document.bad(place + ".rotation", fmt::format("a quaternion of length {:g}", length),
                        "length 1");
  const double x = q[0] / length, y = q[1] / length, z = q[2] / length, w = q[3] / length;
  out.column[0] =
      s[0] * Vec3<Body>{1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w)};
  out.column[1] =
      s[1] * Vec3<Body>{2 * (x * y - z * w), 1 - 2 * (x * x + z * z), 2 * (y * z + x * w)};
  out.column[2] =
      s[2] * Vec3<Body>{2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y)};
  out.origin = {t[0], t[1], t[2]};
  return out;
}

} // namespace umov::mesh_io::gltf
