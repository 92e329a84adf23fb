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
/// I and Q of a sphere of radius 1 by quadrature over its normals: z towards the bisector, x in the
/// scattering plane; longitude and latitude measured so that the lit and seen lune is a rectangle.
inline FresnelFactors sphere(const Surface &surface, std::size_t band, double phase, int steps) {
  const double l_v = std::cos(phase);
  double specular = 0, body = 0;
  const double half =
      pi / 2 - phase / 2; // longitudes -half..half from the bisector are lit and seen
  for (int i = 0; i < steps; ++i)
    for (int j = 0; j < steps; ++j) {
      const double lon = half * (2 * (i + 0.5) / steps - 1);
      const double lat = pi / 2 * (2 * (j + 0.5) / steps - 1);
      const double n_l = std::cos(lat) * std::cos(lon - phase / 2);
      const double n_v = std::cos(lat) * std::cos(lon + phase / 2);
      const double area = std::cos(lat) * (2 * half / steps) * (pi / steps);
      specular += specular_of(surface, n_l, n_v, l_v) * area;
      body += body_of(surface, band, n_l, n_v) * area;
    }
  const FresnelFactors f = surface.fresnel(band, l_v);
  return {f.a * specular + body, f.b * specular};
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
