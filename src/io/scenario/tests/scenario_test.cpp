#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <umov/atmosphere/air.h>
#include <umov/io/scenario.h>

namespace umov {
namespace {

const std::string good = R"(umov = 1
title = "a \"quoted\" title"
seed = 7
[observer]
name = "Maui"
lat_deg = 20.7083
lon_deg = -156.2578
alt_m = 3058
[time]
start = 2018-01-21T05:00:00Z
stop = "2018-01-21T05:10:00+00:00"
step_s = 0.5
only = { alt_min_deg = 10, sun_alt_max_deg = -6 }
[[object]]
name = "HST"
orbit = { file = "hst.tle", norad = 20580 }
mesh = { file = "hst.obj", unit = "m", up = "+Z", normals = "smooth" }
attitude = { point = "+Z", at = { ra_deg = 83.8, dec_deg = -5.4 }, then = "+X", toward = "sun" }
[object.materials]
array = { front = "gold", back = "paper_al" }
default = "paper_asi"
[bands]
set = ["nm:425", "nm:500"]
[material.gold]
index = { wavelength_nm = [400, 700], n = [1.6, 0.2], k = [1.9, 3.1] }
distribution = { model = "blinn_phong", m = 50 }
shadowing = "smith"
body = { reflectance = { wavelength_nm = [400, 700], reflectance = [0.1, 0.2] } }
)";

std::string with(const std::string &from, const std::string &to) {
  std::string text = good;
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

TEST(Scenario, ALockOfAnAxisIsItsOwnLock) {
  for (const char *axis : {"[0, 1, 1]", "[1, 2, 3]", "[0.1, -0.7, 0.3]"}) {
    const auto first =
        read_scenario_text(with("point = \"+Z\"", std::string("point = ") + axis), "s.toml", {});
    ASSERT_TRUE(first) << first.error().text();
    const std::string lock = locked_scenario(*first);
    const auto second = read_scenario_text(lock, "s.toml", {});
    ASSERT_TRUE(second) << second.error().text();
    EXPECT_EQ(locked_scenario(*second), lock);
  }
}

TEST(Scenario, ReadsEveryPart) {
  const auto s = read_scenario_text(good, "dir/s.toml", {});
  ASSERT_TRUE(s) << s.error().text();
  EXPECT_EQ(s->title, "a \"quoted\" title");
  EXPECT_EQ(s->seed, 7u);
  EXPECT_EQ(s->time->step_s, 0.5);
  EXPECT_EQ(to_iso(s->time->stop), "2018-01-21T05:10:00.000Z");
  EXPECT_TRUE(s->time->only.sunlit);
  EXPECT_EQ(s->objects[0].orbit->file, "dir/hst.tle");
  EXPECT_EQ(s->objects[0].mesh.normals, NormalMode::Smooth);
  EXPECT_EQ(s->objects[0].materials.at("array").back, "paper_al");
  EXPECT_EQ(s->own_materials.at("gold").distribution.parameters.at("m"), 50);
  EXPECT_EQ(s->own_materials.at("gold").shadowing, Shadowing::Smith);
  EXPECT_EQ(s->bands.size(), 2u);
  EXPECT_TRUE(check_complete_for_run(*s));
}

TEST(Scenario, OverridesReplaceKeys) {
  const auto s =
      read_scenario_text(good, "s.toml", {"time.step_s=2", "output.dir=here", "object.name=\"X\""});
  ASSERT_TRUE(s) << s.error().text();
  EXPECT_EQ(s->time->step_s, 2);
  EXPECT_EQ(s->output_dir, "here");
  EXPECT_EQ(s->objects[0].name, "X");
  EXPECT_FALSE(read_scenario_text(good, "s.toml", {"time.step=2"}));
  EXPECT_FALSE(read_scenario_text(good, "s.toml", {"seed"}));
}

TEST(Scenario, TheLockReadsBackToItself) {
  const auto s = read_scenario_text(good, "/base/s.toml", {});
  ASSERT_TRUE(s);
  const std::string lock = locked_scenario(*s);
  const auto again = read_scenario_text(lock, "/elsewhere/lock.toml", {});
  ASSERT_TRUE(again) << again.error().text();
  EXPECT_EQ(locked_scenario(*again), lock);
  EXPECT_EQ(again->objects[0].orbit->file, "/base/hst.tle");
}

TEST(Scenario, EveryAttitudeLocksAndReadsBack) {
  const std::string laws[] = {
      "{ mode = \"nadir\", yaw_deg = 5.0, roll_deg = -1 }",
      "{ point = \"+X\", at = { lat_deg = 20, lon_deg = -156, alt_m = 3000 }, then = \"+Z\", "
      "toward = "
      "\"sun\" }",
      "{ mode = \"tumble\", inertia = \"shell\", rate_deg_s = [1, 2, 3], epoch = "
      "2018-01-21T05:00:00Z }",
      "{ mode = \"tumble\", inertia = [1, 2, 2.5], rate_deg_s = [1.5, 0, 3], epoch = "
      "2018-01-21T05:00:00Z, start = { mode = \"inertial\", quaternion = [1, 0, 0, 0] } }",
      "{ mode = \"aem\", file = \"a.aem\" }",
      "{ mode = \"spin\", axis = \"+X\", period_s = 7, epoch = 2018-01-21T05:00:00Z, libration = { "
      "rms_deg = 0.5, period_s = 30 } }",
      "{ mode = \"pieces\", pieces = [ { from = 2018-01-21T05:00:00Z, mode = \"nadir\" }, { from = "
      "2018-01-21T06:00:00Z, mode = \"inertial\", quaternion = [1, 0, 0, 0] } ] }"};
  for (const std::string &law : laws) {
    SCOPED_TRACE(law);
    const auto s = read_scenario_text(
        "umov = 1\n[[object]]\nmesh = { file = \"a.obj\", unit = \"m\", up = \"+Z\" }\nattitude "
        "= " +
            law +
            "\n[[object.part]]\ngroups = [\"array\"]\naxis = \"+X\"\n[[object.part]]\n"
            "groups = [\"dish\"]\nangle_deg = [0, 10]\ntime = [2018-01-21T05:00:00Z, "
            "2018-01-21T06:00:00Z]\n[[object]]\norbit = { epoch = 2018-01-21T05:00:00Z, "
            "position_km = [7000, 0, 0], velocity_km_s = [0, 7.5, 0] }\nmesh = { file = "
            "\"b.obj\", unit = \"m\", up = \"+Z\" }\n",
        "/base/s.toml", {"object.1.name=second"});
    ASSERT_TRUE(s) << s.error().text();
    EXPECT_EQ(s->objects[1].name, "second");
    const std::string lock = locked_scenario(*s);
    const auto again = read_scenario_text(lock, "/elsewhere/lock.toml", {});
    ASSERT_TRUE(again) << again.error().text() << lock;
    EXPECT_EQ(locked_scenario(*again), lock);
  }
}

TEST(Scenario, ASceneNeedsNoOrbit) {
  const auto s = read_scenario_text(
      "umov = 1\n[[object]]\nmesh = { file = \"a.obj\", unit = \"m\", up = \"+Z\" }\n", "s.toml",
      {});
  ASSERT_TRUE(s) << s.error().text();
  const auto complete = check_complete_for_run(*s);
  ASSERT_FALSE(complete);
  EXPECT_NE(complete.error().message.find("[observer], [time], object.orbit"), std::string::npos);
}

/// Ways to say what air there is, or nothing; and what the lock says of it.
struct AirWords {
  const char *in_observer, *table;
  bool has_observation;
  const char *locked;
};

TEST(Scenario, TheLockSaysTheAirOnceAndReadsBackToItself) {
  const AirWords all[] = {
      {"", "", false, "\natmosphere = \"none\"\n"},
      {"atmosphere = \"none\"\n", "", false, "\natmosphere = \"none\"\n"},
      {"atmosphere = \"clear\"\n", "", false, "\natmosphere = { aerosol = { tau_550 = 0.02"},
      {"", "[atmosphere]\nozone_du = 300\n", false, "ozone_du = 300, water_cm"},
      {"", "", true, "\n[atmosphere]\naerosol"},
      {"atmosphere = \"none\"\n", "", true, "\natmosphere = \"none\"\n"},
      {"atmosphere = \"clear\"\n", "", true, "\n[atmosphere]\naerosol"},
      {"atmosphere = { ozone_du = 300 }\n", "", true, "\nozone_du = 300\n"},
      {"", "[atmosphere]\npressure_hpa = 500\n", true, "\npressure_hpa = 500\n"}};
  for (const AirWords &one : all) {
    const std::string text =
        "umov = 1\n" + std::string(one.has_observation ? "instrument = \"c11_imx250\"\n" : "") +
        "[observer]\nlat_deg = 20\nlon_deg = -156\nalt_m = 3000\n" + one.in_observer + one.table +
        (one.has_observation ? "[observation]\nexposure_s = 1\n" : "") +
        "[[object]]\nmesh = { file = \"a.obj\", unit = \"m\", up = \"+Z\" }\n";
    SCOPED_TRACE(text);
    const auto s = read_scenario_text(text, "/base/s.toml", {});
    ASSERT_TRUE(s) << s.error().text();
    const std::string lock = locked_scenario(*s);
    EXPECT_NE(lock.find(one.locked), std::string::npos) << lock;
    EXPECT_NE(lock.find("\natmosphere = ") == std::string::npos,
              lock.find("\n[atmosphere]") == std::string::npos)
        << lock;
    const auto again = read_scenario_text(lock, "/base/lock.toml", {});
    ASSERT_TRUE(again) << again.error().text() << lock;
    EXPECT_EQ(locked_scenario(*again), lock);
    EXPECT_EQ(again->air.has_value(), s->air.has_value());
    if (one.has_observation)
      EXPECT_EQ(again->observation->air.air.ozone_du, s->observation->air.air.ozone_du);
  }
}

TEST(Scenario, AirOfTheObserverIsThatOfTheObservation) {
  const auto read = [](const char *atmosphere) {
    return read_scenario_text("umov = 1\ninstrument = \"c11_imx250\"\n[observer]\nlat_deg = 20\n"
                              "lon_deg = -156\nalt_m = 3000\n" +
                                  std::string(atmosphere) +
                                  "[observation]\nexposure_s = 1\n[[object]]\nmesh = { file = "
                                  "\"a.obj\", unit = \"m\", up = \"+Z\" }\n",
                              "s.toml", {});
  };
  const auto hazy = read("atmosphere = { aerosol = { tau_550 = 0.3 } }\n");
  ASSERT_TRUE(hazy) << hazy.error().text();
  EXPECT_EQ(hazy->observation->air.air.aerosol_550, 0.3);
  EXPECT_TRUE(hazy->observation->scintillation_c_y);
  const auto airless = read("atmosphere = \"none\"\n");
  ASSERT_TRUE(airless) << airless.error().text();
  EXPECT_FALSE(airless->air);
  for (const double nm : {350., 550., 940.}) // Rayleigh, ozone, water
    EXPECT_EQ(transmission(nm, airless->observation->air.air, 2), 1) << nm;
  EXPECT_FALSE(airless->observation->scintillation_c_y);
  EXPECT_FALSE(airless->observation->sky.has_twilight || airless->observation->sky.has_moon);
}

struct Wrong {
  const char *name, *from, *to;
  std::size_t line;
  const char *word;
};
class ScenarioRefused : public testing::TestWithParam<Wrong> {};

TEST_P(ScenarioRefused, SaysWhereAndWhat) {
  const Wrong &w = GetParam();
  const auto s = read_scenario_text(with(w.from, w.to), "s.toml", {});
  ASSERT_FALSE(s);
  EXPECT_EQ(s.error().code, ErrorCode::BadInput);
  EXPECT_EQ(s.error().where.line, w.line) << s.error().text();
  EXPECT_NE(s.error().message.find(w.word), std::string::npos) << s.error().text();
}

INSTANTIATE_TEST_SUITE_P(
    Keys, ScenarioRefused,
    testing::Values(
        Wrong{"typo", "shadowing =", "shadwing =", 27, "Did you mean \"shadowing\"?"},
        Wrong{"type", "alt_m = 3058", "alt_m = \"7 km\"", 8, "a number was expected"},
        Wrong{"nan", "alt_m = 3058", "alt_m = nan", 8, "finite"},
        Wrong{"zone", "05:00:00Z", "05:00:00", 10, "has no zone"},
        Wrong{"order", "2018-01-21T05:10", "2018-01-20T05:10", 11, "before start"},
        Wrong{"repeated", "seed = 7", "seed = 7\nseed = 8", 4, "seed"},
        Wrong{"latitude", "20.7083", "-90.5", 6, "-90 to 90"},
        Wrong{"material", "\"paper_al\"", "\"paper_la\"", 20, "Did you mean \"paper_al\"?"},
        Wrong{"target", "\"sun\"", "\"sum\"", 18, "Did you mean \"sun\"?"},
        Wrong{"axis", "\"+X\"", "\"X\"", 18, "body axis"},
        Wrong{"parallel", "then = \"+X\"", "then = \"-Z\"", 18, "parallel"},
        Wrong{"no_distribution", "distribution", "#", 24, "distribution"},
        Wrong{"lacks_alpha", "blinn_phong", "ggx", 26, "needs alpha"},
        Wrong{"unsorted", "[400, 700], n", "[700, 400], n", 24, "increasing"},
        Wrong{"air_twice", "alt_m = 3058", "alt_m = 3058\natmosphere = \"none\"\n[atmosphere]", 9,
              "atmosphere = \"none\" beside [atmosphere]: leave one out"},
        Wrong{"air_as_table_twice", "alt_m = 3058",
              "alt_m = 3058\natmosphere = { ozone_du = 300 }\n[atmosphere]", 9,
              "atmosphere beside [atmosphere]: leave one out"},
        Wrong{"negative_k", "[1.9, 3.1]", "[1.9, -3.1]", 24, "k ="},
        Wrong{"unknown_band", "nm:500", "Besell.V", 23, "Did you mean"}),
    [](const auto &test) { return std::string(test.param.name); });

TEST(Schema, IsJsonWithEveryTable) {
  const auto schema = nlohmann::json::parse(scenario_schema_json());
  EXPECT_EQ(schema["properties"]["render"]["properties"]["accuracy"]["default"], 0.005);
  EXPECT_EQ(schema["properties"]["render"]["properties"]["bounces"]["default"],
            LightOptions().bounces);
  EXPECT_TRUE(schema["properties"]["object"]["items"]["properties"].contains("attitude"));
  EXPECT_TRUE(
      schema["properties"]["material"]["additionalProperties"]["properties"].contains("body"));
}

// The parser of TOML goes one call deeper for each name of a dotted key and ends by a segmentation
// fault at some ten thousand.
TEST(Scenario, KeysOfEndlessDepthAreRefused) {
  std::string deep = "a";
  for (int k = 0; k < 100'000; ++k)
    deep += ".a";
  for (const std::string &text :
       {deep + " = 1", "[" + deep + "]", "[[" + deep + "]]", "x = { " + deep + " = 1 }",
        "y = \"\"\"\n. # \"\n\"\"\"\n" + deep + " = 1"}) {
    const auto read = read_scenario_text(text, "deep.toml", {});
    ASSERT_FALSE(read.has_value());
    EXPECT_NE(read.error().message.find("names with dots between"), std::string::npos);
    EXPECT_EQ(read.error().where.line, text[0] == 'y' ? 4u : 1u);
  }
  EXPECT_FALSE(read_scenario_text(good, "good.toml", {deep + "=1"}).has_value());
  EXPECT_FALSE(read_scenario_text(good, "good.toml", {"title={" + deep + "=1}"}).has_value());
  // Dots that are no names: in texts, comments and lists of numbers.
  const std::string dots(1000, '.');
  EXPECT_TRUE(
      read_scenario_text(with("a \\\"quoted\\\" title", dots) + "# " + dots + "\n", "good.toml", {})
          .has_value());
}

} // namespace
} // namespace umov
