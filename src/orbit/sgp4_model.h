#pragma once
// The parts of an initialised SGP4 model and the stages that make and use them.
//
// Units inside the theory: Earth radii of WGS 72, minutes, radians. Sources, quoted by letter:
//   H  Hoots & Roehrich 1980, Spacetrack Report No. 3
//   V  Vallado, Crawford, Hujsak & Kelso 2006, AIAA 2006-6753 (corrections, "improved" mode)
//   S  Hoots, Schumacher & Glover 2004, J. Guidance 27(2), 174 (the equations in one notation)

#include <array>
#include <optional>
#include <umov/orbit/sgp4.h>

namespace umov::sgp4 {

inline constexpr double two_pi = 6.283185307179586476925286766559;

// WGS 72 (V, Table 1).
inline constexpr double mu_km3_s2 = 398600.8;
inline constexpr double earth_radius_km = 6378.135;
inline constexpr double j2 = 0.001082616;
inline constexpr double j3 = -0.00000253881;
inline constexpr double j4 = -0.00000165597;
inline constexpr double j3_over_j2 = j3 / j2;
/// sqrt(mu) in Earth radii^1.5 per minute.
double gravity_rate();

/// Mean elements; at the epoch, or carried to a time.
struct MeanElements {
  double motion = 0; ///< Brouwer mean motion [rad/min]
  double eccentricity = 0, inclination = 0, node = 0, perigee = 0, anomaly = 0;
};

/// Functions of the inclination that the periodic terms need.
struct InclinationTerms {
  double sine = 0, cosine = 1;
  double three_cos2_minus_1 = 0, one_minus_cos2 = 0, seven_cos2_minus_1 = 0;
  double long_period_y = 0, long_period_l = 0; ///< coefficients of the J3 terms of a_yN and L_T
};
InclinationTerms inclination_terms(double inclination);

/// Secular rates of the Earth's zonal harmonics [rad/min].
struct SecularRates {
  double anomaly = 0, perigee = 0, node = 0;
};

/// Power series in time of the drag perturbation (H section 6; S Eqs. of C1..C5, D2..D4).
struct DragTerms {
  bool is_simple = false; ///< perigee below 220 km, or deep space: linear terms only
  double bstar = 0;
  double c1 = 0, c4 = 0, c5 = 0, d2 = 0, d3 = 0, d4 = 0;
  double l2 = 0, l3 = 0, l4 = 0, l5 = 0; ///< of the mean longitude, t^2 .. t^5
  double node_t2 = 0;
  double eta = 0, perigee_t = 0, anomaly_factor = 0;
  double anomaly_offset = 0, sine_anomaly0 = 0;
};

/// Amplitudes of the periodic perturbation of one third body.
struct ThirdBodyPeriodics {
  double e2 = 0, e3 = 0, i2 = 0, i3 = 0, l2 = 0, l3 = 0, l4 = 0;
  double gh2 = 0, gh3 = 0, gh4 = 0, h2 = 0, h3 = 0;
  double anomaly0 = 0; ///< of the body at the satellite's epoch
  double rate = 0, eccentricity = 0;
};

/// Secular rates from Sun and Moon [1/min].
struct ThirdBodyRates {
  double eccentricity = 0, inclination = 0, anomaly = 0, perigee = 0, node = 0;
};

enum class Resonance { None, OneDay, HalfDay };

/// One harmonic of the resonant acceleration: amplitude, multiples of the perigee and of the
/// resonance angle, phase.
struct ResonanceTerm {
  double amplitude = 0;
  int perigee_multiple = 0, angle_multiple = 1;
  double phase = 0;
};

struct ResonanceModel {
  Resonance kind = Resonance::None;
  std::array<ResonanceTerm, 10> terms{};
  int term_count = 0;
  double angle0 = 0; ///< resonance angle at the epoch
  double rate0 = 0;  ///< its secular rate without the mean motion
};

struct DeepSpace {
  ThirdBodyPeriodics sun, moon;
  ThirdBodyRates rates;
  ResonanceModel resonance;
};

/// Everything that does not depend on the time asked for.
struct Constants {
  Sgp4Code code = Sgp4Code::Ok; ///< of the state at the epoch
  bool is_usable = false;       ///< false: outside the theory, nothing can be evaluated
  MeanElements epoch;
  InclinationTerms inclination;
  SecularRates rates;
  DragTerms drag;
  double greenwich = 0; ///< sidereal angle at the epoch [rad]
  std::optional<DeepSpace> deep;
};

// --- initialisation -------------------------------------------------------------------------
/// Julian date of 0h of day `day` (1 = 1 January) of a Gregorian year.
double julian_date_of_year_day(int year, int day);
/// Greenwich mean sidereal angle, IAU 1982 (Aoki et al. 1982), of a UT1 taken as UTC.
double greenwich_angle_1982(double jd);
/// Removes the Kozai J2 term from the published mean motion (H section 6, first block).
double brouwer_mean_motion(double kozai, double eccentricity, double cos_inclination);
Constants initialise(const ElementSet &elements);
/// `days_1900`: days since 1900 January 0.5.
DeepSpace deep_space_constants(const Constants &base, double days_1900);
ResonanceModel resonance_model(const Constants &base, const ThirdBodyRates &rates);

// --- at a time ------------------------------------------------------------------------------
/// Lunar-solar secular rates and resonance, from the epoch on: nothing is remembered.
void deep_space_secular(const Constants &c, double minutes, MeanElements &mean);
/// Lunar-solar periodics; below 0.2 rad of inclination in Lyddane's form (V, improved mode).
void deep_space_periodics(const DeepSpace &deep, double minutes, MeanElements &mean);
Sgp4Code state_at(const Constants &c, double minutes, TemeState &state);

} // namespace umov::sgp4
