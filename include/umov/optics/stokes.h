#pragma once
// Stokes vectors and Mueller matrices that carry their basis in the type.

#include <array>
#include <cmath>
#include <umov/core/quantity.h>

namespace umov {

/// +Q perpendicular to the scattering plane (s), +U at 45 deg from s towards p.
struct ScatteringPlane {};
/// +Q along celestial (or local) north, +U to the north-east, as seen by the observer (IAU 1973).
struct SkyNorth {};

/// Stokes vector in linear units of whatever I is. V > 0: the field turns counter-clockwise as seen
/// by the observer (IAU 1973), with the time factor exp(-i omega t).
template <class Basis> struct Stokes {
  double i = 0, q = 0, u = 0, v = 0;

  friend constexpr Stokes operator+(Stokes a, Stokes b) {
    return {a.i + b.i, a.q + b.q, a.u + b.u, a.v + b.v};
  }
  friend constexpr Stokes operator*(Stokes a, double k) {
    return {a.i * k, a.q * k, a.u * k, a.v * k};
  }
  /// Adds light of the same basis, incoherently.
  constexpr Stokes &operator+=(Stokes b) { return *this = *this + b; }
};

/// Unpolarized light of one unit: what sunlight is to a surface.
template <class Basis> constexpr bool is_sunlight(const Stokes<Basis> &light) {
  return light.i == 1 && light.q == 0 && light.u == 0 && light.v == 0;
}

/// The same light in axes of another basis. `axis` is the angle of the NEW reference axis counted
/// from the old one, counter-clockwise as seen by the observer (physics: Q' = Q cos 2x + U sin 2x).
/// From the scattering plane to the sky pass minus the position angle of +Q_scat.
template <class To, class From> Stokes<To> rotate_to(const Stokes<From> &s, Angle axis) {
  const double c = std::cos(2 * axis.radians()), d = std::sin(2 * axis.radians());
  return {s.i, s.q * c + s.u * d, s.u * c - s.q * d, s.v};
}

/// Mueller matrix that takes light in basis `In` to light in basis `Out`.
template <class Out, class In> struct Mueller {
  std::array<std::array<double, 4>, 4> m{};

  friend constexpr Stokes<Out> operator*(const Mueller &a, const Stokes<In> &s) {
    const std::array<double, 4> x{s.i, s.q, s.u, s.v};
    std::array<double, 4> y{};
    for (std::size_t r = 0; r < 4; ++r)
      for (std::size_t c = 0; c < 4; ++c)
        y[r] += a.m[r][c] * x[c];
    return {y[0], y[1], y[2], y[3]};
  }
  template <class Start>
  friend constexpr Mueller<Out, Start> operator*(const Mueller &a, const Mueller<In, Start> &b) {
    Mueller<Out, Start> out;
    for (std::size_t r = 0; r < 4; ++r)
      for (std::size_t c = 0; c < 4; ++c)
        for (std::size_t k = 0; k < 4; ++k)
          out.m[r][c] += a.m[r][k] * b.m[k][c];
    return out;
  }
};

} // namespace umov
