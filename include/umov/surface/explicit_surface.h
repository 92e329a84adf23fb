#pragma once
// A ray-traced height field against the statistical model of the same slopes (the paper's Fig. 7).

#include <array>
#include <umov/shape/rough_surface.h>
#include <umov/surface/distribution.h>
#include <umov/surface/material.h>

namespace umov {

/// Flux of light scattered once into 6 x 6 bins: 15 deg of the angle from the normal, 30 deg of the
/// azimuth from the mirror direction (both sides of the plane together); sum = `once`.
struct SingleScatter {
  static constexpr std::size_t zones = 6;
  double once = 0; ///< fraction of the light scattered exactly once
  std::array<double, zones * zones> flux{};
};

/// Every facet a perfect mirror, all bounces traced, the field continued periodically.
/// `rays` start points above the field, direction from `theta` [rad] in the plane y = 0.
SingleScatter trace_height_field(const HeightField &field, double theta_rad, std::uint64_t rays,
                                 std::uint64_t seed, unsigned threads);

/// The same from a distribution of normals and a joint masking, F = 1.
SingleScatter model_scatter(const Distribution &normals, Shadowing shadowing, double theta_rad);

} // namespace umov
