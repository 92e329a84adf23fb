#pragma once
// Short forms for the tests of surfaces.

#include <cmath>
#include <umov/surface/surface.h>

namespace umov {

constexpr double degree = pi / 180;

inline Surface compiled(const Material &material, const char *bands = "paper_rgb") {
  return *Surface::compile(material, *bands_from({bands}));
}
inline Surface make_surface(const char *name, double m,
                            Shadowing shadowing = Shadowing::Ashikhmin) {
  Material material = *builtin_material(name);
  material.distribution = blinn_phong(m);
  material.shadowing = shadowing;
  return compiled(material);
}
inline double specular_of(const Surface &surface, double n_l, double n_v, double l_v) {
  return surface.specular(0, directions_from_cosines(n_l, n_v, l_v));
}
/// Body light of unpolarized sunlight, times both cosines.
inline double body_of(const Surface &surface, std::size_t band, double n_l, double n_v) {
  return surface.diffuse(band, directions_from_cosines(n_l, n_v, n_l * n_v), {1, 0, 0, 0}).i;
}
/// Unit vector at an angle from the normal.
inline Vec3<Facet> tilted(double cosine) {
  return {std::sqrt(std::max(0.0, (1 - cosine) * (1 + cosine))), 0, cosine};
}
/// Some random direction above the surface from two numbers in (0, 1).
inline Vec3<Facet> direction_from(double u, double w) {
  const double s = std::sqrt((1 - u) * (1 + u)), phi = 2 * pi * w;
  return {s * std::cos(phi), s * std::sin(phi), u};
}
inline SurfaceDirections directions(Vec3<Facet> l, Vec3<Facet> v, double disk_rad = 0) {
  return {l, v, std::min(1.0, std::max(-1.0, dot(l, v))), disk_rad};
}

} // namespace umov
