#include <algorithm>
#include <array>
#include <cmath>
#include <gtest/gtest.h>
#include <random>
#include <string>
#include <umov/core/quantity.h>
#include <umov/jobs/reduce.h>

namespace umov::jobs {
namespace {

constexpr double degree = pi / 180, electrons = 1e6;

/// Light that does not change, as the tests know it.
struct Source {
  double q = .3, u = -.1;
  PolarimeterCalibration instrument; ///< what the telescope does to it
};

Epoch<Utc> second(double s) { return plus_seconds(*utc_from_iso("2018-01-21T05:12:00Z"), s); }

/// What an analyser of the instrument records, without noise.
CountRow behind(const Source &source, double analyser_deg, double axis_deg, double time_s) {
  CountRow out;
  out.time = second(time_s);
  out.exposure = std::lround(time_s);
  out.band = "V";
  out.x_axis_pa_deg = axis_deg;
  const double a = 2 * analyser_deg * degree, on_sky = a + 2 * axis_deg * degree;
  const std::complex<double> z = source.instrument.factor * std::complex(source.q, source.u) *
                                     std::polar(1., -2 * axis_deg * degree) +
                                 source.instrument.offset;
  out.counts = electrons / 2 * (1 + z.real() * std::cos(a) + z.imag() * std::sin(a));
  out.row = {.5, .5 * std::cos(on_sky), .5 * std::sin(on_sky), 0};
  return out;
}

/// A wheel of four analysers, 10 s apart, while the field turns.
CountsFile wheel(const Source &source, double first_axis, double step) {
  CountsFile out;
  for (int k = 0; k < 4; ++k) {
    const double axis = first_axis + k * step;
    CountRow row = behind(source, 45 * k, axis - 180 * std::floor(axis / 180), 10 * k);
    row.pa_scat_deg = row.x_axis_pa_deg;
    row.phase_angle_deg = 60 + 2 * k;
    out.rows.push_back(row);
  }
  return out;
}

Table reduced(const CountsFile &file, const ReduceOptions &options = {}) {
  Diagnostics diagnostics;
  const auto out = reduce(file, options, {}, diagnostics);
  EXPECT_TRUE(out) << out.error().message;
  return *out;
}

/// Two beams at four positions of a half-wave plate, each exposure through air of its own.
CountsFile two_beams_through(const std::array<double, 4> &air, double gain = 0) {
  CountsFile out;
  for (std::size_t k = 0; k < 4; ++k)
    for (const double beam : {0., 90.}) {
      // A plate at theta turns the analyser by 2 theta: 0, 90, 45, 135.
      const double analysers[] = {0, 90, 45, 135};
      CountRow row = behind({}, analysers[k] + beam, 0, 10. * static_cast<double>(k));
      row.counts *= air[k] * (beam > 0 ? 1 + gain : 1 - gain);
      row.channel = beam > 0 ? "x" : "o";
      out.rows.push_back(row);
    }
  return out;
}

TEST(Reduce, CloudIsCommonToTheBeamsOfAnExposure) {
  const auto cloudy = two_beams_through({1, .8, .9, 1.1});
  // By the ratio of both beams q and u do not know the air (docs/theory/observing.md 6).
  ReduceOptions options;
  options.transparency_sd = .15;
  const Table told = reduced(cloudy, options), clear = reduced(two_beams_through({1, 1, 1, 1}));
  EXPECT_NEAR(told.number("q", 0), .3, 1e-6);
  EXPECT_NEAR(told.number("u", 0), -.1, 1e-6);
  EXPECT_EQ(told.text("flags", 0), "");
  // What the mean of four exposures is known to, and no more than q and u had without cloud.
  EXPECT_NEAR(told.number("I_err", 0) / told.number("I", 0), .15 / 2, .01);
  EXPECT_NEAR(std::sqrt(told.number("cov_qq", 0) / clear.number("cov_qq", 0)), 1, .1);
  const Table untold = reduced(cloudy);
  EXPECT_EQ(untold.text("flags", 0), "misfit");
  EXPECT_LT(untold.number("I_err", 0) / untold.number("I", 0), 1e-3);
  // However thick it may be.
  options.transparency_sd = .9;
  EXPECT_EQ(reduced(cloudy, options).text("flags", 0), "");
  EXPECT_NEAR(reduced(cloudy, options).number("q", 0), .3, 1e-6);
  options.transparency_sd = .15;
  // Beams that are unequal too: the ratio knows neither.
  options.priors.gain = .05;
  const auto uneven = two_beams_through({1, .8, .9, 1.1}, .05);
  const Table both = reduced(uneven, options), neither = reduced(uneven);
  constexpr double square = .05 * .05; // of a gain is left: errors act in proportion
  EXPECT_NEAR(both.number("q", 0), .3, .3 * square);
  EXPECT_NEAR(both.number("u", 0), -.1, .1 * square);
  EXPECT_EQ(both.text("flags", 0), "");
  EXPECT_GT(std::abs(neither.number("q", 0) - .3), 4 * std::sqrt(neither.number("cov_qq", 0)));
}

/// Four exposures 10 s apart of one cloud's process: the best mean of n of them with correlation r
/// from one to the next has the variance (1 + r)/(n - (n - 2) r) of one (Fuller 1996, 2.1).
TEST(Reduce, SlowCloudIsSharedByTheExposuresOfASet) {
  const auto counts = two_beams_through({1, 1, 1, 1});
  ReduceOptions options;
  options.transparency_sd = .15;
  const double q_sd = std::sqrt(reduced(counts, options).number("cov_qq", 0));
  for (const auto &[time_s, r] : {std::pair{1e5, std::exp(-1e-4)}, {10., std::exp(-1.)}}) {
    options.transparency_time_s = time_s;
    const Table table = reduced(counts, options);
    const double mean_of_four = .15 * std::sqrt((1 + r) / (4 - 2 * r));
    // Photons add .001, and what is next order in .15 is 2 % of it.
    EXPECT_NEAR(table.number("I_err", 0) / table.number("I", 0) / mean_of_four, 1, .02) << time_s;
    EXPECT_NEAR(std::sqrt(table.number("cov_qq", 0)) / q_sd, 1, .05); // beams share it as before
  }
  CountsFile told = counts; // by the header, as umov observe writes it
  told.notes["cloud_time_s"] = "1e5";
  options.transparency_time_s = 0;
  EXPECT_NEAR(reduced(told, options).number("I_err", 0) / reduced(told, options).number("I", 0),
              .15, .003);
}

/// What becomes brighter under a cloud that stays is not a thousandth of the cloud's own steps: its
/// mean is that of the counts.
TEST(Reduce, AChangeOfLightUnderASlowCloudIsNotTakenForMuchMoreLight) {
  ReduceOptions options;
  options.transparency_sd = .1;
  options.transparency_time_s = 1e4;
  const Table table = reduced(two_beams_through({.96, .99, 1.01, 1.04}), options);
  // Ends count for more than the middle, alike on both sides; .04^2 is of the next order.
  EXPECT_NEAR(table.number("I", 0) / electrons, 1, .005);
  EXPECT_NEAR(table.number("q", 0), .3, 1e-4);
}

/// A cloud of umov observe, of mean transparency 1, and the one whose logarithm is as far off its
/// mean on the other side: photons aside both together tell the mean logarithm of I without error.
std::array<std::array<double, 4>, 2> opposite_clouds(double sd, double r, auto &normal) {
  std::array<std::array<double, 4>, 2> out{};
  double x = normal();
  for (std::size_t k = 0; k < 4; ++k) {
    for (const double side : {1., -1.})
      out[side > 0 ? 0 : 1][k] = std::exp(side * sd * x - sd * sd / 2);
    x = r * x + std::sqrt(1 - r * r) * normal();
  }
  return out;
}

TEST(Reduce, PullsOfBrightnessUnderCloudsThatAreSlow) {
  std::mt19937_64 random(22);
  std::normal_distribution<double> of_normal;
  const auto normal = [&] { return of_normal(random); };
  for (const double sd : {.1, .45}) { // a tenth and half a magnitude
    constexpr double time_s = 120;
    ReduceOptions options;
    options.transparency_sd = sd;
    options.transparency_time_s = time_s;
    double sum = 0, sum2 = 0;
    constexpr int pairs = 200;
    for (int k = 0; k < pairs; ++k)
      for (const auto &air : opposite_clouds(sd, std::exp(-10 / time_s), normal)) {
        const Table table = reduced(two_beams_through(air), options);
        // Errors are a part of I: its logarithm is normal, I itself is not.
        const double i = table.number("I", 0),
                     pull = std::log(i / electrons) * i / table.number("I_err", 0);
        sum += pull / (2 * pairs), sum2 += pull * pull / (2 * pairs);
      }
    // With clouds about a logarithm of 0 it was -sd/2 and more.
    EXPECT_NEAR(sum, 0, .01) << sd;
    EXPECT_NEAR(std::sqrt(sum2), 1, .15) << sd; // three of 1/sqrt(2 * 200)
  }
}

/// Rows that a caller has in another order, as those of two objects, are the same counts.
TEST(Reduce, TheOrderOfExposuresUnderACloudDoesNotMatter) {
  ReduceOptions options;
  options.transparency_sd = .1;
  options.transparency_time_s = 5;
  CountsFile file = two_beams_through({1, .9, .95, 1.05});
  const Table sorted = reduced(file, options);
  std::rotate(file.rows.begin(), file.rows.begin() + 6, file.rows.end()); // the last comes first
  const Table other = reduced(file, options);
  for (const char *name : {"I", "I_err", "q", "cov_qq"})
    EXPECT_NEAR(other.number(name, 0) / sorted.number(name, 0), 1, 1e-9) << name;
}

/// Lenses of one telescope look through one cloud, each with scintillation of its own.
TEST(Reduce, OneCloudIsBeforeAllLenses) {
  CountsFile file;
  for (const double analyser : {0., 45., 90., 135.}) {
    file.rows.push_back(behind({}, analyser, 0, 0));
    file.rows.back().channel = std::to_string(std::lround(analyser));
  }
  file.notes["pupils"] = "separate";
  const double known = std::sqrt(reduced(file).number("cov_qq", 0));
  ReduceOptions options;
  options.transparency_sd = .1;
  const Table table = reduced(file, options);
  EXPECT_NEAR(table.number("I_err", 0) / table.number("I", 0), .1, .002);
  EXPECT_NEAR(std::sqrt(table.number("cov_qq", 0)) / known, 1, .05);
  for (CountRow &row : file.rows)
    row.scintillation = .1; // .1/sqrt 4 of I, .1 sqrt(2/4) of q
  EXPECT_GT(std::sqrt(reduced(file, options).number("cov_qq", 0)), .05);
}

TEST(Reduce, ATimeOfCloudsWithoutCloudsIsRefused) {
  ReduceOptions options;
  options.transparency_time_s = 60;
  Diagnostics diagnostics;
  EXPECT_FALSE(reduce(two_beams_through({1, 1, 1, 1}), options, {}, diagnostics));
}

TEST(Reduce, WhereTheLightCameFromIsOfTheMiddleOfASet) {
  const Source source;
  for (const double first : {10., 170.}) { // the second goes through 180
    const Table table = reduced(wheel(source, first, 5));
    const double middle = std::fmod(first + 7.5, 180), twice = 2 * middle * degree;
    EXPECT_NEAR(table.number("x_axis_pa", 0), middle, 1e-9);
    EXPECT_NEAR(table.number("phase_angle", 0), 63, 1e-9);
    EXPECT_NEAR(table.number("q_scat", 0), .3 * std::cos(twice) - .1 * std::sin(twice), 1e-9);
  }
}

/// Axes that turn by 1.2 deg a second are .6 deg off by a clock that is .5 s off; where they stand,
/// the clock does not matter.
TEST(Reduce, AClockThatIsOffTurnsTheAxes) {
  ReduceOptions clock, angle;
  clock.priors.time_s = .5;
  angle.priors.angle_rad = .6 * degree;
  for (const double first : {10., 170.}) { // the second goes through 180
    const CountsFile file = wheel({}, first, 12);
    const Table a = reduced(file, clock), b = reduced(file, angle), none = reduced(file);
    for (const char *column : {"cov_qq", "cov_uu", "cov_qu"})
      EXPECT_NEAR(a.number(column, 0) / b.number(column, 0), 1, 1e-9) << column;
    EXPECT_GT(a.number("cov_uu", 0), 3 * none.number("cov_uu", 0));
  }
  const CountsFile still = wheel({}, 10, 0);
  EXPECT_NEAR(reduced(still, clock).number("cov_uu", 0) / reduced(still).number("cov_uu", 0), 1,
              1e-12);
}

TEST(Reduce, TheHeaderTellsThePlatesRetardance) {
  const std::string rows = "time_utc,set_id,band,counts,sky,sky_err,var_read,w0,w1,w2,w3\n"
                           "2018-01-21T05:00:00Z,0,V,100,0,0,0,1,0,0,0\n";
  Diagnostics diagnostics;
  for (const auto &[note, expected] : {std::pair{"# retardance_deg V: 131.8\n", 131.8},
                                       {"# retardance_deg B: 131.8\n", 180.},
                                       {"# retardance_deg: 90\n", 90.}})
    EXPECT_EQ(read_counts_text(note + rows, "c.csv", diagnostics)->rows.front().retardance_deg,
              expected);
}

TEST(Reduce, EveryExposureIsCalibratedByItsOwnAxis) {
  Source source;
  source.instrument.factor = std::polar(.9, 2 * 3 * degree);
  source.instrument.offset = {.02, -.01};
  ReduceOptions options;
  options.calibration = source.instrument;
  const Table table = reduced(wheel(source, 10, 12), options);
  EXPECT_NEAR(table.number("q", 0), source.q, 1e-9); // exact but for rounding
  EXPECT_NEAR(table.number("u", 0), source.u, 1e-9);
}

TEST(Reduce, TheCovarianceTurnsWithTheCalibration) {
  // Twice as many exposures along q as along u; an instrument that stands 45 deg off takes one for
  // the other.
  Source source{0, 0, {}};
  CountsFile file;
  for (const double angle : {0., 90., 0., 90., 45., 135.}) {
    file.rows.push_back(behind(source, angle, 0, 0));
    file.rows.back().var_read = 1e5;
  }
  const Table plain = reduced(file);
  ReduceOptions options;
  options.calibration = PolarimeterCalibration{std::polar(.8, 90 * degree), {}, 0, 0, 0, 0};
  const Table turned = reduced(file, options);
  EXPECT_LT(plain.number("cov_qq", 0), .6 * plain.number("cov_uu", 0));
  EXPECT_NEAR(turned.number("cov_uu", 0) * .64 / plain.number("cov_qq", 0), 1, 1e-9);
  EXPECT_NEAR(turned.number("cov_qq", 0) * .64 / plain.number("cov_uu", 0), 1, 1e-9);
  EXPECT_NEAR(turned.number("cov_qu", 0), -plain.number("cov_qu", 0) / .64, 1e-12);
}

/// Two beams behind a plate that steps, or one: 60 exposures of a body that turns in 20 s.
CountsFile series(bool has_two_beams) {
  const Source source;
  CountsFile out;
  for (int k = 0; k < 60; ++k)
    for (const double beam : {0., 90.}) {
      if (beam > 0 && !has_two_beams)
        continue;
      CountRow row = behind(source, 45 * k + beam, 0, k);
      row.counts *= 1 + .3 * std::cos(2 * pi * k / 20);
      row.channel = beam > 0 ? "x" : "o";
      out.rows.push_back(row);
    }
  return out;
}

/// How `series` is fitted.
ReduceOptions of_the_series() {
  ReduceOptions out;
  out.period_s = 20;
  out.harmonics = 1;
  return out;
}

TEST(Reduce, ASeriesKnowsWhatIsNotKnownOfTheInstrument) {
  ReduceOptions options = of_the_series();
  const Table known = reduced(series(false), options);
  EXPECT_NEAR(known.number("q", 0), .3, 1e-9);
  options.priors.instrumental = .002;
  const Table unknown = reduced(series(false), options);
  for (const char *name : {"cov_qq", "cov_uu"}) // an offset adds its variance, whatever the weights
    EXPECT_NEAR((unknown.number(name, 0) - known.number(name, 0)) / 4e-6, 1, 1e-6) << name;
  options.priors = {};
  options.priors.gain = .01; // of the one channel: it is a factor of all light
  EXPECT_NEAR(reduced(series(false), options).number("cov_qq", 0) / known.number("cov_qq", 0), 1,
              1e-3);
}

TEST(Reduce, BeamsOfOneExposureFlickerTogetherInASeries) {
  CountsFile file = series(true);
  ReduceOptions options = of_the_series();
  const double still = reduced(file, options).number("cov_qq", 0);
  for (CountRow &row : file.rows)
    row.scintillation = .05;
  // What both share says nothing of q: only the little that their sum told is lost.
  const double one_pupil = reduced(file, options).number("cov_qq", 0);
  EXPECT_LT(one_pupil / still, 1.2);
  ReduceOptions cloudy = options; // one cloud before both, the same or from one to the next
  cloudy.transparency_sd = .05;
  CountsFile clear = file;
  for (CountRow &row : clear.rows)
    row.scintillation = 0;
  clear.notes["pupils"] = "separate";
  // I is known as the cloud's mean is: of 60 exposures, correlated by e^-1 from one to the next
  // (Fuller 1996, 2.1), or one; the series' other terms add a little.
  const double next = std::exp(-1.);
  for (const auto &[time_s, of_cloud] : {std::pair{0., 1 / std::sqrt(60.)},
                                         {1., std::sqrt((1 + next) / (1 - next) / 60)},
                                         {1e4, 1.}}) {
    cloudy.transparency_time_s = time_s;
    const Table table = reduced(clear, cloudy);
    EXPECT_LT(table.number("cov_qq", 0) / still, 1.2) << time_s;
    EXPECT_NEAR(table.number("I_err", 0) / table.number("I", 0) / (.05 * of_cloud), 1, .1)
        << time_s;
  }
  file.notes["pupils"] = "separate";
  // 5 % on each of 60 counts along q: sd .05/sqrt(120) of q at least.
  EXPECT_GT(reduced(file, options).number("cov_qq", 0), .8 * .05 * .05 / 120);
}

ReduceOptions set_under(double cloud_time_s) {
  ReduceOptions out;
  out.transparency_sd = .05;
  out.transparency_time_s = cloud_time_s;
  return out;
}

/// One beam through a cloud that stays: a factor of all light, which q does not know and I is not
/// known better than; through clouds of their own exposures are so many uncertain counts.
TEST(Reduce, ASeriesKnowsHowLongACloudStays) {
  ReduceOptions options = of_the_series();
  const Table clear = reduced(series(false), options);
  options.transparency_sd = .05;
  const Table each = reduced(series(false), options);
  options.transparency_time_s = 1e5; // 60 s are a minute of a day
  const Table one = reduced(series(false), options);
  const auto relative = [](const Table &t) { return t.number("I_err", 0) / t.number("I", 0); };
  EXPECT_NEAR(relative(one), .05, .001);
  for (const double time_s : {1e12, 1e17, 1e300}) { // a level, however long it stays
    options.transparency_time_s = time_s;
    EXPECT_NEAR(relative(reduced(series(false), options)), .05, .001) << time_s;
    EXPECT_NEAR(relative(reduced(two_beams_through({1, 1, 1, 1}), set_under(time_s))), .05, .001);
  }
  EXPECT_NEAR(relative(each) / (.05 / std::sqrt(60.)), 1, .1); // the series has 3 terms
  EXPECT_GT(std::sqrt(each.number("cov_qq", 0)), .8 * .05 * std::sqrt(2 / 60.));
  // It wanders by .05 sqrt(2/1e5) a second, which is .0002.
  EXPECT_LT(std::sqrt(one.number("cov_qq", 0)),
            std::sqrt(clear.number("cov_qq", 0) + 2. / 60 * .0002 * .0002 * 60));
}

TEST(Reduce, DriftIsToldThoughOtherBandsComeBetween) {
  CountsFile file;
  for (int k = 0; k < 32;
       ++k) { // four analysers in V, four in R, and so on, 1 % brighter each time
    CountRow row = behind({0, 0, {}}, 45 * (k % 4), 0, k);
    row.counts *= 1 + .01 * k;
    row.band = k / 4 % 2 == 0 ? "V" : "R";
    row.set = k / 8;
    file.rows.push_back(row);
  }
  Diagnostics diagnostics;
  ASSERT_TRUE(reduce(file, {}, {}, diagnostics));
  ASSERT_FALSE(diagnostics.empty());
  // .08 in eight exposures, of 1.0 to 1.3 times the first light.
  const std::string text = diagnostics.warnings()[0].text();
  EXPECT_NE(text.find("brightness changes by 0.0"), std::string::npos) << text;
}

TEST(Reduce, FlagsTellWhatNoiseDoesNot) {
  const Source source;
  CountsFile file = wheel(source, 0, 0);
  EXPECT_EQ(reduced(file).text("flags", 0), "");
  file.rows[0].counts *= 1.1; // 50,000 electrons where 700 are noise
  EXPECT_EQ(reduced(file).text("flags", 0), "misfit");
  EXPECT_EQ(reduced(wheel({1.05, 0, {}}, 0, 0)).text("flags", 0), "above_one");
  Diagnostics diagnostics;
  ASSERT_TRUE(reduce(file, {}, {}, diagnostics));
  ASSERT_EQ(diagnostics.warnings().size(), 1u);
  EXPECT_NE(diagnostics.warnings()[0].text().find("misfit"), std::string::npos);
}

/// Four analysers one after the other, twice a second for a minute, of light that goes up and down
/// by six tenths in 20 s; what exceeds `full` is saturated.
CountsFile breathing(double full) {
  CountsFile out;
  for (int k = 0; k < 120; ++k) {
    const double light = 1 + .6 * std::sin(2 * pi * .5 * k / 20);
    CountRow row = behind({}, 45 * (k % 4), 0, .5 * k);
    row.exposure = k;
    row.counts *= light;
    row.is_saturated = light > full;
    out.rows.push_back(row);
  }
  return out;
}

TEST(Reduce, ASeriesIsTheMeanOverTimeThoughItsBrightestCountsAreLeftOut) {
  ReduceOptions options;
  options.knot_s = 3;
  for (const double full : {2., 1.55}) {
    const Table table = reduced(breathing(full), options);
    // Three whole periods: the mean is 1. Without what is above 1.55, 13 % of the time, the mean of
    // the counts is .91; a cubic over those 2.7 s is the sine to some thousandths.
    EXPECT_NEAR(table.number("I", 0) / electrons, 1, .01) << full;
    EXPECT_NEAR(table.number("q", 0), .3, .01);
    EXPECT_EQ(table.text("flags", 0), full < 1.6 ? "saturated" : "");
  }
}

TEST(Reduce, WhatCannotBeFittedIsNamedAndTakesNothingWithIt) {
  CountsFile file = breathing(2);
  for (CountRow &row : file.rows)
    row.name = "good";
  for (const auto &[name, count] : {std::pair{"full", 40}, {"short", 3}})
    for (int k = 0; k < count; ++k) {
      file.rows.push_back(file.rows[static_cast<std::size_t>(k)]);
      file.rows.back().name = name;
      file.rows.back().is_saturated = file.rows.back().name == "full";
    }
  ReduceOptions options;
  options.knot_s = 3;
  Diagnostics diagnostics;
  const auto table = reduce(file, options, {}, diagnostics);
  ASSERT_TRUE(table) << table.error().text();
  EXPECT_EQ(table->rows(), 1u);
  std::string text;
  for (const auto &one : diagnostics.warnings())
    text += one.text() + "\n";
  EXPECT_NE(text.find("full V: all of its 40 counts are saturated"), std::string::npos) << text;
  EXPECT_NE(text.find("short V: 3 counts for"), std::string::npos) << text;
}

TEST(Reduce, ASeriesOfNoLightHasNoPolarization) {
  CountsFile file = breathing(2);
  for (CountRow &row : file.rows) {
    row.sky = row.counts - 50; // of 780 that are noise
    row.var_read = 1e5;
  }
  ReduceOptions options;
  options.knot_s = 3;
  const Table table = reduced(file, options);
  EXPECT_NE(table.text("flags", 0).find("faint"), std::string::npos);
  EXPECT_TRUE(std::isnan(table.number("q", 0)));
}

TEST(Reduce, WhatFlickersIsSeen) {
  // Beams of an exposure share their air: however it flickers, q and u stay as they are, of counts
  // that are a thousand times their noise. I is known as well as its air.
  const Table still = reduced(two_beams_through({1, 1, 1, 1}));
  CountsFile file = two_beams_through({1, .4, 2.5, .7});
  for (CountRow &row : file.rows)
    row.scintillation = 1.8;
  const Table table = reduced(file);
  EXPECT_EQ(table.text("flags", 0), "");
  EXPECT_GT(table.number("I_err", 0) / table.number("I", 0), 1. / 3);
  for (const char *name : {"q", "u"}) // far below their errors: the first order of air is exact
    EXPECT_NEAR(table.number(name, 0), still.number(name, 0), 1e-9) << name;
}

TEST(Reduce, SetsThatAreSaturatedAreCounted) {
  CountsFile file = wheel({}, 0, 0);
  for (CountRow row : wheel({}, 0, 0).rows) {
    row.time = plus_seconds(row.time, 40);
    row.set = 1;
    row.is_saturated = true;
    file.rows.push_back(row);
  }
  Diagnostics diagnostics;
  const auto table = reduce(file, {}, {}, diagnostics);
  ASSERT_TRUE(table);
  EXPECT_EQ(table->rows(), 1u);
  ASSERT_FALSE(diagnostics.empty());
  EXPECT_NE(diagnostics.warnings()[0].text().find("1 set of 2 left out"), std::string::npos);
}

} // namespace
} // namespace umov::jobs
