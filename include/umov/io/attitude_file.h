#pragma once
// Attitudes from a CCSDS Attitude Ephemeris Message.

#include <string>
#include <string_view>
#include <umov/attitude/attitude_table.h>
#include <umov/core/diagnostics.h>

namespace umov {

/// QUATERNION (with rates, which are not used), EULER_ANGLE and SPIN, one frame of them inertial
/// (EME2000, J2000, ICRF, GCRF) and the other the body. CCSDS quaternions (scalar last unless
/// QUATERNION_TYPE = FIRST) become body_from_gcrs. EME2000 is taken for GCRS: 0.02 arcsec. BadInput
/// for other frames and types, quaternions off unit length by more than 1e-3 (warned of past 1e-6),
/// states out of order.
Result<AttitudeTable> read_attitude_table(std::string_view text, const std::string &file,
                                          Diagnostics &diagnostics);

} // namespace umov
