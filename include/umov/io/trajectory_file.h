#pragma once
// Orbits from files, told apart by what they hold.

#include <umov/core/diagnostics.h>
#include <umov/io/ccsds.h>
#include <umov/orbit/state_vector.h>
#include <umov/orbit/trajectory.h>

namespace umov {

/// The orbit that an Orbit Ephemeris Message holds. BadInput for another centre than the Earth, a
/// frame other than GCRF, ICRF, EME2000 (J2000), TEME and ITRF*, an unknown time system, states out
/// of order. Without INTERPOLATION: Hermite of degree 7.
Result<OrbitEphemeris> ephemeris_from_oem(const ccsds::Message &message);

/// The state of an Orbit Parameter Message; metres are taken where it says so. Manoeuvres are
/// refused: an orbit across one is not built.
Result<StateVector> state_from_opm(const ccsds::Message &message);

/// Which object of a file, over which span, and what is tolerated.
struct TrajectoryRequest {
  int norad = 0; ///< 0: the only object of the file
  Epoch<Utc> first{}, last{};
  bool allow_bad_checksum = false, keep_going = false, allow_old_elements = false;
};

/// The orbit of one object over a span: TLE, 3LE or OMM (the set that suits the span's beginning;
/// refused past 30 d unless allowed), OEM, or OPM (integrated). Warns of age.
Result<Trajectory> read_trajectory(std::string_view text, const std::string &file,
                                   const TrajectoryRequest &request, Diagnostics &diagnostics);

/// States of an orbit at the times, in TEME and UTC, as an OEM (version 2.0, Lagrange of degree 9).
/// Physics where the orbit ends before the last of them.
Result<ccsds::Message> oem_from(const Trajectory &orbit, const std::vector<Epoch<Utc>> &times,
                                Epoch<Utc> created);

} // namespace umov
