#pragma once
// An initialised SGP4 model and the stages that make it. Units and sources (H, V, S):
// kernel/sgp4_numbers.h.

#include "kernel/sgp4_numbers.h"

#include <umov/orbit/sgp4.h>
#include <vector>

namespace umov::sgp4 {

using kernel::Resonance, kernel::two_pi;
using MeanElements = kernel::MeanElements<double>;
using InclinationTerms = kernel::InclinationTerms<double>;
using SecularRates = kernel::SecularRates<double>;
using DragTerms = kernel::DragTerms<double>;
using ThirdBodyPeriodics = kernel::ThirdBodyPeriodics<double>;
using ThirdBodyRates = kernel::ThirdBodyRates<double>;
using Numbers = kernel::Sgp4Numbers<double>;
using Node = kernel::ResonanceNode<double>;

inline constexpr double earth_radius_km = kernel::sgp4_earth_radius_km;
inline constexpr double j2 = kernel::sgp4_j2, j3_over_j2 = kernel::sgp4_j3_over_j2;
inline constexpr double j4 = -0.00000165597; // WGS 72 (V, Table 1)
inline constexpr double gravity_rate = kernel::sgp4_gravity_rate;

/// Everything that does not depend on the time asked for.
struct Constants {
  Sgp4Code code = Sgp4Code::Ok; ///< of the state at the epoch
  bool is_usable = false;       ///< false: outside the theory, nothing can be evaluated
  kernel::Sgp4Kind kind;
  Numbers numbers{};
};

// --- initialisation -------------------------------------------------------------------------
/// Julian date of 0h of day `day` (1 = 1 January) of a Gregorian year.
double julian_date_of_year_day(int year, int day);
/// Greenwich mean sidereal angle, IAU 1982 (Aoki et al. 1982), of a UT1 taken as UTC.
double greenwich_angle_1982(double jd);
/// Removes the Kozai J2 term from the published mean motion (H section 6, first block).
double brouwer_mean_motion(double kozai, double eccentricity, double cos_inclination);
Constants initialise(const ElementSet &elements);
/// Lunar-solar terms and resonance. `days_1900`: days since 1900 January 0.5.
void add_deep_space(Constants &c, double days_1900);
/// Kind and numbers of the resonance; the lunar-solar rates must be there.
void add_resonance(Constants &c);

// --- at a time ------------------------------------------------------------------------------
/// The resonance at the last whole step of half a day before `minutes`, counted from the epoch.
Node resonance_node(const Constants &c, double minutes);
/// The same for steps 0 .. `count` forwards, or backwards from the epoch.
std::vector<Node> resonance_nodes(const Constants &c, int count, bool is_forward);
Sgp4Code state_at(const Constants &c, double minutes, TemeState &state);

/// Longest time from the epoch [min]: bounds the half-day steps of a resonant orbit.
inline constexpr double limit_minutes = 1e8;

// --- many at once, on the vector unit ----------------------------------------------------------
/// States of one usable object; `minutes` within the limit. A failed state is zero.
void states_over_times(const Constants &c, const double *minutes, std::size_t count,
                       TemeState *states, Sgp4Code *codes);
/// States of usable objects of one kind, each at its own time. A failed state is zero.
void states_over_objects(const Constants *const *objects, const double *minutes, std::size_t count,
                         TemeState *const *states, Sgp4Code *const *codes);

} // namespace umov::sgp4
