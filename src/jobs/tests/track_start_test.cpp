// Starts of a tracking are files that anyone may have changed: what cannot be followed is refused,
// and says where it lies.

#include "jobs/track_start.h"

#include <cmath>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace umov::jobs {
namespace {

using nlohmann::json;

TrackFrame frame() {
  TrackFrame out;
  out.bands = {"nm:550"};
  return out;
}

/// Two modes of a body that turns, with one gain: 6 + 1 unknowns each.
json state() {
  json modes = json::array();
  for (const double log_weight : {-0.25, std::log1p(-std::exp(-0.25))}) { // add up to 1
    std::vector<double> covariance(49, 0.0);
    for (std::size_t k = 0; k < 7; ++k)
      covariance[8 * k] = 1e-4;
    modes.push_back({{"number", modes.size() + 1},
                     {"log_weight", log_weight},
                     {"q", {1, 0, 0, 0}},
                     {"rate_rad_s", {0, 0, 0.01}},
                     {"nuisances", {1e12}},
                     {"covariance", covariance},
                     {"scale", 1e12},
                     {"chi2", 3.5},
                     {"measurements", 4}});
  }
  return {{"program", "umov"},
          {"question", "track"},
          {"time_utc", "2018-01-21T05:08:00Z"},
          {"bands", {"nm:550"}},
          {"parts", json::array()},
          {"clouds", false},
          {"median_intensity", 2.5},
          {"floor", 0.02},
          {"search_verdict", "determined"},
          {"misses", 0},
          {"missed_utc", ""},
          {"next_number", 3},
          {"is_wide", false},
          {"was_spread", false},
          {"light_unit", "relative"},
          {"modes", modes}};
}

Result<TrackStart> read(const std::string &text) {
  Diagnostics diagnostics;
  return read_track_start({"state.json", text}, frame(), 0.1, diagnostics);
}

TEST(TrackStart, AStateComesBackAsItWasWritten) {
  const auto first = read(state().dump());
  ASSERT_TRUE(first) << first.error().text();
  ASSERT_EQ(first->modes.size(), 2u);
  EXPECT_EQ(first->modes[1].number, 2u);
  EXPECT_EQ(first->modes[1].measurements, 4u);
  const std::string text = state_json(*first, frame(), TrackLoss::None, Verdict::Determined);
  const auto second = read(text);
  ASSERT_TRUE(second) << second.error().text();
  EXPECT_EQ(state_json(*second, frame(), TrackLoss::None, Verdict::Determined), text);
}

TEST(TrackStart, WhatCannotBeFollowedIsRefused) {
  const struct {
    const char *place; ///< of the JSON
    json value;
    const char *message;
  } cases[] = {
      {"/misses", -1, "misses = -1, where a whole number"},
      {"/next_number", 1e30, "next_number = 1e+30, where a whole number"},
      {"/next_number", std::uint64_t{18446744073709551615u}, "where a whole number"},
      {"/modes/0/number", 1.5, "number = 1.5, where a whole number"},
      {"/modes/1/measurements", "many", "measurements = \"many\", where a whole number"},
      {"/modes/1/covariance/8", -1e-4, "mode 2 has a variance of -0.0001"},
      {"/modes/0/covariance/0", 0, "mode 1 has a variance of 0"},
      {"/modes/0/covariance/1", 1e-5, "alike both ways"}, // [7] is its mirror image
      {"/modes/0/rate_rad_s/0", 1e200, "a rate of"},
      {"/modes/0/q/0", 2, "no quaternion of length 1"},
      {"/modes/0/scale", 0, "scale = 0"},
      {"/modes/0/chi2", -1, "chi2 = -1"},
      {"/modes/0/nuisances", json::array({1, 2}), "2 nuisances and a covariance of 49 numbers"},
      {"/modes/0/log_weight", 700, "the weights of its modes add up to"},
      {"/modes", json::array(), "no mode"},
      {"/floor", -0.1, "a floor below 0"},
      {"/modes/0/q", json::array({1, 0}), "state.json of umov invert track was expected"},
      {"/is_wide", 3, "state.json of umov invert track was expected"},
      {"/time_utc", "yesterday", "time_utc"},
  };
  for (const auto &one : cases) {
    json changed = state();
    changed[json::json_pointer(one.place)] = one.value;
    const auto found = read(changed.dump());
    ASSERT_FALSE(found) << one.place;
    EXPECT_EQ(found.error().code, ErrorCode::BadInput) << one.place;
    EXPECT_NE(found.error().message.find(one.message), std::string::npos)
        << one.place << ": " << found.error().message;
  }
}

TEST(TrackStart, StandardDeviationsBoundCovariances) {
  json changed = state();
  for (const std::size_t k : {1u, 7u})
    changed["modes"][0]["covariance"][k] = 2e-4; // twice what 1e-2 and 1e-2 leave
  const auto found = read(changed.dump());
  ASSERT_FALSE(found);
  EXPECT_NE(found.error().message.find("a covariance of 0.0002 and 0.0002"), std::string::npos)
      << found.error().message;
}

/// modes.ecsv of a turning body.
std::string modes(const std::string &scale, const std::string &rate) {
  std::string names = "mode,weight,qw,qx,qy,qz,scale,rate_x,rate_y,rate_z",
              row = "1,1,1,0,0,0," + scale + "," + rate + ",0,0";
  const char *const axes[] = {"x", "y", "z", "wx", "wy", "wz"};
  for (std::size_t r = 0; r < 6; ++r)
    for (std::size_t c = r; c < 6; ++c) {
      names += std::string(",cov_") + axes[r] + axes[c];
      row += r == c ? ",1e-4" : ",0";
    }
  return "# epoch_utc: 2018-01-21T05:08:00Z\n# data_until_utc: 2018-01-21T05:09:00Z\n"
         "# median_intensity: 2.5\n# floor: 0.02\n# search_verdict: determined\n" +
         names + "\n" + row + "\n";
}

TEST(TrackStart, ModesOfATableToo) {
  ASSERT_TRUE(read(modes("2e12", "0.5")));
  const auto dark = read(modes("0", "0.5"));
  ASSERT_FALSE(dark);
  EXPECT_NE(dark.error().message.find("row 1 has scale = 0"), std::string::npos)
      << dark.error().message;
  const auto fast = read(modes("2e12", "1e9"));
  ASSERT_FALSE(fast);
  EXPECT_NE(fast.error().message.find("row 1 has a rate of"), std::string::npos)
      << fast.error().message;
}

} // namespace
} // namespace umov::jobs
