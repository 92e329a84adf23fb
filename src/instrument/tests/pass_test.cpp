// HST over Maui on 2018-01-21, q_scat = .5: azimuths and altitudes, the axis of scattering from the
// zenith and from the pole of the ITRS, q and u in all three frames (docs/theory/observing.md 4).
#include <cmath>
#include <gtest/gtest.h>
#include <umov/instrument/mueller.h>
#include <umov/instrument/telescope.h>

namespace umov {
namespace {

struct PassRow {
  double az, alt, psi_altaz, psi_pole, eta, q_altaz, u_altaz, q_pole, u_pole, q_own, u_own;
};

constexpr PassRow rows[] = {{221.56069, 29.869578, 129.63299, 173.07674, 43.443757, -.09312508,
                             -.4912512, .4854702, -.1196609, -.4719985, -.1649769},
                            {200.16423, 47.030333, 142.83101, 162.88072, 20.049704, .1349812,
                             -.4814354, .4133510, -.2813200, -.3494447, -.3576149},
                            {140.52347, 55.844337, 11.093944, 154.33112, -36.76282, .4629752,
                             .1888225, .3123641, -.3904211, .3950127, -.3065370},
                            {98.971399, 38.938619, 40.477678, 152.12606, -68.351615, .07860201,
                             .4937831, .2814178, -.4132844, .4669297, .1788202}};

/// Position angle of the zenith from the pole, for a latitude of 20.7083 deg.
double parallactic_deg(const PassRow &r) {
  const double az = r.az * pi / 180, alt = r.alt * pi / 180, lat = 20.7083 * pi / 180;
  // The pole as the observer sees it: towards the zenith, and to the left of it where the object is
  // in the west.
  const double up = std::sin(lat) * std::cos(alt) - std::cos(lat) * std::sin(alt) * std::cos(az);
  const double right = -std::cos(lat) * std::sin(az); // towards larger azimuth
  return std::atan2(right, up) * 180 / pi; // counter-clockwise from the pole to the zenith
}

TEST(Pass, FramesTurnIntoEachOther) {
  for (const PassRow &r : rows) {
    const Stokes<InstrumentAxes> altaz{1, .5 * std::cos(2 * r.psi_altaz * pi / 180),
                                       .5 * std::sin(2 * r.psi_altaz * pi / 180), 0};
    constexpr double digits = 1e-6; // of the table, and of angles to 1e-5 deg
    EXPECT_NEAR(altaz.q, r.q_altaz, digits);
    EXPECT_NEAR(altaz.u, r.u_altaz, digits);
    EXPECT_NEAR(parallactic_deg(r), r.eta, 5e-6); // of directions to 1e-5 deg and 1e-6 deg
    // S_altaz = R(eta) S_pole; the camera stands 30 deg from the zenith direction.
    const auto pole = axes_turned(Angle::degrees(-r.eta)) * altaz;
    EXPECT_NEAR(pole.q, r.q_pole, digits);
    EXPECT_NEAR(pole.u, r.u_pole, digits);
    const auto own = axes_turned(Angle::degrees(30)) * altaz;
    EXPECT_NEAR(own.q, r.q_own, digits);
    EXPECT_NEAR(own.u, r.u_own, digits);
    // The same camera on an equatorial mount that stands as the alt-azimuth one does just then.
    Telescope t;
    t.mount = Mount::Equatorial;
    const Angle eta = Angle::degrees(r.eta), chi = Angle::degrees(30 + r.eta);
    EXPECT_NEAR(axis_from_zenith(t, chi, eta, Angle::degrees(r.alt)).degrees(), 30, 1e-12);
  }
}

} // namespace
} // namespace umov
