#include "core/tests/anchors.h"

#include <cmath>
#include <fstream>
#include <gtest/gtest.h>
#include <umov/core/text.h>
#include <umov/io/passband_file.h>

namespace umov {
namespace {

/// Fails with a message that has all these pieces.
void expect_refused(const std::string &text, std::initializer_list<const char *> pieces,
                    const PassbandForm &form = {}, const std::string &file = "x.csv") {
  const auto read = read_passband_text(text, file, form);
  ASSERT_FALSE(read) << text;
  for (const char *piece : pieces)
    EXPECT_NE(read.error().text().find(piece), std::string::npos)
        << piece << " in " << read.error().text();
}

const char *const simple = "# unit: nm\n# detector: photon\nwavelength,response\n"
                           "500,0\n510,1\n590,0.9\n600,0\n";

TEST(PassbandFile, TwoColumnsInAnyDress) {
  const auto plain = read_passband_text(simple, "folder/x.csv");
  ASSERT_TRUE(plain);
  EXPECT_EQ(plain->name, "file:x.csv");
  EXPECT_EQ(plain->response, (std::vector<double>{0, 1, 0.9, 0}));
  for (const char *same :
       {"# wavelengths in Angstrom, detector = photon\r\n5000 0\r\n5100\t1\r\n5900 0.9\r\n6000 "
        "0\r\n",
        "! detector: photons\nlambda (um); R\n0.5;0\n0.51;1\n0.59;0.9\n0.6;0\n",
        "# %ECSV 1.0\n# ---\n# datatype:\n# - {name: wavelength, unit: nm, datatype: float64}\n"
        "# - {name: response, datatype: float64}\n# meta: {detector: photon, text: of 10 "
        "Angstrom}\n"
        "wavelength response\n500 0\n510 1\n590 0.9\n600 0\n"}) {
    const auto read = read_passband_text(same, "x.csv");
    ASSERT_TRUE(read) << read.error().text();
    for (std::size_t i = 0; i < 4; ++i)
      EXPECT_NEAR(read->wavelength_nm[i], plain->wavelength_nm[i], 1e-9) << same;
  }
}

TEST(PassbandFile, UnitAndDetectorAreNeverGuessed) {
  expect_refused("# detector: photon\n500 1\n600 1\n", {"x.csv", "unit", "# unit: nm"});
  expect_refused("# unit: nm\n500 1\n600 1\n", {"photons or energy", "detector = \"photon\""});
  EXPECT_TRUE(read_passband_text("500 1\n600 1\n", "x.csv", {"nm", DetectorKind::Energy}));
  expect_refused(simple, {"unit = \"um\"", "says nm"}, {"um", {}});
  expect_refused(simple, {"energy", "says photon"}, {"", DetectorKind::Energy});
  expect_refused("500 1\n600 1\n", {"parsec"}, {"parsec", DetectorKind::Photon});
}

TEST(PassbandFile, UnitsAreThoseOfTheWavelengths) {
  const std::string rows = "5000 0\n5500 1\n6000 0\n";
  for (const char *unit : {"\xc3\x85", "\xe2\x84\xab", "\xc3\xa5"})
    EXPECT_TRUE(read_passband_text(std::string("# unit: ") + unit + "\n# detector: photon\n" + rows,
                                   "x.csv"))
        << unit;
  // A camera's pixels, or a film's thickness, in the comments.
  const std::string camera = "# camera of 3.45 micron pixels, detector: photon\n";
  expect_refused(camera + rows, {"the unit of the wavelengths is not said"});
  const auto read = read_passband_text(camera + "# unit: Angstrom\n" + rows, "x.csv");
  ASSERT_TRUE(read) << read.error().text();
  EXPECT_NEAR(read->wavelength_nm[1], 550, 1e-9);
}

TEST(PassbandFile, LongWavelengthsAreBounded) {
  // An energy curve is cut into nanometres: one of kilometres would take gigabytes.
  expect_refused("# unit: nm\n# detector: energy\n500 1\n2e6 1\n", {"1e+06"});
  EXPECT_TRUE(read_passband_text("# unit: nm\n# detector: energy\n500 1\n1e6 1\n", "x.csv"));
}

TEST(PassbandFile, BadRowsNameTheirLine) {
  const std::string head = "# unit: nm\n# detector: photon\n";
  expect_refused(head + "500 1\n600 x\n", {"x.csv:4:", "two numbers"});
  expect_refused(head + "500 1 1\n600 1 1\n", {"x.csv:3:", "two numbers"});
  expect_refused(head + "500 1\n600 nan\n", {"x.csv:4:", "two numbers"});
  expect_refused(head + "500 1\n400 1\n", {"x.csv:4:", "increasing"});
  expect_refused(head + "500 1\n600 -0.01\n", {"x.csv:4:", "0 to 1"});
  expect_refused(head + "500 1\n600 95\n", {"x.csv:4:", "per cent"});
  expect_refused(head + "500 1\n", {"one point"});
  expect_refused(head, {"no row"});
  expect_refused("", {"no row"});
  expect_refused("# unit: nm\n# detector: photon\n0.5 0\n0.55 1\n0.6 0\n", {"micrometres"});
  expect_refused("# Angstrom\n# detector: photon\n500 0\n550 1\n600 0\n", {"are they nm?"});
}

/// As the SVO Filter Profile Service writes them, made by hand.
std::string votable(const std::string &parameters, const std::string &rows) {
  return "<?xml version=\"1.0\"?>\n<VOTABLE version=\"1.1\">\n<INFO name=\"QUERY_STATUS\" "
         "value=\"OK\"/>\n<RESOURCE type=\"results\">\n<TABLE>\n" +
         parameters +
         "<FIELD name=\"Wavelength\" unit=\"AA\"/>\n<FIELD name=\"Transmission\"/>\n<DATA>\n" +
         rows + "</DATA>\n</TABLE>\n</RESOURCE>\n</VOTABLE>\n";
}
const std::string three_rows =
    "<TABLEDATA>\n<TR><TD>5000</TD><TD> 0.0 </TD></TR>\n<TR><TD>5500</TD>"
    "<TD>1.0</TD></TR>\n<TR><TD>6000</TD><TD>0</TD></TR>\n</TABLEDATA>\n";

TEST(PassbandFile, VoTableOfTheFilterProfileService) {
  const std::string parameters = "<PARAM name=\"filterID\" value=\"Made/Up.V\"/>\n"
                                 "<PARAM name=\"WavelengthUnit\" value=\"Angstrom\"/>\n"
                                 "<PARAM name=\"DetectorType\" value=\"1\"/>\n"
                                 "<PARAM name=\"MagSys\" value=\"Vega\"/>\n"
                                 "<PARAM name=\"ZeroPoint\" value=\"3600\" unit=\"Jy\"/>\n";
  const auto read = read_passband_text(votable(parameters, three_rows), "v.vot");
  ASSERT_TRUE(read) << read.error().text();
  EXPECT_NEAR(read->wavelength_nm[1], 550, 1e-9);
  EXPECT_EQ(read->response[1], 1);
  EXPECT_NE(read->source.find("Made/Up.V"), std::string::npos);
  // 3600 Jy against the 3631 Jy of AB, at the same pivot.
  const double ab = *zero_irradiance(*read, MagnitudeSystem::AB);
  EXPECT_NEAR(*zero_irradiance(*read, MagnitudeSystem::Vega), ab * 3600 / 3631, 1e-12 * ab);
  const auto energy = read_passband_text(
      votable("<PARAM name=\"DetectorType\" value=\"0\"/>\n", three_rows), "v.vot");
  ASSERT_TRUE(energy);
  EXPECT_LT(pivot_nm(*energy), pivot_nm(*read)); // photons of an energy curve lie bluer
  EXPECT_EQ(energy->vega_zero, 0);
}

TEST(PassbandFile, BadVoTables) {
  const std::string kind = "<PARAM name=\"DetectorType\" value=\"1\"/>\n";
  expect_refused("<VOTABLE><RESOURCE>", {"x.vot", "no XML"}, {}, "x.vot");
  expect_refused("<html></html>", {"<VOTABLE>"}, {}, "x.vot");
  expect_refused(votable(kind, "<BINARY/>"), {"TABLEDATA"}, {}, "x.vot");
  expect_refused(votable(kind, "<TABLEDATA></TABLEDATA>"), {"no row"}, {}, "x.vot");
  expect_refused(votable(kind, "<TABLEDATA>\n<TR><TD>5000</TD></TR></TABLEDATA>"), {"two numbers"},
                 {}, "x.vot");
  expect_refused(votable("", three_rows), {"photons or energy"}, {}, "x.vot");
  expect_refused(votable("<PARAM name=\"DetectorType\" value=\"7\"/>\n", three_rows),
                 {"x.vot:6:", "DetectorType"}, {}, "x.vot");
  expect_refused(votable(kind + "<PARAM name=\"ZeroPoint\" value=\"-1\"/>\n", three_rows),
                 {"x.vot:7:", "ZeroPoint"}, {}, "x.vot");
  expect_refused("<!DOCTYPE a [<!ENTITY b 'c'>]>\n" + votable(kind, three_rows), {"document type"},
                 {}, "x.vot");
}

TEST(PassbandLibrary, NumbersOfAllCurves) {
  const Anchors anchors("bands");
  EXPECT_EQ(anchors.size() + 3, passband_names().size()); // those of rgb_wide are no files
  for (const AnchorRow &row : anchors) {
    const auto band = find_passband(row.text("name"));
    ASSERT_TRUE(band) << band.error().text();
    EXPECT_EQ(*find_passband(row.text("stem")), *band);
    const auto near = [&](const char *column, double value) {
      EXPECT_NEAR(value, row[column], 1.01 * row.half_digit(column)) << band->name << column;
    };
    const auto sun = sunlight_in(*band);
    near("pivot_nm", pivot_nm(*band));
    near("effective_nm", sun->effective_nm);
    near("spread_nm", sun->spread_nm);
    near("mean_w_m2_nm", sun->value);
    const auto magnitude = [&](MagnitudeSystem system) {
      return -2.5 * std::log10(sun->value / *zero_irradiance(*band, system));
    };
    near("ab", magnitude(MagnitudeSystem::AB));
    near("st", magnitude(MagnitudeSystem::ST));
    near("ab_zero_1e9_photons_s_m2", ab_zero_photons(*band) / 1e9);
    if (row.text("vega") != "none")
      near("vega", magnitude(MagnitudeSystem::Vega));
    else
      EXPECT_FALSE(zero_irradiance(*band, MagnitudeSystem::Vega));
  }
}

TEST(PassbandLibrary, TheSunHasItsPublishedMagnitudes) {
  // Willmer 2018 Tables 3 and 4 (Sun over Vega) and Casagrande & VandenBerg 2018 (Gaia G). U, B and
  // g differ by more: their curves and solar spectra are others.
  const auto sun = [](const char *name, MagnitudeSystem system) {
    const auto band = *find_passband(name);
    return -2.5 * std::log10(sunlight_in(band)->value / *zero_irradiance(band, system));
  };
  using enum MagnitudeSystem;
  EXPECT_NEAR(sun("Bessell.V", Vega), -26.7611, 0.01);
  EXPECT_NEAR(sun("Bessell.R", Vega), -27.1481, 0.01);
  EXPECT_NEAR(sun("Bessell.I", Vega), -27.4669, 0.01);
  EXPECT_NEAR(sun("sdss.r", Vega), -27.0400, 0.01);
  EXPECT_NEAR(sun("gaia.G", Vega), -26.90, 0.01);
  EXPECT_NEAR(sun("Bessell.U", Vega), -25.9670, 0.04);
  EXPECT_NEAR(sun("Bessell.B", Vega), -26.1351, 0.04);
  EXPECT_NEAR(sun("sdss.g", Vega), -26.3443, 0.04);
}

TEST(PassbandLibrary, AbMagnitudesOfTheSunAreThoseOfSpeclite) {
  std::ifstream file(UMOV_SOURCE_DIR "/tests/data/bands/speclite_ab.csv");
  std::size_t rows = 0;
  for (std::string line; std::getline(file, line);) {
    const std::size_t comma = line.find(',');
    const auto theirs = parse_number(std::string_view(line).substr(comma + 1));
    if (line.starts_with('#') || !theirs)
      continue;
    const auto band = *find_passband(line.substr(0, comma));
    const double ours =
        -2.5 * std::log10(sunlight_in(band)->value / *zero_irradiance(band, MagnitudeSystem::AB));
    // Six decimals are stored. LSST's curves are thinned here.
    EXPECT_NEAR(ours, *theirs, band.name.starts_with("lsst.") ? 2e-4 : 1e-6) << band.name;
    ++rows;
  }
  EXPECT_EQ(rows + 3, passband_names().size());
}

TEST(Bands, OfAScenarioByTheirNames) {
  const auto bands = bands_named({"Bessell.V", "nm:550", "gaia", "rgb_wide", "lsst2023-r"});
  ASSERT_TRUE(bands) << bands.error().text();
  std::vector<std::string> names;
  for (const Band &band : *bands)
    names.push_back(band.name);
  EXPECT_EQ(names,
            (std::vector<std::string>{"Bessell.V", "nm:550", "gaia.G", "gaia.BP", "gaia.RP",
                                      "rgb_wide.425", "rgb_wide.550", "rgb_wide.650", "lsst.r"}));
  EXPECT_FALSE((*bands)[1].curve);
  const auto slip = bands_named({"Besell.V"});
  ASSERT_FALSE(slip);
  EXPECT_NE(slip.error().message.find("Did you mean \"Bessell.V\""), std::string::npos);
  for (const auto &[written, meant] : {std::pair{"bessell.v", "Bessell.V\"?"},
                                       {"V", "\"Bessell.V\"?"},
                                       {"Johnson.V", "\"Bessell.V\"?"},
                                       {"UBV", "[\"Bessell.U\", \"Bessell.B\", \"Bessell.V\"]?"},
                                       {"bessell", "\"Bessell\"?"},
                                       {"550nm", "\"nm:550\"?"},
                                       {"550", "\"nm:550\"?"}}) {
    const auto refused = find_passband(written);
    ASSERT_FALSE(refused) << written;
    EXPECT_NE(refused.error().message.find(meant), std::string::npos) << refused.error().message;
  }
  EXPECT_FALSE(bands_named({"Bessell.V", "bessell-V"})); // twice
  EXPECT_FALSE(bands_named({"file:/nonexistent.vot"}));
  EXPECT_FALSE(bands_named(std::vector<std::string>{}));
}

} // namespace
} // namespace umov
