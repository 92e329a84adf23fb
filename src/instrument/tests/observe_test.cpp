#include "instrument/tests/anchor.h"

#include <gtest/gtest.h>
#include <tuple>
#include <umov/instrument/observe.h>

namespace umov {
namespace {

Instrument camera() {
  Instrument out;
  out.telescope = {.2794, .34, 2.794, {{}, {.35}}};
  out.detector.model = DetectorModel::Cmos;
  out.detector.pixel_um = 3.45;
  out.detector.read_e = 2.3;
  out.detector.gain_e_adu = 2.6;
  out.detector.well_e = 10500;
  out.polarimeter.type = PolarimeterType::Mosaic;
  out.polarimeter.angles_deg = {90, 45, 135, 0};
  out.polarimeter.extinction = {{}, {300}};
  return out;
}

/// A band of 10 nm at 550: what it holds follows from three constants.
BandObserver observer(const Instrument &instrument, const ObservingConditions &conditions) {
  auto out = BandObserver::make(instrument, *narrow_band("nm:550", 550, 10), conditions, {});
  EXPECT_TRUE(out);
  EXPECT_TRUE(out->prepare({}));
  return *out;
}

ExposureLight star(double flux, double q, double u) {
  ExposureLight out;
  out.flux = {{flux, flux * q, flux * u, 0}};
  out.axis_zenith = Angle::degrees(30);
  out.altitude = Angle::degrees(60);
  return out;
}

ObservingConditions no_air() {
  ObservingConditions out;
  out.air = {0, 0, 1.3, 0, 0};
  out.aperture_fwhm = 1;
  return out;
}

TEST(BandObserver, ElectronsFollowFromEnergy) {
  const BandObserver one = observer(camera(), no_air());
  // 10 nm of 1e-14 W m-2 nm-1 at 550 nm, h c / lambda = 3.611719e-19 J, .0542239834 m2, .35.
  const double rate = 1e-13 / 3.6117192e-19 * of("area_c11") * .35;
  EXPECT_NEAR(one.rate_per_flux() * 1e-14 / rate, 1, 1e-6);
  const auto counts = one.observe({0, .05, {}}, star(1e-14, .4, -.3));
  double sum = 0;
  for (const ChannelCounts &c : *counts)
    sum += c.mean_star;
  // All four orientations together: the light of I alone, (1 + 1/E)/2 of it, in the aperture.
  EXPECT_NEAR(sum / (rate * .05 * of("moffat_1") * (1 + 1. / 300) / 2), 1, 1e-6);
}

TEST(BandObserver, RowsAreThoseOfTheMeans) {
  Instrument instrument = camera();
  const BandObserver one = observer(instrument, no_air());
  ExposureLight light = star(1e-14, .4, -.3);
  const auto counts = one.observe({0, .05, {}}, light);
  const auto sky = rotate_to<SkyNorth>(light.flux[0], Angle::degrees(-30));
  for (const ChannelCounts &c : *counts)
    EXPECT_NEAR(respond(c.row, sky) / c.mean_star, 1, 1e-12);
}

TEST(BandObserver, InstrumentalTermsAreNotInTheRows) {
  Instrument instrument = camera();
  const auto clean = observer(instrument, no_air()).observe({0, .05, {}}, star(1e-14, 0, 0));
  instrument.polarimeter.q0 = .01;
  const auto spoilt = observer(instrument, no_air()).observe({0, .05, {}}, star(1e-14, 0, 0));
  for (std::size_t c = 0; c < 4; ++c)
    EXPECT_EQ(clean->at(c).row, spoilt->at(c).row);
  // Channel 3 stands at 0 deg, channel 0 at 90: q0 and -q0 times the diattenuation.
  const double d = of("diattenuation_300"); // nine digits
  EXPECT_NEAR(spoilt->at(3).mean_star / clean->at(3).mean_star, 1 + .01 * d, 1e-11);
  EXPECT_NEAR(spoilt->at(0).mean_star / clean->at(0).mean_star, 1 - .01 * d, 1e-11);
}

TEST(BandObserver, CountersAreCorrectedForDeadTime) {
  Instrument instrument = camera();
  instrument.detector = {};
  instrument.detector.pixel_um = 3.45;
  instrument.detector.model = DetectorModel::Counter;
  const BandObserver open = observer(instrument, no_air());
  // Dead for a fifth of the time between two photons of channel 0: a sixth of them are missed.
  const double mean = open.observe({0, .1, {}}, star(1e-12, 0, 0))->at(0).mean_star;
  instrument.detector.dead_time_s = .2 * .1 / mean;
  const BandObserver one = observer(instrument, no_air());
  constexpr int trials = 20'000;
  double told = 0, sum = 0, squares = 0, excess = 0;
  for (std::uint32_t k = 0; k < trials; ++k) {
    const auto n = one.observe({k, .1, {}}, star(1e-12, 0, 0))->at(0);
    told += n.recorded / trials;
    sum += n.counts / trials;
    squares += n.counts * n.counts / trials;
    excess += n.excess2 / trials;
  }
  const double se = std::sqrt(1.2 * mean / trials);
  EXPECT_NEAR(told, mean / 1.2, 4 * se);
  // Four standard errors, and a photon for the bend of 1/(1 - m tau) within its scatter.
  EXPECT_NEAR(sum, mean, 4 * se + 1);
  EXPECT_NEAR(excess, 1.2, 1e-3);
  EXPECT_NEAR((squares - sum * sum) / (1.2 * mean), 1, 4 * std::sqrt(2. / trials));
}

/// Phases of a modulator and states of a cell that flips have their part of the time: of dark
/// current, of sky, and of the seconds in which a counter is dead.
TEST(BandObserver, PhasesCollectForTheirPartOfTheExposure) {
  Instrument instrument = camera();
  instrument.detector.dark_e_s = 50;
  instrument.polarimeter.angles_deg.clear();
  for (const auto &[type, channels, share] :
       {std::tuple{PolarimeterType::Pem, 8u, 1. / 8}, {PolarimeterType::Flc, 4u, 1. / 2}}) {
    instrument.polarimeter.type = type;
    const auto found = observer(instrument, no_air()).observe({0, 2, {}}, star(0, 0, 0));
    ASSERT_EQ(found->size(), channels);
    for (const ChannelCounts &c : *found) {
      EXPECT_NEAR(c.seconds, 2 * share, 1e-15);
      EXPECT_NEAR(c.mean_sky, 50 * 2 * share * c.pixels, 1e-9); // no light of a sky
    }
  }
  // Through each of two states for half of the time light is as dense as through one for all of it.
  instrument.detector = {};
  instrument.detector.pixel_um = 3.45;
  instrument.detector.model = DetectorModel::Counter;
  const auto excess_of = [&](PolarimeterType type) {
    instrument.polarimeter.type = type;
    return observer(instrument, no_air()).observe({0, 1, {}}, star(1e-9, 0, 0))->at(0).excess2;
  };
  instrument.detector.dead_time_s = 1e-8;
  const double plate = excess_of(PolarimeterType::HwpDualBeam);
  EXPECT_GT(plate, 1.05);
  EXPECT_NEAR(excess_of(PolarimeterType::Flc) - 1, plate - 1, .01 * (plate - 1)); // drawn: 1e-3
}

/// Light along +Q of the sky, carried through the port to the instrument's x axis as it stands.
TEST(BandObserver, ADerotatorKeepsTheAxisOnTheSky) {
  Instrument instrument = camera();
  instrument.telescope.has_derotator = true;
  for (const auto port :
       {TelescopePort::Cassegrain, TelescopePort::NasmythLeft, TelescopePort::NasmythRight}) {
    instrument.telescope.port = port;
    // A mirror as good as perfect: no polarization of its own.
    const bool has_mirror = port != TelescopePort::Cassegrain;
    const std::vector<std::complex<double>> eta(has_mirror ? 1 : 0, {1e4, 1e4});
    const auto one = BandObserver::make(instrument, *narrow_band("nm:550", 550, 10), no_air(), eta);
    for (const double parallactic : {-70., 0., 35.})
      for (const double altitude : {15., 50., 80.}) {
        const Angle up = Angle::degrees(altitude), pa = Angle::degrees(parallactic);
        const Angle axis = axis_from_zenith(instrument.telescope, Angle::degrees(30), pa, up);
        // Polarized along position angle 30 from north, in zenith axes.
        const double twice = 2 * (30 - parallactic) * pi / 180;
        const auto light =
            one->at_polarimeter(0, {1, std::cos(twice), std::sin(twice), 0}, up, axis);
        EXPECT_NEAR(light.q / light.i, 1, 1e-3); // 1 - R of the mirror
        EXPECT_NEAR(light.u / light.i, 0, 1e-3);
        EXPECT_NEAR(std::remainder(axis_on_sky(instrument.telescope, axis, up).degrees() -
                                       (30 - parallactic),
                                   360),
                    0, 1e-9);
      }
  }
}

/// Standard deviation over mean of the counts of one channel, and of a ratio of two.
struct Scatter {
  double one = 0, ratio = 0;
};
Scatter scatter(const BandObserver &observer, int trials) {
  double s = 0, ss = 0, r = 0, rr = 0;
  for (int k = 0; k < trials; ++k) {
    const auto n = observer.observe({static_cast<std::uint32_t>(k), .1, {}}, star(1e-9, 0, 0));
    const double a = (n->at(0).counts - n->at(0).sky) / n->at(0).mean_star;
    const double b = (n->at(1).counts - n->at(1).sky) / n->at(1).mean_star;
    s += a, ss += a * a, r += a / b, rr += a / b * (a / b);
  }
  const double m = s / trials, q = r / trials;
  return {std::sqrt(ss / trials - m * m), std::sqrt(rr / trials - q * q)};
}

ObservingConditions flickering_air() {
  ObservingConditions out = no_air();
  out.scintillation = ScintillationSite{3058, 1.5};
  return out;
}

/// Photons alone.
Instrument camera_without_noise() {
  Instrument out = camera();
  out.detector = {};
  out.detector.pixel_um = 3.45;
  return out;
}

TEST(BandObserver, ScintillationHasOsbornsVariance) {
  const ObservingConditions windy = flickering_air();
  Instrument instrument = camera_without_noise();
  constexpr int trials = 100'000;
  const BandObserver one = observer(instrument, windy);
  double s = 0, ss = 0, mean = 0;
  for (std::uint32_t k = 0; k < trials; ++k) {
    const auto n = one.observe({k, .1, {}}, star(1e-9, 0, 0));
    const double x = (n->at(0).counts - n->at(0).sky) / n->at(0).mean_star - 1;
    s += x / trials, ss += x * x / trials, mean = n->at(0).mean_star;
  }
  const double sd = scintillation_sd(*windy.scintillation, .2794, .1, 1);
  // Beside it the photons' own 1/N.
  // The variance of 1e5 numbers is known to .45 %; and the mean to sd/316.
  EXPECT_NEAR((ss - s * s - 1 / mean) / (sd * sd), 1, .02);
  EXPECT_NEAR(s, 0, 4 * sd / std::sqrt(double(trials)));
}

/// Strong scintillation too has the standard deviation that is told beside the counts.
TEST(BandObserver, TheToldScatterOfStrongScintillationIsThatOfTheCounts) {
  const ObservingConditions windy = flickering_air();
  Instrument instrument = camera_without_noise();
  instrument.telescope.aperture_m = .1;
  instrument.telescope.obstruction = 0;
  const BandObserver one = observer(instrument, windy);
  ExposureLight light = star(1e-9, 0, 0);
  light.airmass = 6;
  constexpr double exposure_s = .1;
  const double sd = scintillation_sd(*windy.scintillation, .1, exposure_s, light.airmass);
  ASSERT_GT(sd, .5);
  ASSERT_LT(sd, 1);
  constexpr int trials = 100'000;
  double s = 0, ss = 0;
  for (std::uint32_t k = 0; k < trials; ++k) {
    const double x = one.transparency({k, exposure_s, {}}, light, 0) - 1;
    s += x / trials, ss += x * x / trials;
  }
  // A log-normal number's excess of the fourth moment, w = 1 + sd^2: four standard errors each.
  const double w = 1 + sd * sd;
  const double fourth = w * w * w * w + 2 * w * w * w + 3 * w * w - 3;
  EXPECT_NEAR((ss - s * s) / (sd * sd), 1, 4 * std::sqrt((fourth - 1) / trials));
  EXPECT_NEAR(s, 0, 4 * sd / std::sqrt(double(trials)));
}

TEST(BandObserver, AMeasuredExtinctionWithoutNumbersIsRefused) {
  ObservingConditions conditions = no_air();
  for (const MeasuredExtinction &table :
       {MeasuredExtinction{}, MeasuredExtinction{{500, 600}, {.1}}}) {
    conditions.air.measured = std::make_shared<const MeasuredExtinction>(table);
    EXPECT_TRUE(std::isnan(extinction_mag(550, conditions.air)));
    const auto made = BandObserver::make(camera(), *narrow_band("nm:550", 550, 10), conditions, {});
    ASSERT_FALSE(made);
    EXPECT_NE(made.error().message.find("as many of both"), std::string::npos);
  }
}

TEST(BandObserver, ScintillationIsOneForOnePupil) {
  const ObservingConditions windy = flickering_air();
  Instrument instrument = camera_without_noise();
  constexpr int trials = 20'000;
  const Scatter mosaic = scatter(observer(instrument, windy), trials);
  const double sd = scintillation_sd(*windy.scintillation, .2794, .1, 1);
  EXPECT_NEAR(mosaic.one / sd, 1, 4 / std::sqrt(2. * trials) + .005); // 4 standard errors, photons
  EXPECT_LT(mosaic.ratio, .03 * sd); // what is left are photons: 3e6 of them a channel
  instrument.polarimeter.type = PolarimeterType::FourCamera;
  instrument.polarimeter.has_separate_pupils = true;
  const Scatter lenses = scatter(observer(instrument, windy), trials);
  EXPECT_NEAR(lenses.ratio / (std::sqrt(2.) * sd), 1, .03);
}

} // namespace
} // namespace umov
