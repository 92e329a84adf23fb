#pragma once
// Attitudes at given times and between them.

#include <cstdint>
#include <optional>
#include <string>
#include <umov/core/result.h>
#include <umov/core/rotation.h>
#include <umov/time/epoch.h>
#include <vector>

namespace umov {

/// A spin axis among the stars (body +Z), the phase about it and its rate.
struct SpinState {
  double right_ascension_rad = 0, declination_rad = 0, angle_rad = 0, rate_rad_s = 0;
};

/// One line of a table of attitudes.
struct AttitudeState {
  Epoch<Utc> time{};
  Quaternion body_from_gcrs;
  std::optional<SpinState> spin; ///< instead of the quaternion
};

/// Attitudes in order of time. Between quaternions the shorter great circle (Shoemake 1985), or,
/// for `degree` > 1, Lagrange's polynomial through degree + 1 of them, made unit again. Between
/// spins the axis moves evenly and the angle follows the cubic of angles and rates.
struct AttitudeSegment {
  int degree = 1;
  Epoch<Utc> first{}, last{}; ///< usable span
  std::vector<AttitudeState> states;
};

/// Attitudes of an object in pieces that need not meet.
struct AttitudeTable {
  std::string name; ///< for messages
  std::vector<AttitudeSegment> segments;
};

/// BadInput unless states are in order of time, finite and at least two per segment.
Result<void> check_attitude_table(const AttitudeTable &table);

/// Bound on the rate of turning [rad/s]: twice the largest mean rate between neighbours, and the
/// spins' own.
double rate_bound_rad_s(const AttitudeTable &table);

/// Physics where no segment covers the time; the message says what is covered.
Result<Rotation<Body, Gcrs>> attitude_in(const AttitudeTable &table, Epoch<Utc> time);

} // namespace umov
