// Orbits from OEM and OPM, and what stands between the states of an ephemeris.

#include <umov/io/trajectory_file.h>

#include <cmath>
#include <gtest/gtest.h>
#include <umov/core/files.h>
#include <umov/core/quantity.h>
#include <umov/frames/earth.h>

namespace umov {
namespace {

const std::string folder = UMOV_SOURCE_DIR "/tests/data/ccsds/";
Epoch<Utc> utc(const std::string &text) { return *utc_from_iso(text); }

Result<Trajectory> read(const std::string &text, const char *first = "2008-09-20T12:30:00Z",
                        const char *last = "2008-09-20T13:00:00Z") {
  Diagnostics diagnostics;
  TrajectoryRequest request;
  request.first = utc(first);
  request.last = utc(last);
  return read_trajectory(text, "orbit", request, diagnostics);
}
std::string replaced(std::string text, const std::string &from, const std::string &to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

/// A Kepler orbit of eccentricity e in its plane, by Newton's method: the oracle of interpolation.
EphemerisState kepler(Epoch<Utc> start, double seconds, double e) {
  constexpr double gm = 398600.4418, a = 7500;
  const double n = std::sqrt(gm / (a * a * a)), anomaly = n * seconds;
  double ecc = anomaly;
  for (int k = 0; k < 50; ++k)
    ecc -= (ecc - e * std::sin(ecc) - anomaly) / (1 - e * std::cos(ecc));
  const double rate = n / (1 - e * std::cos(ecc)), b = a * std::sqrt(1 - e * e);
  return {plus_seconds(start, seconds),
          {a * (std::cos(ecc) - e), b * std::sin(ecc), 0},
          {-a * std::sin(ecc) * rate, b * std::cos(ecc) * rate, 0}};
}

TEST(Trajectory, InterpolatesAKeplerOrbit) {
  const Epoch<Utc> start = utc("2018-01-21T00:00:00Z");
  struct Case {
    Interpolation method;
    int degree;
    double step_s, position_km, velocity_km_s;
  };
  // Errors of the polynomials for these steps, a few times what theory gives: (n h)^(d+1) a /
  // (d+1)!
  const Case cases[] = {{Interpolation::Hermite, 7, 60, 2e-7, 1e-8},
                        {Interpolation::Hermite, 3, 60, 5e-3, 5e-4},
                        {Interpolation::Lagrange, 8, 60, 2e-6, 2e-9},
                        {Interpolation::Linear, 1, 1, 2e-3, 2e-6}};
  for (const Case &one : cases) {
    OrbitEphemeris ephemeris{"a", "2018-001A", 0, {}};
    EphemerisSegment segment;
    segment.frame = OrbitFrame::Teme;
    segment.interpolation = one.method;
    segment.degree = one.degree;
    for (int k = 0; k <= 100; ++k)
      segment.states.push_back(kepler(start, one.step_s * k, 0.1));
    segment.first = segment.states.front().time;
    segment.last = segment.states.back().time;
    ephemeris.segments.push_back(segment);
    ASSERT_TRUE(check_ephemeris(ephemeris));
    const Trajectory orbit(ephemeris);
    for (int k = 20; k < 80; ++k) {
      const double t = one.step_s * (k + 0.37);
      const auto state = std::get<TemeState>(*orbit.at(plus_seconds(start, t)));
      const EphemerisState truth = kepler(start, t, 0.1);
      EXPECT_NEAR(state.position_km.x, truth.position_km[0], one.position_km);
      EXPECT_NEAR(state.position_km.y, truth.position_km[1], one.position_km);
      EXPECT_NEAR(state.velocity_km_s.x, truth.velocity_km_s[0], one.velocity_km_s);
      EXPECT_NEAR(state.velocity_km_s.y, truth.velocity_km_s[1], one.velocity_km_s);
    }
    // At a state the state itself, to the rounding of its date (20 us).
    const auto node = std::get<TemeState>(*orbit.at(segment.states[7].time));
    EXPECT_NEAR(node.position_km.x, segment.states[7].position_km[0], 2e-4);
  }
}

TEST(Trajectory, ReadsAnEphemerisAgainstTheSameOrbitBySgp4) {
  // oem.kvn was made by SGP4 from the example set of the TLE format.
  const auto oem = read(*read_file(folder + "oem.kvn"));
  ASSERT_TRUE(oem) << oem.error().text();
  const auto tle = read("ISS (ZARYA)\n"
                        "1 25544U 98067A   08264.51782528 -.00002182  00000-0 -11606-4 0  2927\n"
                        "2 25544  51.6416 247.4627 0006703 130.5360 325.0288 15.72125391563537\n");
  ASSERT_TRUE(tle) << tle.error().text();
  EXPECT_EQ(oem->id(), "1998-067A");
  EXPECT_EQ(tle->id(), "25544");
  for (int k = 0; k < 60; ++k) {
    const Epoch<Utc> time = plus_seconds(utc("2008-09-20T12:40:00Z"), 97.3 * k);
    const TemeState a = teme_state(*oem->at(time), time), b = teme_state(*tle->at(time), time);
    // Lagrange of degree 8 over 180 s: 1e-3 km; velocity printed to 1e-6 km/s.
    EXPECT_LT(norm(a.position_km - b.position_km), 2e-3) << k;
    EXPECT_LT(norm(a.velocity_km_s - b.velocity_km_s), 5e-6) << k;
  }
}

TEST(Trajectory, SaysWhereAnEphemerisEnds) {
  const auto oem = read(*read_file(folder + "oem.kvn"));
  const auto state = oem->at(utc("2008-09-20T15:00:00Z"));
  ASSERT_FALSE(state);
  EXPECT_EQ(state.error().code, ErrorCode::Physics);
  EXPECT_NE(state.error().message.find("does not cover 2008-09-20T15:00:00.000Z; it holds "
                                       "2008-09-20T12:25:40.104Z to 2008-09-20T14:25:40.104Z"),
            std::string::npos)
      << state.error().message;
  EXPECT_TRUE(oem->at(utc("2008-09-20T12:25:40.104192Z")));
  EXPECT_TRUE(oem->at(utc("2008-09-20T14:25:40.104192Z")));
  const std::vector<Epoch<Utc>> times{utc("2008-09-20T12:30:00Z"), utc("2008-09-20T14:30:00Z"),
                                      utc("2008-09-20T12:31:00Z")};
  std::vector<OrbitState> states(3);
  EXPECT_EQ(oem->at(times, states), 1u);
}

TEST(Trajectory, FramesOfAnEphemerisAgree) {
  // One place in four frames; the rotations are those of umov/frames, tested there.
  const Epoch<Utc> time = utc("2018-01-21T08:00:00Z");
  const Vec3<Gcrs> r{5000, 4000, 3000}, v{-4, 5, 2};
  const auto itrs = itrs_from_gcrs(time);
  const Vec3<Itrs> turning = itrs * v - cross(Vec3<Itrs>{0, 0, 7.292115e-5}, itrs * r);
  const auto orbit_of = [&](OrbitFrame frame, auto position, auto velocity) {
    EphemerisSegment segment;
    segment.frame = frame;
    segment.interpolation = Interpolation::Linear;
    segment.first = time;
    segment.last = plus_seconds(time, 1);
    for (const double s : {0.0, 1.0})
      segment.states.push_back({plus_seconds(time, s),
                                {position.x, position.y, position.z},
                                {velocity.x, velocity.y, velocity.z}});
    OrbitEphemeris out{"a", "b", 0, {segment}};
    EXPECT_TRUE(check_ephemeris(out));
    return Trajectory(out);
  };
  const OrbitState in_gcrs = *orbit_of(OrbitFrame::Gcrs, r, v).at(time),
                   in_itrs = *orbit_of(OrbitFrame::Itrs, itrs * r, turning).at(time);
  EXPECT_TRUE(std::holds_alternative<GcrsState>(in_gcrs)); // nobody asked for it to be turned
  EXPECT_TRUE(std::holds_alternative<ItrsState>(in_itrs));
  const GcrsState gcrs = gcrs_state(in_gcrs, time), earth = gcrs_state(in_itrs, time),
                  eme = gcrs_state(*orbit_of(OrbitFrame::Eme2000, r, v).at(time), time);
  EXPECT_EQ(gcrs.position_km.x, r.x);
  const TemeState teme = teme_state(in_gcrs, time), also = teme_state(in_itrs, time);
  EXPECT_LT(norm(teme.position_km - also.position_km), 1e-9);
  EXPECT_LT(norm(gcrs_state(teme, time).position_km - r), 1e-9);
  EXPECT_LT(norm(gcrs_state(teme, time).velocity_km_s - v), 1e-12);
  EXPECT_LT(norm(gcrs.position_km - earth.position_km), 1e-9);
  EXPECT_LT(norm(gcrs.velocity_km_s - earth.velocity_km_s), 1e-12);
  // The frame bias is 23 milliarcseconds (IERS 2010): 0.8 m at this distance.
  EXPECT_NEAR(norm(gcrs.position_km - eme.position_km), 7071 * 0.0168 / 206265, 4e-4);
}

TEST(Trajectory, IntegratesAStateVector) {
  // The node of a circular orbit drifts by -3/2 n J2 (R/p)^2 cos i (Kozai 1959), and so does this
  // one, to second order in J2 and the pull of Sun and Moon: 0.3 %.
  StateVector start;
  start.name = "a";
  start.frame = OrbitFrame::Gcrs;
  constexpr double gm = 398600.4418, a = 7200, i = 1.1, j2 = 1.08262668e-3, radius = 6378.1363;
  const double speed = std::sqrt(gm / a);
  start.state = {
      utc("2018-01-21T00:00:00Z"), {a, 0, 0}, {0, speed * std::cos(i), speed * std::sin(i)}};
  const Epoch<Utc> later = plus_seconds(start.state.time, 86400);
  const auto orbit = integrate_orbit(start, start.state.time, later);
  ASSERT_TRUE(orbit) << orbit.error().text();
  const Trajectory path(*orbit);
  const auto node_at = [&](Epoch<Utc> time) {
    const TemeState s = teme_state(*path.at(time), time);
    const Vec3<Teme> h = cross(s.position_km, s.velocity_km_s);
    return std::atan2(h.x, -h.y);
  };
  // Whole turns only: the node wavers twice a turn.
  const double turn = 2 * pi * std::sqrt(a * a * a / gm);
  const double drift =
      node_at(plus_seconds(start.state.time, 14 * turn)) - node_at(start.state.time);
  const double expected = -1.5 * j2 * std::pow(radius / a, 2) * std::cos(i) * 2 * pi * 14;
  EXPECT_NEAR(drift / expected, 1, 6e-3);
  // Backwards and forwards again.
  StateVector end = start;
  end.state = orbit->segments[0].states.back();
  const auto back = integrate_orbit(end, start.state.time, end.state.time);
  ASSERT_TRUE(back);
  const auto first = std::get<GcrsState>(*Trajectory(*back).at(start.state.time)),
             truth = std::get<GcrsState>(*path.at(start.state.time));
  // The pole of the state's date is held; in a day it moves by 0.055 arcsec, which turns the pull
  // of J2 (1e-5 km/s2) by 3e-7: a metre over the day.
  EXPECT_LT(norm(first.position_km - truth.position_km), 2e-3);
}

TEST(Trajectory, ReadsAnOpm) {
  const auto orbit = read(*read_file(folder + "opm.kvn"));
  ASSERT_TRUE(orbit) << orbit.error().text();
  const Epoch<Utc> time = utc("2008-09-20T12:25:40.104192Z");
  const TemeState state = teme_state(*orbit->at(time), time);
  EXPECT_NEAR(state.position_km.x, 4086.147180, 1e-3);
  EXPECT_NEAR(state.velocity_km_s.z, -0.583165, 1e-6);
  const auto metres = read(*read_file(folder + "opm_strange_units.kvn"));
  ASSERT_TRUE(metres) << metres.error().text();
  EXPECT_NEAR(teme_state(*metres->at(time), time).position_km.y, 5617.725542, 1e-3);
}

TEST(Trajectory, RefusesWithTheReason) {
  const std::string oem = *read_file(folder + "oem.kvn");
  const std::pair<std::string, const char *> cases[] = {
      {*read_file(folder + "oem_interplanetary.kvn"), "CENTER_NAME is \"MARS BARYCENTER\""},
      {replaced(oem, "= TEME", "= TOD"), "REF_FRAME is \"TOD\", expected GCRF"},
      {replaced(oem, "= UTC", "= MRT"), "TIME_SYSTEM is \"MRT\""},
      {replaced(oem, "= LAGRANGE", "= SPLINE"), "INTERPOLATION is \"SPLINE\""},
      {replaced(oem, "= 8", "= 0"), "INTERPOLATION_DEGREE is \"0\""},
      {replaced(oem, "= 8", "= 1e30"), "INTERPOLATION_DEGREE is \"1e30\""},
      {replaced(oem, "2008-09-20T12:28:40.104192 ", "2008-09-20T12:20:40.104192 "),
       "expected a later time"},
      {replaced(oem, "STOP_TIME            = 2008-09-20T14",
                "STOP_TIME            = 2008-09-20T18"),
       "is not within the states"},
      {replaced(oem, "2008-09-20T12:28:40.104192 ", "2008-13-20T12:28:40.104192 "),
       "is not in the calendar"},
      {*read_file(folder + "opm_impulsive_man_tnw.kvn"), "has a manoeuvre"},
      {*read_file(folder + "tdm.kvn"), "is a CCSDS TDM; an orbit was expected"}};
  for (const auto &[text, expected] : cases) {
    const auto orbit = read(text);
    ASSERT_FALSE(orbit) << expected;
    EXPECT_EQ(orbit.error().code, ErrorCode::BadInput);
    EXPECT_NE(orbit.error().text().find(expected), std::string::npos) << orbit.error().text();
  }
}

} // namespace
} // namespace umov
