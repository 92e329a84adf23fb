#pragma once
// What the SGP4 kernel knows of an object: plain numbers, the same for all times.
//
// Units inside the theory: Earth radii of WGS 72, minutes, radians. Sources, quoted by letter:
//   H  Hoots & Roehrich 1980, Spacetrack Report No. 3
//   V  Vallado, Crawford, Hujsak & Kelso 2006, AIAA 2006-6753 (corrections, "improved" mode)
//   S  Hoots, Schumacher & Glover 2004, J. Guidance 27(2), 174 (the equations in one notation)

#include <cstddef>
#include <cstdint>
#include <type_traits>

namespace umov::kernel {

inline constexpr double two_pi = 6.283185307179586476925286766559;

// WGS 72 (V, Table 1).
inline constexpr double sgp4_earth_radius_km = 6378.135;
inline constexpr double sgp4_j2 = 0.001082616;
inline constexpr double sgp4_j3_over_j2 = -0.00000253881 / sgp4_j2;
/// sqrt(mu) in Earth radii^1.5 per minute: 60 / sqrt(6378.135^3 / 398600.8).
inline constexpr double sgp4_gravity_rate = 0.07436691613317342;

/// Mean elements; at the epoch, or carried to a time.
template <class R> struct MeanElements {
  R motion; ///< Brouwer mean motion [rad/min]
  R eccentricity, inclination, node, perigee, anomaly;
};

/// Functions of the inclination that the periodic terms need.
template <class R> struct InclinationTerms {
  R sine, cosine;
  R three_cos2_minus_1, one_minus_cos2, seven_cos2_minus_1;
  R long_period_y, long_period_l; ///< coefficients of the J3 terms of a_yN and L_T
};

/// Secular rates of the Earth's zonal harmonics [rad/min].
template <class R> struct SecularRates { R anomaly, perigee, node; };

/// Power series in time of the drag perturbation (H section 6; S Eqs. of C1..C5, D2..D4).
template <class R> struct DragTerms {
  R bstar;
  R c1, c4, c5, d2, d3, d4;
  R l2, l3, l4, l5; ///< of the mean longitude, t^2 .. t^5
  R node_t2;
  R eta, perigee_t, anomaly_factor;
  R anomaly_offset, sine_anomaly0;
};

/// Amplitudes of the periodic perturbation of one third body.
template <class R> struct ThirdBodyPeriodics {
  R e2, e3, i2, i3, l2, l3, l4;
  R gh2, gh3, gh4, h2, h3;
  R anomaly0; ///< of the body at the satellite's epoch
  R rate, eccentricity;
};

/// Secular rates from Sun and Moon [1/min].
template <class R> struct ThirdBodyRates { R eccentricity, inclination, anomaly, perigee, node; };

inline constexpr std::size_t resonance_terms_max = 10;
template <class R> struct ResonanceNumbers {
  R angle0; ///< resonance angle at the epoch
  R rate0;  ///< its secular rate without the mean motion
  R amplitude[resonance_terms_max];
};

template <class R> struct Sgp4Numbers {
  MeanElements<R> epoch;
  R axis0; ///< (gravity rate / motion)^(2/3) at the epoch
  InclinationTerms<R> inclination;
  SecularRates<R> rates;
  DragTerms<R> drag;
  R greenwich; ///< sidereal angle at the epoch [rad]
  // Deep space alone; zeros elsewhere.
  ThirdBodyPeriodics<R> sun, moon;
  ThirdBodyRates<R> third;
  ResonanceNumbers<R> resonance;
};
static_assert(std::is_trivially_copyable_v<Sgp4Numbers<double>>);
inline constexpr std::size_t sgp4_number_count = sizeof(Sgp4Numbers<double>) / sizeof(double);

enum class Resonance : std::uint8_t { None, OneDay, HalfDay };

/// What decides on the way through the theory; lanes of one batch share it.
struct Sgp4Kind {
  bool is_deep = false;
  bool is_simple = false; ///< perigee below 220 km, or deep space: linear drag only
  Resonance resonance = Resonance::None;
  friend bool operator==(const Sgp4Kind &, const Sgp4Kind &) = default;
};

/// Multiples of perigee and resonance angle, and phase, of a harmonic of the Earth's field (H
/// section 7).
struct ResonanceHarmonic {
  double perigee_multiple, angle_multiple, phase;
};

/// Resonance angle and mean motion at a time.
template <class R> struct ResonanceNode { R minutes, angle, motion; };

/// Half-day steps of the resonance's integration (H section 7).
inline constexpr double resonance_step_minutes = 720;

} // namespace umov::kernel
