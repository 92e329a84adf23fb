#include "core/tests/anchors.h"
#include "io/report/assemble.h"
#include "io/report/base64.h"
#include "io/report/tests/synthetic_curve.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <regex>
#include <umov/core/files.h>

namespace umov {
namespace {

constexpr const char *stand_in = "window.Plotly = {};"; // the real script is 5 MB and not ours

ReportInput input_of(const LightCurve &curve) {
  ReportInput input{.curve = curve, .title = "HST from Maui", .site = {}, .passes = {}};
  input.site = {"Maui", Angle::degrees(20.7083), Angle::degrees(-156.2578), 3058};
  Pass pass;
  pass.id = curve.epochs.front().pass_id;
  pass.rise = pass.culmination = pass.set = curve.epochs.front().geometry.time;
  pass.culmination_altitude = Angle::degrees(72);
  pass.rows = 240;
  input.passes = {pass};
  input.manifest = {{"umov", "0.1.0"}, {"seed", "20580"}};
  input.pure_materials = {{"paper_al", 1, {0, 90, 180}, {0, 0.125, 0}}};
  return input;
}

std::string page_of(const ReportInput &input) {
  const auto page = assemble_report(input, stand_in);
  EXPECT_TRUE(page) << page.error().text();
  return page.value_or("");
}

nlohmann::json data_of(const std::string &page) {
  const std::string open = "<script id=\"umov-data\" type=\"application/json\">";
  const std::size_t start = page.find(open) + open.size();
  return nlohmann::json::parse(page.substr(start, page.find("</script>", start) - start));
}

std::size_t count_of(const std::string &text, const std::string &part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != text.npos; at = text.find(part, at + 1))
    ++count;
  return count;
}

TEST(Report, DataBlockHoldsTheGivenNumbers) {
  const LightCurve curve = test::synthetic_curve();
  const auto data = data_of(page_of(input_of(curve)));
  ASSERT_EQ(data["bands"].size(), 3U);
  ASSERT_EQ(data["epochs"]["time"].size(), curve.epochs.size());
  const std::size_t row = 77;
  const LightCurveSample &sample = curve.samples[row * 3 + 1];
  const auto &band = data["bands"][1];
  EXPECT_EQ(band["name"], "nm:550");
  EXPECT_EQ(band["intensity"][row].get<double>(), sample.intensity);
  EXPECT_EQ(band["irradiance"][row].get<double>(), sample.irradiance);
  EXPECT_EQ(band["q"][row].get<double>(), sample.sky.q);
  EXPECT_EQ(band["u"][row].get<double>(), sample.sky.u);
  EXPECT_EQ(band["q_scat"][row].get<double>(), sample.scattering.q);
  EXPECT_EQ(band["pa"][row].get<double>(), sample.pa_deg);
  EXPECT_EQ(data["epochs"]["phase"][row].get<double>(),
            curve.epochs[row].geometry.phase_angle.degrees());
  EXPECT_EQ(data["pure_materials"][0]["q_scat"][1].get<double>(), 0.125);
  EXPECT_EQ(data["manifest"][1], nlohmann::json({"seed", "20580"}));
  EXPECT_EQ(data["norad_cat_id"], 20580);
}

TEST(Report, DarkEpochsHaveNoPolarizationAndZeroIntensity) {
  const LightCurve curve = test::synthetic_curve();
  const auto data = data_of(page_of(input_of(curve)));
  int dark = 0;
  for (std::size_t i = 0; i < curve.epochs.size(); ++i)
    if (curve.epochs[i].is_dark) {
      ++dark;
      EXPECT_EQ(data["epochs"]["dark"][i], 1);
      EXPECT_EQ(data["bands"][0]["intensity"][i].get<double>(), 0);
      for (const char *name : {"q", "u", "p", "pa", "q_scat", "mag"})
        EXPECT_TRUE(data["bands"][0][name][i].is_null()) << name;
    }
  EXPECT_GT(dark, 5);
}

TEST(Report, HalfWidthsStandBesideTheirNumbers) {
  LightCurve curve = test::synthetic_curve(40);
  curve.samples[3 * 5 + 1].half_width.i = 0.01 * curve.samples[3 * 5 + 1].intensity;
  const auto data = data_of(page_of(input_of(curve)));
  // 2.5 log10(1.01) = .010803...; two digits are written. All other errors of this curve are 0.
  EXPECT_EQ(data["bands"][1]["mag_err"][5].get<double>(), 0.011);
  EXPECT_EQ(data["bands"][1]["mag_err"][6].get<double>(), 0);
  const double p = curve.samples[3 * 5 + 1].p; // dp = p dI/I where Q and U are exact
  EXPECT_NEAR(data["bands"][1]["p_err"][5].get<double>(), 0.01 * p, 0.05 * 0.01 * p);
}

TEST(Report, PeriodogramWhereTheAttitudeTurns) {
  const LightCurve curve = test::synthetic_curve();
  ReportInput input = input_of(curve);
  EXPECT_TRUE(data_of(page_of(input))["turning"].is_null());
  input.turning = {{"spin", 66}};
  const auto turning = data_of(page_of(input))["turning"];
  EXPECT_EQ(turning["periods"][0]["seconds"], 66);
  ASSERT_EQ(turning["passes"].size(), 2U);
  EXPECT_EQ(turning["passes"][1]["pass"], "20580-20180121T161803Z");
  // sin(40 t) with t = 1 after 420 s: 2 pi 420 / 40 = 65.97 s; the phase curve beneath it shifts it
  // a little.
  EXPECT_NEAR(turning["passes"][0]["bands"][1]["best"].get<double>(), 65.97, 1.5);
}

TEST(Report, EachMaterialHasItsContribution) {
  const LightCurve curve = test::synthetic_curve();
  const auto data = data_of(page_of(input_of(curve)));
  ASSERT_EQ(data["contributions"].size(), 2U);
  EXPECT_EQ(data["contributions"][1]["material"], "paper_al");
  const std::size_t row = 30, band = 2;
  const double expected = curve.material_i[(row * 2 + 1) * 3 + band];
  EXPECT_EQ(data["contributions"][1]["intensity"][band][row].get<double>(), expected);
}

TEST(Report, TextsOfTheUserAreInert) {
  LightCurve curve = test::synthetic_curve(10);
  const std::string bad = "</script><script>alert(1)</script><img src=x onerror=alert(2)> & \"'";
  curve.object = curve.materials[0] = curve.epochs[0].pass_id = bad;
  ReportInput input = input_of(curve);
  input.title = input.site.name = bad;
  input.passes[0].id = bad;
  input.warnings = {bad};
  input.manifest = {{bad, bad}};
  input.conventions = {bad};
  input.key_frames = {{bad, bad, 1, 0, 0, {{bad, "x"}}}};
  input.key_frame_materials = {bad};
  const std::string page = page_of(input), clean = page_of(input_of(test::synthetic_curve(10)));
  EXPECT_EQ(page.find("alert(1)</script>"), std::string::npos);
  EXPECT_EQ(page.find("<img src=x"), std::string::npos);
  EXPECT_EQ(count_of(page, "<script"), count_of(clean, "<script"));
  EXPECT_EQ(count_of(page, "</script"), count_of(clean, "</script"));
  EXPECT_EQ(data_of(page)["title"], bad);
  EXPECT_NE(page.find("<title>&lt;/script&gt;&lt;script&gt;"), std::string::npos);
}

TEST(Report, MarksOfTheTemplateInUserTextStayText) {
  const LightCurve curve = test::synthetic_curve(10);
  ReportInput input = input_of(curve);
  input.title = "@@DATA@@ and @@PLOTLY@@";
  EXPECT_NE(page_of(input).find("<title>@@DATA@@ and @@PLOTLY@@</title>"), std::string::npos);
}

TEST(Report, BytesThatAreNotUtf8DoNotBreakThePage) {
  const LightCurve curve = test::synthetic_curve(10);
  ReportInput input = input_of(curve);
  input.warnings = {"caf\xe9"};
  EXPECT_EQ(data_of(page_of(input))["warnings"][0], "caf\xef\xbf\xbd"); // U+FFFD
}

TEST(Report, LoadsNothingFromAnywhere) {
  const std::string page = page_of(input_of(test::synthetic_curve(10)));
  // Attributes and calls that fetch; the pictures are data URLs in the data block.
  const std::regex fetches(
      R"((src|href|action|poster|data)\s*=\s*["']?\s*(https?:|//|file:)|@import|url\(|<link|<iframe|\bfetch\(|XMLHttpRequest|WebSocket|sendBeacon|importScripts|\bimport\()");
  std::smatch match;
  const bool found = std::regex_search(page, match, fetches);
  EXPECT_FALSE(found) << match.str();
  EXPECT_NE(page.find("default-src 'none'"), std::string::npos);
  // The only address in our own parts is the name of the SVG namespace.
  const std::regex address(R"(https?://[^\s"'<)]*)");
  for (auto at = std::sregex_iterator(page.begin(), page.end(), address);
       at != std::sregex_iterator(); ++at)
    EXPECT_EQ(at->str(), "http://www.w3.org/2000/svg");
}

TEST(Report, CarriesTheLicenceOfThePlottingScript) {
  const std::string page = page_of(input_of(test::synthetic_curve(10)));
  EXPECT_NE(page.find("MIT License"), std::string::npos);
  EXPECT_NE(page.find("Plotly Technologies Inc."), std::string::npos);
}

TEST(Report, SameInputGivesTheSameBytes) {
  EXPECT_EQ(page_of(input_of(test::synthetic_curve())), page_of(input_of(test::synthetic_curve())));
}

TEST(Report, LongCurveIsThinnedAndSaysSo) {
  const auto data = data_of(page_of(input_of(test::synthetic_curve(report_max_epochs))));
  EXPECT_EQ(data["stride"], 2);
  EXPECT_EQ(data["epochs"]["time"].size(), report_max_epochs);
}

TEST(Report, BuildWithoutPlottingScriptSaysHowToGetIt) {
  const LightCurve curve = test::synthetic_curve(10);
  const auto page = assemble_report(input_of(curve), "");
  ASSERT_FALSE(page);
  EXPECT_NE(page.error().message.find("pip install plotly"), std::string::npos);
  EXPECT_NE(page.error().message.find("-DUMOV_PLOTLY_JS="), std::string::npos);
  if (const auto built_in = make_report(input_of(curve)))
    EXPECT_NE(built_in->find("plotly.js v"), std::string::npos);
  else
    EXPECT_EQ(built_in.error().message, page.error().message);
}

TEST(Report, ArraysThatDoNotFitAreOurBug) {
  LightCurve curve = test::synthetic_curve(10);
  curve.samples.pop_back();
  EXPECT_EQ(assemble_report(input_of(curve), stand_in).error().code, ErrorCode::Internal);
  curve = test::synthetic_curve(10);
  ReportInput input = input_of(curve);
  input.pure_materials[0].band = 3;
  EXPECT_NE(assemble_report(input, stand_in).error().message.find("paper_al"), std::string::npos);
}

TEST(Report, PureMaterialCurvesAreFresnelRatios) {
  const auto bands = bands_from({"paper_rgb"});
  std::vector<Surface> surfaces;
  for (const char *name : {"paper_al", "paper_spectralon", "paper_al"})
    surfaces.push_back(*Surface::compile(*builtin_material(name), *bands));
  const auto curves = pure_material_curves(surfaces, *BandGrid::make(*bands));
  ASSERT_EQ(curves.size(), 3U); // aluminium once; spectralon (n = 1) has no interface
  ASSERT_EQ(curves[1].phase_deg.size(), 181U);
  EXPECT_EQ(curves[1].material, "paper_al");
  EXPECT_EQ(curves[1].phase_deg[140], 140);
  // Aluminium at 550 nm, phase 140: M01/M00, six digits each.
  EXPECT_NEAR(curves[1].q_scat[140], anchor("al_550_140_M01") / anchor("al_550_140_M00"), 2e-6);
  EXPECT_NEAR(curves[1].q_scat[0], 0, 1e-15); // normal incidence: no plane
}

TEST(Base64, MatchesRfc4648) { // RFC 4648 section 10
  EXPECT_EQ(base64(""), "");
  EXPECT_EQ(base64("f"), "Zg==");
  EXPECT_EQ(base64("fo"), "Zm8=");
  EXPECT_EQ(base64("foo"), "Zm9v");
  EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
  EXPECT_EQ(base64("\xff\xfe"), "//4=");
}

} // namespace
} // namespace umov
