// Which epochs are kept and how they group, on a track whose altitudes are known in closed form.

#include "observation/tests/straight_line.h"

#include <gtest/gtest.h>

namespace umov {
namespace {

using cases::StraightLine;

/// At half a second, so that no rounding changes the second in the name of a pass.
const StraightLine by_day("2018-03-20T12:00:00.5Z"), by_night("2018-03-20T00:00:00.5Z");
const std::atomic<bool> no_cancel = false;

/// In the Earth's shadow and by day too.
EpochFilter above_30_deg() {
  EpochFilter only;
  only.altitude_min = Angle::degrees(30);
  only.sunlit = false;
  return only;
}

Track track_of(const StraightLine &line) { return Track::make(line.request()).value(); }

TEST(TimeGrid, BothEndsBelongToIt) {
  EXPECT_EQ(time_grid(by_day.span(60, 20))->size(), 4u);
  EXPECT_EQ(time_grid(by_day.span(59, 20))->size(), 3u);
  EXPECT_EQ(time_grid(by_day.span(0, 20))->size(), 1u);
  EXPECT_EQ(time_grid(by_day.span(0.3, 0.1))->size(), 4u); // 0.3/0.1 is below 3 in binary
}

TEST(TimeGrid, RefusesWhatIsNoSpan) {
  const struct {
    double seconds, step;
    const char *words;
  } rows[] = {{60, 0, "positive"},
              {60, -1, "positive"},
              {60, NAN, "positive"},
              {-1, 1, "before start"},
              {1e7, 1e-1, "limit"}};
  for (const auto &row : rows) {
    const auto grid = time_grid(by_day.span(row.seconds, row.step));
    ASSERT_FALSE(grid) << row.words;
    EXPECT_EQ(grid.error().code, ErrorCode::BadInput);
    EXPECT_NE(grid.error().message.find(row.words), std::string::npos) << grid.error().message;
  }
}

// Epochs of one's own are kept as they are, each once and in order.
TEST(TimeGrid, OwnEpochsAreTheGrid) {
  EpochSpan span = by_day.span(60, 20);
  for (const double s : {0.25, 0.5, 41.0})
    span.own.push_back(plus_seconds(span.start, s));
  const auto grid = time_grid(span);
  ASSERT_TRUE(grid);
  ASSERT_EQ(grid->size(), 3u);
  EXPECT_EQ(seconds_between((*grid)[2], span.own[2]), 0);
  for (const std::size_t twice : {1u, 0u}) { // the same again, and one that lies before
    EpochSpan wrong = span;
    wrong.own[2] = wrong.own[twice];
    const auto refused = time_grid(wrong);
    ASSERT_FALSE(refused);
    EXPECT_NE(refused.error().message.find("epoch 3 is"), std::string::npos);
  }
}

TEST(KeptEpochs, AreThoseAboveTheAltitudeInTwoPasses) {
  const EpochFilter only = above_30_deg();
  const auto kept = keep_epochs(track_of(by_day), by_day.span(1200, 10), only, 1, no_cancel);
  ASSERT_TRUE(kept) << kept.error().text();
  ASSERT_EQ(kept->passes.size(), 2u);
  EXPECT_EQ(kept->passes_seen, 2u);
  EXPECT_FALSE(kept->stopped);
  std::size_t expected = 0;
  for (double s = 0; s <= 1200; s += 10)
    if (StraightLine::altitude_rad(s) >= only.altitude_min.radians())
      ++expected;
  ASSERT_EQ(kept->geometry.size(), expected);
  EXPECT_EQ(kept->passes[0].rows + kept->passes[1].rows, expected);
  for (std::size_t k = 0; k < expected; ++k) {
    const double s = seconds_between(kept->geometry[k].time, by_day.start);
    // Double precision over the turns from frame to frame and back.
    EXPECT_NEAR(kept->geometry[k].altitude.radians(), StraightLine::altitude_rad(s), 1e-9);
    EXPECT_EQ(kept->pass[k], s < 600 ? 0u : 1u);
  }
}

TEST(KeptEpochs, APassIsNamedByItsCulminationWhateverTheStep) {
  const EpochFilter only = above_30_deg();
  for (const double step : {7.0, 10.0, 60.0}) {
    const auto kept = keep_epochs(track_of(by_day), by_day.span(1190, step), only, 1, no_cancel);
    ASSERT_TRUE(kept);
    ASSERT_EQ(kept->passes.size(), 2u);
    EXPECT_EQ(kept->passes[0].id, "7-20180320T120500Z");
    EXPECT_EQ(kept->passes[1].id, "7-20180320T121500Z");
    EXPECT_NEAR(seconds_between(kept->passes[0].culmination, by_day.start), 300, 5e-3);
    EXPECT_NEAR(kept->passes[0].culmination_altitude.radians(), StraightLine::altitude_rad(300),
                1e-6);
  }
}

TEST(KeptEpochs, ASpanThatCutsAPassKeepsItsName) {
  const EpochFilter only = above_30_deg();
  const EpochSpan late{plus_seconds(by_day.start, 350), plus_seconds(by_day.start, 500), 10};
  const auto kept = keep_epochs(track_of(by_day), late, only, 1, no_cancel);
  ASSERT_TRUE(kept);
  ASSERT_EQ(kept->passes.size(), 1u);
  EXPECT_TRUE(kept->passes[0].is_open_at_start);
  EXPECT_FALSE(kept->passes[0].is_open_at_end);
  EXPECT_EQ(kept->passes[0].id, "7-20180320T120500Z");
}

TEST(KeptEpochs, EpochsOfOnesOwnLeaveAPassThatGoesOn) {
  // Passes culminate at 300 and 900 s: up before and after each of these.
  EpochSpan own = by_day.span(1190, 10);
  for (const double s : {290.0, 300.0, 900.0})
    own.own.push_back(plus_seconds(by_day.start, s));
  const auto kept = keep_epochs(track_of(by_day), own, above_30_deg(), 1, no_cancel);
  ASSERT_TRUE(kept);
  ASSERT_EQ(kept->passes.size(), 2u);
  for (const Pass &pass : kept->passes) {
    EXPECT_TRUE(pass.is_open_at_start);
    EXPECT_TRUE(pass.is_open_at_end);
  }
  own.own.push_back(plus_seconds(by_day.start, 900.0004));
  EXPECT_FALSE(keep_epochs(track_of(by_day), own, above_30_deg(), 1, no_cancel));
}

TEST(KeptEpochs, TheSkyMustBeDarkAndTheObjectLit) {
  // Equinox, longitude 0: the Sun stands overhead at noon, and the object, 1000 km up, is deep in
  // the Earth's shadow at midnight.
  EpochFilter dark_sky, lit;
  dark_sky.sun_altitude_max = Angle::degrees(-6);
  dark_sky.sunlit = false;
  const auto count = [](const StraightLine &line, const EpochFilter &only) {
    const auto kept = keep_epochs(track_of(line), line.span(1200, 10), only, 1, no_cancel);
    EXPECT_GT(kept->passes_seen, 0u);
    return kept->geometry.size();
  };
  EXPECT_EQ(count(by_day, dark_sky), 0u);
  EXPECT_EQ(count(by_day, lit), 121u); // above the horizon all the time
  EXPECT_EQ(count(by_night, dark_sky), 121u);
  EXPECT_EQ(count(by_night, lit), 0u);
}

TEST(KeptEpochs, WhereTheOrbitEndsTheEpochsBeforeStay) {
  const auto kept = keep_epochs(track_of(by_day), by_day.span(1300, 10), {}, 1, no_cancel);
  ASSERT_TRUE(kept);
  ASSERT_TRUE(kept->stopped);
  EXPECT_EQ(kept->stopped->code, ErrorCode::Physics);
  EXPECT_EQ(kept->geometry.size(), 121u);
}

TEST(KeptEpochs, TwoPassesBetweenWhichNoEpochFallsStayTwo) {
  // Neighbours on the grid, 250 s and 850 s, both above; the object set between them.
  const EpochSpan coarse{plus_seconds(by_day.start, 250), plus_seconds(by_day.start, 1100), 600};
  const auto kept = keep_epochs(track_of(by_day), coarse, above_30_deg(), 1, no_cancel);
  ASSERT_TRUE(kept);
  ASSERT_EQ(kept->passes.size(), 2u);
  EXPECT_EQ(kept->passes[0].id, "7-20180320T120500Z");
  EXPECT_EQ(kept->passes[1].id, "7-20180320T121500Z");
}

TEST(KeptEpochs, AnEpochInAGapIsARowThatIsNotThere) {
  OrbitEphemeris broken{"line", "2018-001A", 7, {}};
  for (const auto &[from, to] : {std::pair{0.0, 303.0}, std::pair{307.0, 600.0}}) {
    EphemerisSegment segment;
    segment.frame = OrbitFrame::Itrs;
    segment.interpolation = Interpolation::Linear;
    segment.degree = 1;
    segment.first = plus_seconds(by_day.start, from);
    segment.last = plus_seconds(by_day.start, to);
    for (const double s : {from, to})
      segment.states.push_back(
          {plus_seconds(by_day.start, s),
           {6378.137 + StraightLine::height_km, StraightLine::east_km(s), StraightLine::north_km},
           {0, StraightLine::speed_km_s, 0}});
    broken.segments.push_back(segment);
  }
  TrackRequest request = by_day.request();
  request.orbit = Trajectory(broken);
  const Track track = Track::make(request).value();
  // The search looks every 20 s and misses the gap; 305 s lies in it, 310 s does not.
  for (const double step : {5.0, 10.0}) {
    const auto kept = keep_epochs(track, by_day.span(600, step), {}, 1, no_cancel);
    ASSERT_TRUE(kept);
    EXPECT_FALSE(kept->stopped);
    EXPECT_EQ(kept->epochs_in_gaps, step < 10 ? 1u : 0u);
    EXPECT_EQ(kept->geometry.size(), step < 10 ? 120u : 61u);
  }
}

TEST(KeptEpochs, WhatLiesBehindAGapIsFound) {
  OrbitEphemeris broken{"line", "2018-001A", 7, {}};
  for (const auto &[from, to] : {std::pair{0.0, 320.0}, std::pair{410.0, 600.0}})
    broken.segments.push_back(by_day.segment(from, to));
  TrackRequest request = by_day.request();
  request.orbit = Trajectory(broken);
  const auto kept =
      keep_epochs(Track::make(request).value(), by_day.span(700, 10), {}, 1, no_cancel);
  ASSERT_TRUE(kept && kept->stopped);  // nothing follows 600 s
  EXPECT_EQ(kept->epochs_in_gaps, 8u); // 330 s to 400 s
  EXPECT_EQ(kept->geometry.size(), 33u + 20u);
  ASSERT_EQ(kept->passes.size(), 2u);
  EXPECT_NEAR(seconds_between(kept->passes[1].rise, by_day.start), 410, 1e-6);
}

TEST(KeptEpochs, StopWhenCancelled) {
  const std::atomic<bool> cancel = true;
  const auto kept = keep_epochs(track_of(by_day), by_day.span(1200, 10), {}, 1, cancel);
  ASSERT_FALSE(kept);
  EXPECT_EQ(kept.error().code, ErrorCode::Interrupted);
}

TEST(NextPass, IsTheFirstThatTheFilterKeeps) {
  const EpochFilter only = above_30_deg();
  const auto next =
      find_next_pass(track_of(by_day), only, plus_seconds(by_day.start, 500), 600. / 86400);
  ASSERT_TRUE(next);
  // tan 30 deg = 1000 km / hypot(east, 500 km), at 10 km/s; crossings are good to a millisecond.
  // The top lies between steps of 20 s.
  const double east = std::sqrt(3 * 1000. * 1000. - 500. * 500.);
  EXPECT_NEAR(seconds_between(next->first_row, by_day.start), 900 - east / 10, 2e-3);
  EXPECT_NEAR(next->altitude_max.radians(), StraightLine::altitude_rad(900), 0.01);
  EXPECT_FALSE(find_next_pass(track_of(by_night), {}, by_night.start, 0.01)); // never lit
}

} // namespace
} // namespace umov
