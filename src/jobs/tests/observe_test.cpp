#include "jobs/observe_plan.h"
#include "jobs/observe_sky.h"

#include <cmath>
#include <gtest/gtest.h>
#include <umov/atmosphere/sky_polarization.h>
#include <umov/core/files.h>
#include <umov/io/passband_file.h>
#include <umov/io/tle.h>
#include <umov/orbit/moon.h>
#include <umov/orbit/trajectory.h>

namespace umov::jobs {
namespace {

std::vector<BandResponse> two_bands() {
  return {*narrow_band("nm:550", 550, 10), *narrow_band("nm:650", 650, 10)};
}

/// A wheel of analysers with a filter at each step.
ScenarioObservation wheel(const std::vector<std::pair<double, const char *>> &steps) {
  ScenarioObservation out;
  out.instrument.polarimeter.type = PolarimeterType::PolarizerWheel;
  for (const auto &[angle, band] : steps)
    out.sequence.push_back({{angle, 0, 0}, band});
  return out;
}

Result<Programme> make(const ScenarioObservation &observation,
                       const std::vector<BandResponse> &bands, Diagnostics &diagnostics) {
  Scenario scenario;
  scenario.observation = observation;
  return Programme::make(scenario, bands, diagnostics);
}

TEST(Programme, EveryBandMustBeSolvedByItself) {
  Diagnostics diagnostics;
  const char *const v = "nm:550", *const r = "nm:650";
  // Four analysers, but the fourth in another band.
  const auto bad = make(wheel({{0, v}, {45, v}, {90, v}, {135, r}}), two_bands(), diagnostics);
  ASSERT_FALSE(bad);
  EXPECT_NE(bad.error().message.find("nm:650"), std::string::npos) << bad.error().message;
  const auto none = make(wheel({{0, v}, {45, v}, {90, v}}), two_bands(), diagnostics);
  ASSERT_FALSE(none);
  EXPECT_NE(none.error().message.find("no step in band"), std::string::npos);
  const auto good =
      make(wheel({{0, v}, {0, r}, {60, v}, {60, r}, {120, ""}}), two_bands(), diagnostics);
  ASSERT_TRUE(good) << good.error().message;
  EXPECT_TRUE(diagnostics.empty());
  // A set is a round of all: three exposures of each band.
  for (std::size_t k = 0; k < 12; ++k)
    EXPECT_EQ(good->at(k).set, k / 6);
}

TEST(Programme, WarnsOfWhatHelpsLittle) {
  Diagnostics diagnostics;
  const auto bands = std::vector{two_bands()[0]};
  ASSERT_TRUE(make(wheel({{0, ""}, {3, ""}, {6, ""}}), bands, diagnostics));
  ASSERT_EQ(diagnostics.warnings().size(), 1u);
  EXPECT_NE(diagnostics.warnings()[0].text().find("condition"), std::string::npos);
  ScenarioObservation mosaic = wheel({{45, ""}});
  mosaic.instrument.polarimeter.type = PolarimeterType::Mosaic;
  mosaic.instrument.polarimeter.angles_deg = {90, 45, 135, 0};
  ASSERT_TRUE(make(mosaic, bands, diagnostics));
  ASSERT_EQ(diagnostics.warnings().size(), 2u);
  EXPECT_NE(diagnostics.warnings()[1].text().find("takes everything at once"), std::string::npos);
}

/// A place under the full Moon at midnight, away from it.
ObservingGeometry moonlit() {
  ObservingGeometry out;
  out.time = *utc_from_iso("2018-01-31T13:00:00Z"); // full Moon at 13:27
  const Vec3<Gcrs> to_moon = normalized(moon_km(out.time));
  out.zenith = normalized(to_moon + any_perpendicular(to_moon) * 0.5);
  out.observer_gcrs_km = out.zenith * 6378.;
  out.to_observer = -normalized(out.zenith - any_perpendicular(to_moon) * 0.5);
  out.sun_gcrs_km = to_moon * -1.5e8;
  out.sun_altitude = Angle::degrees(-60);
  return out;
}

TEST(Sky, MoonlightIsSunlightThatTheAirScatters) {
  SkyModel sky;
  sky.v = *curve_band(*find_passband("Bessell.V"));
  for (const char *letter : {"U", "B", "V", "R", "I"})
    sky.options.dark_mag[letter] = 60; // none
  sky.air = {1013.25, 0, 1.3, 0, 0};
  const ObservingGeometry g = moonlit();
  const auto magnitude = [&](const char *name) {
    const BandResponse band = *curve_band(*find_passband(name));
    return -2.5 * std::log10(sky_light(sky, band, g).i / band.zero_flux);
  };
  sky.air.pressure_hpa = 1; // thin: as bright as k of the band
  const double thin = magnitude("Bessell.B") - magnitude("Bessell.V");
  // Sun of Bessell B - V in AB: -26.24065 + 26.76973 (docs/theory/bands.md); molecules scatter with
  // lambda^-4.05 about there (Bodhaine et al. 1999), from 439.87 to 550.03 nm.
  EXPECT_NEAR(thin, .52908 - 2.5 * 4.07 * std::log10(550.0328 / 439.8713), .02);
  sky.air.pressure_hpa = 1013.25;
  EXPECT_GT(magnitude("Bessell.B") - magnitude("Bessell.V"), thin); // thick air loses more blue
  EXPECT_LT(magnitude("Bessell.V") - magnitude("Bessell.I"), .285); // AB: bluer than the Sun
}

TEST(Sky, SunlitSkyIsPolarizedAsAnObjectThere) {
  // Every minute of a day of three orbits (tests/data/ephemeris): low, low and geostationary.
  Diagnostics diagnostics;
  const std::string file = UMOV_SOURCE_DIR "/tests/data/ephemeris/elements.tle";
  const auto sets = read_tle(*read_file(file), file, {}, diagnostics);
  const Site site = *make_site("maui", 20.7083, -156.2578, 3058);
  const Epoch<Utc> start = *utc_from_iso("2018-01-21T00:00:00Z");
  std::size_t rows = 0;
  for (const ElementSet &set : *sets) {
    if (set.norad_cat_id != 20580 && set.norad_cat_id != 733 && set.norad_cat_id != 36411)
      continue;
    const Trajectory orbit(set);
    for (int minute = 0; minute < 1440; ++minute) {
      const Epoch<Utc> time = plus_seconds(start, 60. * minute);
      const auto g = umov::observe(*orbit.at(time), time, site, ShadowModel::Ellipsoid);
      const auto sun = horizontal_direction(g.sun_azimuth, g.sun_altitude);
      const auto object = horizontal_direction(g.azimuth, g.altitude);
      const double apart = angle_between(sun, object) * 180 / pi;
      if (!(g.altitude.degrees() > 0) || apart < 5 || apart > 175)
        continue;
      const double off = scattered_sky(sun, object, 1).axis.degrees() - g.pa_scat_altaz.degrees();
      EXPECT_NEAR(std::remainder(off, 180), 0, .01) << to_iso(time);
      ++rows;
    }
  }
  EXPECT_GT(rows, 1500u);
}

} // namespace
} // namespace umov::jobs
