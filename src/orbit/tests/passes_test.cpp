// Passes against the reference ephemerides and against themselves.

#include <umov/orbit/passes.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <gtest/gtest.h>
#include <map>
#include <sstream>
#include <umov/core/files.h>
#include <umov/io/tle.h>
#include <umov/orbit/sgp4.h>

namespace umov {
namespace {

const std::string passes_folder = UMOV_SOURCE_DIR "/tests/data/ephemeris/";
const Site maui = *make_site("maui", 20.7083, -156.2578, 3058);

ElementSet elements_of(const std::string &file, int norad) {
  Diagnostics diagnostics;
  const auto sets = read_tle(*read_file(file), file, {}, diagnostics);
  for (const ElementSet &set : *sets)
    if (set.norad_cat_id == norad)
      return set;
  ADD_FAILURE() << "no element set of " << norad;
  return {};
}
Epoch<Utc> utc(const std::string &text) { return *utc_from_iso(text); }

/// Columns of a reference file by name, one list of rows per pass (one where it has no such
/// column).
struct PassRow {
  Epoch<Utc> time;
  double elevation, sunlit, phase, sun_elevation;
};
std::vector<std::vector<PassRow>> read_rows(const std::string &file) {
  std::ifstream stream(passes_folder + file);
  std::string line;
  std::getline(stream, line);
  std::map<std::string, std::size_t> column;
  std::istringstream head(line);
  for (std::string name; std::getline(head, name, ',');)
    column.emplace(name, column.size());
  std::map<std::string, std::vector<PassRow>> out;
  while (std::getline(stream, line)) {
    std::vector<std::string> cell;
    std::istringstream cells(line);
    for (std::string text; std::getline(cells, text, ',');)
      cell.push_back(text);
    const auto number = [&](const char *name) { return std::stod(cell[column.at(name)]); };
    out[column.contains("pass") ? cell[0] : ""].push_back(
        {utc(cell[column.at("utc")]), number("el_deg"), number("sun_frac_ellipsoid"),
         number("phase_deg"), number("sun_el_deg")});
  }
  std::vector<std::vector<PassRow>> list;
  for (auto &[name, rows] : out)
    list.push_back(std::move(rows));
  return list;
}

/// Seconds from the first row at which the elevation crosses a value, by the cubic through four
/// rows: good to 1e-3 s for rows 5 s apart.
double crossing(const std::vector<PassRow> &rows, double wanted, bool is_up) {
  for (std::size_t k = 1; k + 2 < rows.size(); ++k) {
    const bool is_here = is_up ? rows[k].elevation <= wanted && rows[k + 1].elevation > wanted
                               : rows[k].elevation > wanted && rows[k + 1].elevation <= wanted;
    if (!is_here)
      continue;
    const double step = seconds_between(rows[k + 1].time, rows[k].time);
    const auto value = [&](double t) { // Lagrange, t in steps past row k
      const double y0 = rows[k - 1].elevation, y1 = rows[k].elevation, y2 = rows[k + 1].elevation,
                   y3 = rows[k + 2].elevation;
      return -y0 * t * (t - 1) * (t - 2) / 6 + y1 * (t + 1) * (t - 1) * (t - 2) / 2 -
             y2 * (t + 1) * t * (t - 2) / 2 + y3 * (t + 1) * t * (t - 1) / 6;
    };
    double a = 0, b = 1;
    for (int i = 0; i < 60; ++i) {
      const double middle = 0.5 * (a + b);
      ((value(middle) > wanted) == is_up ? b : a) = middle;
    }
    return seconds_between(rows[k].time, rows[0].time) + a * step;
  }
  ADD_FAILURE() << "no crossing";
  return 0;
}

TEST(Passes, EightPassesOfExplorer27RiseAndSetWhenTheReferenceSays) {
  const ElementSet set = elements_of(passes_folder + "elements.tle", 1328);
  const auto found = find_passes(Trajectory(set), maui, utc("2022-02-22T00:00:00Z"),
                                 utc("2022-03-02T00:00:00Z"), {});
  ASSERT_TRUE(found) << found.error().text();
  const auto references = read_rows("explorer27_maui_8passes_5s.csv");
  ASSERT_EQ(references.size(), 8u);
  for (const auto &rows : references) {
    const SitePass *pass = nullptr;
    for (const SitePass &one : found->passes)
      if (seconds_between(one.culmination.time, rows.front().time) > 0 &&
          seconds_between(rows.back().time, one.culmination.time) > 0)
        pass = &one;
    ASSERT_NE(pass, nullptr) << to_iso(rows.front().time);
    EXPECT_NEAR(seconds_between(pass->rise.time, rows[0].time), crossing(rows, 10, true), 0.1);
    EXPECT_NEAR(seconds_between(pass->set.time, rows[0].time), crossing(rows, 10, false), 0.1);
    double top = 0, low = 180, high = 0, seen = 0;
    for (const PassRow &row : rows) {
      top = std::max(top, row.elevation);
      if (row.elevation > 10 && row.sunlit > 0 && row.sun_elevation < -6)
        seen = std::max(seen, row.elevation);
      if (row.elevation > 10 && row.sunlit > 0) {
        low = std::min(low, row.phase);
        high = std::max(high, row.phase);
      }
    }
    EXPECT_NEAR(pass->culmination.altitude.degrees(), top, 0.02); // rows are 5 s apart
    // One of the eight is highest before it is dark; .1 deg/s then, between rows of 5 s.
    EXPECT_NEAR(pass->visible_altitude_max.degrees(), seen, seen < top ? 0.5 : 0.02);
    EXPECT_NEAR(pass->rise.altitude.degrees(), 10, 1e-4);
    EXPECT_NEAR(pass->set.altitude.degrees(), 10, 1e-4);
    if (high > 0) { // the file's samples at 5 s against ours
      EXPECT_NEAR(pass->phase_min.degrees(), low, 1);
      EXPECT_NEAR(pass->phase_max.degrees(), high, 1);
    }
  }
}

TEST(Passes, TheEndsOfASpanDoNotMoveTheCulmination) {
  const Trajectory orbit(elements_of(passes_folder + "elements.tle", 1328));
  const auto whole =
      find_passes(orbit, maui, utc("2022-02-22T00:00:00Z"), utc("2022-02-23T00:00:00Z"), {});
  ASSERT_TRUE(whole && !whole->passes.empty());
  const SitePass &pass = whole->passes[0];
  const auto before = find_passes(orbit, maui, utc("2022-02-22T00:00:00Z"),
                                  plus_seconds(pass.culmination.time, -120), {});
  const auto after = find_passes(orbit, maui, plus_seconds(pass.culmination.time, 120),
                                 plus_seconds(pass.set.time, 600), {});
  for (const auto *cut : {&before, &after}) {
    ASSERT_TRUE(*cut && !(*cut)->passes.empty());
    const SitePass &part = cut == &before ? (*cut)->passes.back() : (*cut)->passes.front();
    EXPECT_TRUE(part.is_rise_cut != part.is_set_cut);
    EXPECT_NEAR(seconds_between(part.culmination.time, pass.culmination.time), 0, 0.1);
    EXPECT_NEAR(part.culmination.altitude.degrees(), pass.culmination.altitude.degrees(), 1e-4);
    EXPECT_LT(part.visible_altitude_max.degrees(), pass.culmination.altitude.degrees() - 1);
    EXPECT_GT(part.range_min_km, pass.range_min_km + 10); // of the span alone
  }
}

TEST(Passes, TheShadowIsEnteredWhenHalfTheSunIsGone) {
  // Rows 1 s apart; the reference's fraction is good to 3e-3, of which the Sun loses a tenth per
  // second.
  const auto rows = read_rows("explorer27_maui_20220222_pass_1s.csv").front();
  double expected = -1;
  for (std::size_t k = 0; k + 1 < rows.size(); ++k)
    if ((rows[k].sunlit > 0.5) != (rows[k + 1].sunlit > 0.5))
      expected =
          static_cast<double>(k) + (rows[k].sunlit - 0.5) / (rows[k].sunlit - rows[k + 1].sunlit);
  ASSERT_GT(expected, 0);
  PassSearch search;
  search.altitude_min = Angle::degrees(2);
  const auto found = find_passes(Trajectory(elements_of(passes_folder + "elements.tle", 1328)),
                                 maui, rows.front().time, rows.back().time, search);
  ASSERT_TRUE(found);
  ASSERT_EQ(found->passes.size(), 1u);
  ASSERT_EQ(found->passes.front().shadow.size(), 1u);
  EXPECT_TRUE(found->passes.front().shadow[0].is_entry);
  EXPECT_NEAR(seconds_between(found->passes.front().shadow[0].time, rows.front().time), expected,
              0.1);
  EXPECT_GT(found->passes.front().sunlit_share, 0);
  EXPECT_LT(found->passes.front().sunlit_share, 1);
}

TEST(Passes, NoneIsMissedThatADenseSearchSees) {
  // Every pass of a night for objects of all kinds, against altitudes every 5 s.
  Diagnostics diagnostics;
  const std::string file = UMOV_SOURCE_DIR "/tests/data/tle/mixed_979_2018-01-20.tle";
  const auto sets = read_tle(*read_file(file), file, {}, diagnostics);
  const Epoch<Utc> start = utc("2018-01-21T04:00:00Z"), stop = utc("2018-01-21T10:00:00Z");
  std::size_t passes = 0;
  for (std::size_t i = 0; i < sets->size(); i += 23) {
    const ElementSet &set = (*sets)[i];
    const auto found = find_passes(Trajectory(set), maui, start, stop, {});
    if (!found || found->end)
      continue; // decayed before
    passes += found->passes.size();
    const Sgp4 model(set);
    for (double t = 0; t <= 6 * 3600; t += 5) {
      const Epoch<Utc> time = plus_seconds(start, t);
      TemeState state;
      ASSERT_EQ(model.propagate(clock_days_between(time, set.epoch) * 1440, state), Sgp4Code::Ok);
      const double altitude = topocentric_altitude(state, time, maui).degrees();
      const bool is_up =
          std::any_of(found->passes.begin(), found->passes.end(), [&](const SitePass &pass) {
            return seconds_between(time, pass.rise.time) >= 0 &&
                   seconds_between(pass.set.time, time) >= 0;
          });
      if (std::abs(altitude - 10) > 1e-3) {
        ASSERT_EQ(is_up, altitude > 10) << set.name << " " << to_iso(time);
      }
    }
  }
  EXPECT_GT(passes, 40u);
}

TEST(Passes, TheQuickAltitudeIsThatOfTheEphemeris) {
  const ElementSet set = elements_of(passes_folder + "elements.tle", 1328);
  const Sgp4 model(set);
  for (double minutes = -2000; minutes < 2000; minutes += 37) {
    const Epoch<Utc> time = plus_seconds(set.epoch, 60 * minutes);
    TemeState state;
    ASSERT_EQ(model.propagate(minutes, state), Sgp4Code::Ok);
    EXPECT_EQ(topocentric_altitude(state, time, maui).radians(),
              observe(state, time, maui, ShadowModel::Ellipsoid).altitude.radians());
  }
}

TEST(Passes, AStationaryObjectIsUpAllTheTime) {
  const ElementSet set =
      elements_of(UMOV_SOURCE_DIR "/tests/data/tle/mixed_979_2018-01-20.tle", 20580);
  ElementSet still = set;
  still.mean_motion = 1.00273791 * 2 * pi / 1440;
  still.inclination = 1e-3;
  still.eccentricity = 1e-4;
  for (double raan = 0; raan < 2 * pi; raan += 0.5) {
    still.raan = raan;
    const auto found = find_passes(Trajectory(still), maui, utc("2018-01-21T00:00:00Z"),
                                   utc("2018-01-22T00:00:00Z"), {});
    ASSERT_TRUE(found);
    ASSERT_LE(found->passes.size(), 1u);
    if (found->passes.size() == 1) {
      EXPECT_TRUE(found->passes.front().is_rise_cut && found->passes.front().is_set_cut);
      EXPECT_NEAR(seconds_between(found->passes.front().set.time, found->passes.front().rise.time),
                  86400, 1e-6);
    }
  }
}

TEST(Passes, AnEmptySpanAndADecayedObject) {
  const ElementSet set = elements_of(passes_folder + "elements.tle", 1328);
  const auto none = find_passes(Trajectory(set), maui, utc("2022-02-22T00:00:00Z"),
                                utc("2022-02-22T00:00:00Z"), {});
  ASSERT_TRUE(none);
  EXPECT_TRUE(none->passes.empty());
  ElementSet low = set;
  low.mean_motion = 17.5 * 2 * pi / 1440;
  const auto decayed = find_passes(Trajectory(low), maui, utc("2022-02-22T00:00:00Z"),
                                   utc("2022-03-22T00:00:00Z"), {});
  ASSERT_TRUE(decayed);
  ASSERT_TRUE(decayed->end);
  EXPECT_EQ(decayed->end->error.code, ErrorCode::Physics);
}

TEST(Passes, ACancelledSearchSaysSo) {
  const ElementSet set = elements_of(passes_folder + "elements.tle", 1328);
  std::atomic<bool> cancel{true};
  PassSearch search;
  search.cancel = &cancel;
  const auto from = utc("2022-02-22T00:00:00Z"), to = utc("2022-02-25T00:00:00Z");
  auto found = find_passes(Trajectory(set), maui, from, to, search);
  ASSERT_FALSE(found);
  EXPECT_EQ(found.error().code, ErrorCode::Interrupted);
  // In the middle too: what is described costs the most.
  cancel = false;
  int described = 0;
  search.on_pass = [&](const SitePass &, std::span<const ObservingGeometry>) -> Result<void> {
    cancel = ++described == 2;
    return {};
  };
  found = find_passes(Trajectory(set), maui, from, to, search);
  EXPECT_FALSE(found);
  EXPECT_EQ(described, 2);
}

// passes_skyfield.csv: Skyfield at 0.1 s steps, see tests/data/ephemeris/README.md.
TEST(Passes, ADenseReference) {
  std::map<std::string, std::vector<SitePass>> found;
  const std::tuple<int, const char *, const char *> spans[] = {
      {1328, "2022-02-22T00:00:00Z", "2022-03-02T00:00:00Z"},
      {20580, "2018-01-21T00:00:00Z", "2018-01-25T00:00:00Z"}};
  for (const auto &[norad, start, stop] : spans)
    found[std::to_string(norad)] =
        find_passes(Trajectory(elements_of(passes_folder + "elements.tle", norad)), maui,
                    utc(start), utc(stop), {})
            .value()
            .passes;
  std::ifstream stream(passes_folder + "passes_skyfield.csv");
  std::string line;
  std::getline(stream, line);
  int rows = 0, shadows = 0;
  while (std::getline(stream, line)) {
    std::istringstream cells(line);
    std::string norad;
    std::getline(cells, norad, ',');
    std::vector<std::string> cell(9);
    for (std::string &text : cell)
      std::getline(cells, text, ',');
    const auto *passes = &found.at(norad);
    SCOPED_TRACE(cell[0]);
    const Epoch<Utc> rise = utc(cell[0]);
    const auto pass = std::find_if(passes->begin(), passes->end(), [&](const SitePass &one) {
      return std::abs(seconds_between(one.rise.time, rise)) < 60;
    });
    ASSERT_NE(pass, passes->end());
    EXPECT_NEAR(seconds_between(pass->rise.time, rise), 0, 0.1);
    EXPECT_NEAR(seconds_between(pass->set.time, utc(cell[2])), 0, 0.1);
    EXPECT_NEAR(seconds_between(pass->culmination.time, utc(cell[1])), 0, 0.1);
    // The file has the highest of rows 0.1 s apart.
    EXPECT_NEAR(pass->culmination.altitude.degrees(), std::stod(cell[3]), 1e-4);
    // One second of arc, and what the phase moves by in the millisecond that times are printed to.
    constexpr double arcsec = 1 / 3600.0;
    EXPECT_NEAR(pass->rise.phase_angle.degrees(), std::stod(cell[4]), arcsec);
    EXPECT_NEAR(pass->set.phase_angle.degrees(), std::stod(cell[6]), arcsec);
    if (!cell[7].empty()) {
      ASSERT_EQ(pass->shadow.size(), 1u);
      EXPECT_NEAR(seconds_between(pass->shadow[0].time, utc(cell[7])), 0, 0.1);
      EXPECT_EQ(pass->shadow[0].is_entry, cell[8] == "1");
      ++shadows;
    }
    ++rows;
  }
  EXPECT_GE(rows, 75);
  EXPECT_GE(shadows, 4);
}

} // namespace
} // namespace umov
