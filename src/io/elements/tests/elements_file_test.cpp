// OMM in its four forms against the same set as a TLE, and what is refused.

#include <umov/io/elements_file.h>

#include <cmath>
#include <gtest/gtest.h>
#include <umov/core/files.h>
#include <umov/core/quantity.h>

namespace umov {
namespace {

const std::string folder = UMOV_SOURCE_DIR "/tests/data/ccsds/";

Result<std::vector<ElementSet>> read_text(const std::string &text, TleOptions options = {}) {
  Diagnostics diagnostics;
  return read_elements(text, "sets", options, diagnostics);
}
std::string refusal(const std::string &text) {
  const auto sets = read_text(text);
  return sets ? std::string() : sets.error().text();
}
std::vector<ElementSet> read_sample(const std::string &name) {
  const auto sets = read_text(*read_file(folder + name));
  EXPECT_TRUE(sets) << name << ": " << sets.error().text();
  return sets ? *sets : std::vector<ElementSet>(1);
}

/// The ISS of 2008-09-20, of the samples, as a TLE (Wikipedia's example of the format).
constexpr const char *iss_tle =
    "ISS (ZARYA)\n"
    "1 25544U 98067A   08264.51782528 -.00002182  00000-0 -11606-4 0  2927\n"
    "2 25544  51.6416 247.4627 0006703 130.5360 325.0288 15.72125391563537\n";

void expect_same(const ElementSet &a, const ElementSet &b) {
  EXPECT_EQ(a.norad_cat_id, b.norad_cat_id);
  EXPECT_EQ(a.bstar, b.bstar);
  EXPECT_EQ(a.mean_motion_dot, b.mean_motion_dot);
  EXPECT_EQ(a.mean_motion_ddot, b.mean_motion_ddot);
  EXPECT_EQ(a.inclination, b.inclination);
  EXPECT_EQ(a.raan, b.raan);
  EXPECT_EQ(a.eccentricity, b.eccentricity);
  EXPECT_EQ(a.argument_of_perigee, b.argument_of_perigee);
  EXPECT_EQ(a.mean_anomaly, b.mean_anomaly);
  EXPECT_EQ(a.mean_motion, b.mean_motion);
  EXPECT_EQ(a.element_number, b.element_number);
  EXPECT_EQ(a.revolution, b.revolution);
  EXPECT_EQ(a.epoch_year, b.epoch_year);
  // Epochs in microseconds against a TLE's 8 decimals of a day.
  EXPECT_NEAR(clock_days_between(a.epoch, b.epoch) * 86400, 0, 5e-4);
  EXPECT_NEAR(a.epoch_day_of_year, b.epoch_day_of_year, 6e-9);
}

/// The message as catalogues serve it.
std::string json_of(const std::string &changed = "", const std::string &value = "",
                    bool is_text = false) {
  const std::pair<const char *, const char *> fields[] = {
      {"OBJECT_NAME", "\"ISS (ZARYA)\""},
      {"OBJECT_ID", "\"1998-067A\""},
      {"EPOCH", "\"2008-09-20T12:25:40.104192\""},
      {"MEAN_MOTION", "15.72125391"},
      {"ECCENTRICITY", ".6703E-3"},
      {"INCLINATION", "51.6416"},
      {"RA_OF_ASC_NODE", "247.4627"},
      {"ARG_OF_PERICENTER", "130.536"},
      {"MEAN_ANOMALY", "325.0288"},
      {"EPHEMERIS_TYPE", "0"},
      {"CLASSIFICATION_TYPE", "\"U\""},
      {"NORAD_CAT_ID", "25544"},
      {"ELEMENT_SET_NO", "292"},
      {"REV_AT_EPOCH", "56353"},
      {"BSTAR", "-1.1606e-5"},
      {"MEAN_MOTION_DOT", "-2.182e-5"},
      {"MEAN_MOTION_DDOT", "0"}};
  std::string out = "[{";
  for (const auto &[key, text] : fields) {
    std::string shown = key == changed ? value : text;
    if (shown.starts_with('.'))
      shown = "0" + shown;
    if (key == changed && value.empty())
      continue;
    if (is_text && !shown.starts_with('"'))
      shown = "\"" + shown + "\"";
    out += (out.size() > 2 ? ",\"" : "\"") + std::string(key) + "\":" + shown;
  }
  return out + "}]";
}
std::string csv_of(const std::string &row_end = "") {
  return "OBJECT_NAME,OBJECT_ID,EPOCH,MEAN_MOTION,ECCENTRICITY,INCLINATION,RA_OF_ASC_NODE,"
         "ARG_OF_PERICENTER,MEAN_ANOMALY,EPHEMERIS_TYPE,CLASSIFICATION_TYPE,NORAD_CAT_ID,"
         "ELEMENT_SET_NO,REV_AT_EPOCH,BSTAR,MEAN_MOTION_DOT,MEAN_MOTION_DDOT\r\n"
         "\"ISS (ZARYA)\",1998-067A,2008-09-20T12:25:40.104192,15.72125391,.0006703,51.6416,"
         "247.4627,130.5360,325.0288,0,U,25544,292,56353,-.11606E-4,-.2182E-4,0" +
         row_end + "\r\n";
}

TEST(Elements, OneSetInEveryFormIsTheSame) {
  const ElementSet tle = read_text(iss_tle)->front();
  for (const char *name : {"omm.kvn", "omm.xml", "omm_cov.kvn", "omm_cov.xml",
                           "omm_user_defined.kvn", "omm_user_defined.xml"}) {
    SCOPED_TRACE(name);
    const auto sets = read_sample(name);
    ASSERT_EQ(sets.size(), 1u);
    expect_same(sets[0], tle);
    EXPECT_EQ(sets[0].name, "ISS (ZARYA)");
    EXPECT_EQ(sets[0].international_designator, "1998-067A");
  }
  for (const std::string &text :
       {json_of(), json_of("", "", true), csv_of(), "\xEF\xBB\xBF" + csv_of(),
        json_of().substr(1, json_of().size() - 2)})
    expect_same(read_text(text)->front(), tle);
}

TEST(Elements, ANameThatLooksLikeAnotherFormIsAName) {
  const std::string lines =
      "1 25544U 98067A   18021.16666667  .00001264  00000-0  26392-4 0  9996\n"
      "2 25544  51.6432 332.0000 0003457  31.2000 328.9000 15.54000000 95380\n";
  for (const char *name : {"{ISS}", "[ISS]", "<ISS>", "CCSDS_ISS", "MEAN_MOTION, ISS"}) {
    EXPECT_EQ(form_of_elements(name + std::string("\n") + lines), ElementsForm::Tle) << name;
  }
  EXPECT_EQ(form_of_elements("{\n\"A\": 1}"), ElementsForm::OmmJson);
  // A row of a table whose first name begins as an element line does.
  EXPECT_EQ(form_of_elements("OBJECT_NAME,OBJECT_ID,EPOCH,MEAN_MOTION,ECCENTRICITY\n1 "
                             "HOPPER,1964-001A,2018-01-21T04:00:00,"
                             "15.54000000,0.0003457,51.6432\n"),
            ElementsForm::OmmCsv);
}

TEST(Elements, TheBlueBooksExampleIsReadInBothForms) {
  const ElementSet kvn = read_sample("omm_bluebook.kvn")[0],
                   xml = read_sample("omm_bluebook.xml")[0];
  expect_same(kvn, xml);
  EXPECT_EQ(kvn.norad_cat_id, 23581);
  EXPECT_EQ(kvn.inclination, Angle::degrees(3.0539).radians());
  EXPECT_EQ(kvn.epoch_day_of_year, 64.44075725); // 5 March 2007, 10:34:41.4264
  // The example of the format gives the same elements under day 064 = 5 March.
  expect_same(kvn, read_sample("bluebook.tle")[0]);
}

TEST(Elements, SeveralMessagesInOneFile) {
  const std::string kvn =
      *read_file(folder + "omm.kvn") + "\n" + *read_file(folder + "omm_bluebook.kvn");
  EXPECT_EQ(read_text(kvn)->size(), 2u);
  std::string xml = *read_file(folder + "omm.xml");
  xml = xml.substr(xml.find("<omm"));
  EXPECT_EQ(read_text("<ndm>" + xml + xml + "</ndm>")->size(), 2u);
  const std::string one = json_of().substr(1, json_of().size() - 2);
  EXPECT_EQ(read_text("[" + one + "," + one + "," + one + "]")->size(), 3u);
}

TEST(Elements, CatalogueNumbersOfSixAndNineDigits) {
  for (const int number : {270123, 799500123}) {
    EXPECT_EQ(read_text(json_of("NORAD_CAT_ID", std::to_string(number)))->front().norad_cat_id,
              number);
    EXPECT_EQ(read_text(json_of("NORAD_CAT_ID", "\"" + std::to_string(number) + "\""))
                  ->front()
                  .norad_cat_id,
              number);
  }
}

TEST(Elements, EpochsInEveryWriting) {
  const auto epoch = [](const std::string &text) {
    const auto sets = read_text(json_of("EPOCH", "\"" + text + "\""));
    EXPECT_TRUE(sets) << sets.error().text();
    return sets ? to_iso(sets->front().epoch, 9) : std::string();
  };
  EXPECT_EQ(epoch("2008-09-20T12:25:40.104192Z"), "2008-09-20T12:25:40.104192000Z");
  EXPECT_EQ(epoch("2008-264T12:25:40.104192"), "2008-09-20T12:25:40.104192000Z");
  EXPECT_EQ(epoch("2008-366T00:00:00"), "2008-12-31T00:00:00.000000000Z");
  EXPECT_EQ(epoch("2008-09-20T12:25:40"), "2008-09-20T12:25:40.000000000Z");
  EXPECT_EQ(epoch("2016-12-31T23:59:60.5"), "2016-12-31T23:59:60.500000000Z");
  EXPECT_NE(refusal(json_of("EPOCH", "\"2007-366T00:00:00\"")).find("EPOCH"), std::string::npos);
  EXPECT_NE(refusal(json_of("EPOCH", "\"2015-12-31T23:59:60\"")).find("EPOCH"), std::string::npos);
}

TEST(Elements, EveryMissingFieldIsNamed) {
  for (const char *key : {"OBJECT_NAME", "OBJECT_ID", "EPOCH", "MEAN_MOTION", "ECCENTRICITY",
                          "INCLINATION", "RA_OF_ASC_NODE", "ARG_OF_PERICENTER", "MEAN_ANOMALY",
                          "BSTAR", "MEAN_MOTION_DOT", "MEAN_MOTION_DDOT"}) {
    const std::string said = refusal(json_of(key, ""));
    EXPECT_NE(said.find(std::string(key) + " is missing"), std::string::npos) << said;
  }
  // KVN and XML must say what SGP4 takes for granted.
  for (const char *key : {"CENTER_NAME", "REF_FRAME", "TIME_SYSTEM", "MEAN_ELEMENT_THEORY"})
    for (const char *name : {"omm.kvn", "omm.xml"}) {
      std::string text = *read_file(folder + name);
      const std::size_t at = text.find(key);
      if (name == std::string("omm.kvn"))
        text.replace(at, 1, "X");
      else
        text.erase(at - 1, text.find('\n', at) - at + 1);
      EXPECT_NE(refusal(text).find(key), std::string::npos) << name << refusal(text);
    }
}

struct Bad {
  const char *key, *value, *said;
};
class BadField : public testing::TestWithParam<Bad> {};
TEST_P(BadField, IsRefusedByName) {
  const std::string said = refusal(json_of(GetParam().key, GetParam().value));
  EXPECT_NE(said.find(GetParam().said), std::string::npos) << said;
  EXPECT_NE(said.find("sets"), std::string::npos);
}
INSTANTIATE_TEST_SUITE_P(
    Elements, BadField,
    testing::Values(
        Bad{"MEAN_MOTION", "0", "above 0"}, Bad{"MEAN_MOTION", "\"NaN\"", "MEAN_MOTION"},
        Bad{"MEAN_MOTION", "\"1e400\"", "MEAN_MOTION"}, Bad{"MEAN_MOTION", "1e400", "JSON"},
        Bad{"ECCENTRICITY", "1", "below 1"}, Bad{"ECCENTRICITY", "-0.1", "0 to below 1"},
        Bad{"INCLINATION", "180.0001", "0 to 180"}, Bad{"RA_OF_ASC_NODE", "-1", "0 to 360"},
        Bad{"MEAN_ANOMALY", "\"12 deg\"", "MEAN_ANOMALY"},
        Bad{"NORAD_CAT_ID", "1234567890", "NORAD_CAT_ID"}, Bad{"NORAD_CAT_ID", "1.5", "whole"},
        Bad{"EPHEMERIS_TYPE", "4", "SGP4-XP"}, Bad{"EPOCH", "\"yesterday\"", "EPOCH"},
        Bad{"BSTAR", "[1]", "BSTAR"}, Bad{"OBJECT_ID", "{\"a\":{\"b\":[]}}", "deeper"}));

TEST(Elements, AnotherTheoryFrameOrMessageIsRefused) {
  EXPECT_NE(refusal(*read_file(folder + "omm_eh.kvn")).find("REF_FRAME"), std::string::npos);
  EXPECT_NE(refusal(*read_file(folder + "omm_eh.xml")).find("REF_FRAME"), std::string::npos);
  std::string text = *read_file(folder + "omm.kvn");
  EXPECT_NE(refusal("CCSDS_OEM_VERS = 2.0\n").find("CCSDS_OEM_VERS"), std::string::npos);
  const std::string units = "51.6416 [deg]";
  text.replace(text.find(units), units.size(), "0.90131 [rad]");
  EXPECT_NE(refusal(text).find("sets:16"), std::string::npos) << refusal(text); // with its line
  EXPECT_NE(refusal(text).find("expected deg"), std::string::npos);
}

TEST(Elements, FieldsThatStandTwiceAreRefused) {
  const std::string kvn = *read_file(folder + "omm.kvn") + "\nBSTAR = 0\n";
  EXPECT_NE(refusal(kvn).find("BSTAR stands twice, first in line 27"), std::string::npos)
      << refusal(kvn);
  std::string xml = *read_file(folder + "omm.xml");
  xml.insert(xml.find("<ECCENTRICITY>"), "<ECCENTRICITY>0</ECCENTRICITY>");
  EXPECT_NE(refusal(xml).find("ECCENTRICITY stands twice"), std::string::npos);
  std::string json = json_of();
  json.insert(2, "\"BSTAR\":1,");
  EXPECT_NE(refusal(json).find("BSTAR stands twice"), std::string::npos);
  std::string csv = csv_of();
  csv.replace(csv.find("REV_AT_EPOCH"), 12, "BSTAR"); // the line of keywords is the first
  EXPECT_TRUE(refusal(csv).starts_with("sets:1: BSTAR stands twice")) << refusal(csv);
}

TEST(Elements, BrokenJsonHasItsPlaceAndTheWayOn) {
  const std::string broken = refusal("[{\n \"BSTAR\": nan}]"), large = refusal("[{\"A\": 1e400}]");
  EXPECT_TRUE(broken.starts_with("sets:2:")) << broken;
  EXPECT_NE(broken.find("Fetch the sets again"), std::string::npos) << broken;
  EXPECT_NE(large.find("1e400"), std::string::npos) << large;
  EXPECT_NE(large.find("finite number was expected"), std::string::npos) << large;
}

TEST(Elements, HostileFilesAreRefusedAtOnce) {
  // Entities that expand to gigabytes, and a file of this machine.
  const std::string lol = "<?xml version=\"1.0\"?><!DOCTYPE omm [<!ENTITY a \"lol\"><!ENTITY b "
                          "\"&a;&a;&a;&a;&a;&a;&a;&a;&a;&a;\">]><omm><body>&b;</body></omm>";
  EXPECT_NE(refusal(lol).find("document type"), std::string::npos) << refusal(lol);
  EXPECT_NE(refusal("<!DOCTYPE omm SYSTEM \"file:///etc/passwd\"><omm/>").find("document type"),
            std::string::npos);
  EXPECT_NE(refusal(std::string(10'000, '[')).find("deeper"), std::string::npos);
  EXPECT_NE(refusal("<omm" + std::string(1'000'000, '<')).find("no XML"), std::string::npos);
  std::string deep;
  for (int i = 0; i < 100'000; ++i)
    deep += "<a>";
  EXPECT_NE(refusal("<omm>" + deep), "");
  for (const char *text :
       {"", "{", "[1,2]", "[]", "<a/>", "<ndm/>", "CCSDS_OMM_VERS = 2.0\nx\n", "CCSDS_OMM_VERS",
        "MEAN_MOTION,\n1,2,3\n", "MEAN_MOTION,\n\"1,2\n", "{}"})
    EXPECT_NE(refusal(text), "") << text;
}

TEST(Elements, BadMessagesMayBeLeftOut) {
  const std::string good = json_of().substr(1, json_of().size() - 2);
  const std::string bad =
      json_of("INCLINATION", "").substr(1, json_of("INCLINATION", "").size() - 2);
  Diagnostics diagnostics;
  const auto sets = read_elements("[" + good + "," + bad + "," + good + "]", "sets",
                                  {.keep_going = true}, diagnostics);
  ASSERT_TRUE(sets);
  EXPECT_EQ(sets->size(), 2u);
  const auto csv = read_text(csv_of() + "1,2,3\n", {.keep_going = true});
  ASSERT_TRUE(csv);
  EXPECT_EQ(csv->size(), 1u);
  EXPECT_NE(refusal(csv_of(",0")).find("18 cells, expected 17"), std::string::npos);
}

ElementsForm all_forms[] = {ElementsForm::OmmKvn, ElementsForm::OmmXml, ElementsForm::OmmJson,
                            ElementsForm::OmmCsv, ElementsForm::Tle};

void expect_equal(const ElementSet &a, const ElementSet &b) {
  expect_same(a, b);
  EXPECT_EQ(a.epoch.jd1, b.epoch.jd1);
  EXPECT_EQ(a.epoch.jd2, b.epoch.jd2);
  EXPECT_EQ(a.epoch_day_of_year, b.epoch_day_of_year);
  EXPECT_EQ(a.classification, b.classification);
  EXPECT_EQ(a.ephemeris_type, b.ephemeris_type);
}

TEST(Elements, WrittenAndReadBackIsTheSameToTheLastBit) {
  // The 979 objects of the catalogue, through every form and back.
  Diagnostics diagnostics;
  const auto sets = read_tle(*read_file(UMOV_SOURCE_DIR "/tests/data/tle/mixed_979_2018-01-20.tle"),
                             "mixed", {}, diagnostics);
  ASSERT_TRUE(sets) << sets.error().text();
  const Epoch<Utc> now = *utc_from_iso("2026-01-01T00:00:00Z");
  for (const ElementsForm form : all_forms) {
    Diagnostics said;
    const auto text = write_elements(*sets, form, now, said);
    ASSERT_TRUE(text) << text.error().text();
    EXPECT_EQ(form_of_elements(*text), form);
    EXPECT_TRUE(said.warnings().empty()) << said.warnings().front().message;
    const auto again = read_elements(*text, "again", {}, said);
    ASSERT_TRUE(again) << again.error().text();
    ASSERT_EQ(again->size(), sets->size());
    for (std::size_t k = 0; k < sets->size(); ++k) {
      SCOPED_TRACE((*sets)[k].name);
      expect_equal((*again)[k], (*sets)[k]);
      EXPECT_EQ((*again)[k].name, (*sets)[k].name);
    }
  }
}

TEST(Elements, ATleSaysWhatItCannotHold) {
  ElementSet set = read_sample("omm.kvn")[0];
  set.inclination = Angle::degrees(51.64161234).radians();
  Diagnostics said;
  const Epoch<Utc> now = *utc_from_iso("2026-01-01T00:00:00Z");
  const auto text = write_elements({set, read_sample("omm.xml")[0]}, ElementsForm::Tle, now, said);
  ASSERT_TRUE(text);
  ASSERT_EQ(said.warnings().size(), 1u);
  EXPECT_NE(said.warnings()[0].message.find("inclination of 1 set"), std::string::npos);
  set.norad_cat_id = 270'123;
  EXPECT_NE(write_elements({set}, ElementsForm::Tle, now, said)->find("1 T0123U"),
            std::string::npos);
  set.norad_cat_id = 340'000;
  EXPECT_NE(write_elements({set}, ElementsForm::Tle, now, said).error().message.find("Z9999"),
            std::string::npos);
  set.mean_motion_dot = 1.25;
  EXPECT_NE(write_elements({set}, ElementsForm::Tle, now, said).error().message.find("Z9999"),
            std::string::npos);
  set.norad_cat_id = 270'123;
  EXPECT_NE(write_elements({set}, ElementsForm::Tle, now, said).error().message.find("1.25 rev"),
            std::string::npos);
  // The other forms hold all of it.
  for (const ElementsForm form :
       {ElementsForm::OmmKvn, ElementsForm::OmmXml, ElementsForm::OmmJson, ElementsForm::OmmCsv})
    expect_equal(read_text(*write_elements({set}, form, now, said))->front(), set);
}

TEST(Elements, AnEpochThatRoundsUpToTheNextYearIsWrittenAsThat) {
  ElementSet set = read_sample("omm.kvn")[0];
  set.epoch_year = 2020;
  set.epoch_day_of_year = 367 - 1e-4 / 86400; // 1e-4 s before 2021: 367.00000000
  set.epoch = utc_from_year_day(set.epoch_year, set.epoch_day_of_year);
  Diagnostics said;
  const auto text = write_elements({set}, ElementsForm::Tle, set.epoch, said);
  ASSERT_TRUE(text) << text.error().text();
  EXPECT_NE(text->find(" 21001.00000000 "), std::string::npos) << *text;
}

// CelesTrak's FAQ: years 57-99 are of 1957-1999, 00-56 of 2000-2056. The mean motion has 11
// columns, eight of them behind the point; an exponent has one digit.
TEST(Elements, ATleIsNotWrittenWhereItWouldBeReadAsAnotherOrbit) {
  const ElementSet good = read_sample("omm.kvn")[0];
  const auto refusal = [&good](const auto &change) {
    ElementSet set = good;
    change(set);
    Diagnostics said;
    const auto text = write_elements({set}, ElementsForm::Tle, good.epoch, said);
    return text ? "" : text.error().message;
  };
  EXPECT_EQ(refusal([](ElementSet &set) {
              set.epoch_year = 2056;
              set.epoch = utc_from_year_day(2056, set.epoch_day_of_year);
            }),
            "");
  EXPECT_NE(refusal([](ElementSet &set) { set.epoch_year = 2057; }).find("is in 2057; the two"),
            std::string::npos);
  EXPECT_NE(refusal([](ElementSet &set) { set.epoch_year = 1956; }).find("1957 to 2056"),
            std::string::npos);
  // 59.9999 s of the last minute of 2056 are the first day of 2057 in eight decimals.
  EXPECT_NE(refusal([](ElementSet &set) {
              set.epoch_year = 2056;
              set.epoch_day_of_year = 367 - 1e-4 / 86400;
            }).find("is in 2057; the two"),
            std::string::npos);
  EXPECT_NE(refusal([](ElementSet &set) {
              set.mean_motion = 100 * 2 * pi / 1440;
            }).find("is 100 rev/d; a TLE holds 1e-8 to below 100"),
            std::string::npos);
  EXPECT_NE(refusal([](ElementSet &set) { set.bstar = -1e12; }).find("B* of"), std::string::npos);
  EXPECT_NE(refusal([](ElementSet &set) { set.mean_motion_ddot = 1e9; }).find("Write OMM instead"),
            std::string::npos);
}

// IERS Bulletin C 52: UTC had 2016-12-31T23:59:60, and clocks that know no leap seconds read the
// second after it the same. A TLE's last digit is 0.9 ms.
TEST(Elements, ATleIsNotWrittenAtALeapSecond) {
  const ElementSet good = read_sample("omm.kvn")[0];
  const auto written_at = [&good](const char *time, int year, double day) {
    ElementSet set = good;
    set.epoch = *utc_from_iso(time);
    set.epoch_year = year;
    set.epoch_day_of_year = day;
    Diagnostics said;
    const auto text = write_elements({set}, ElementsForm::Tle, good.epoch, said);
    return text ? *text : text.error().message;
  };
  EXPECT_NE(written_at("2016-12-31T23:59:60Z", 2016, 367).find("23:59:60.000Z, at a leap second"),
            std::string::npos);
  EXPECT_NE(written_at("2015-06-30T23:59:60.5Z", 2015, 182 + 0.5 / 86400).find("at a leap second"),
            std::string::npos);
  // 0.1 ms before it, which eight decimals round up.
  EXPECT_NE(written_at("2016-12-31T23:59:59.9999Z", 2016, 367 - 1e-4 / 86400).find("leap second"),
            std::string::npos);
  EXPECT_NE(written_at("2016-12-31T23:59:59Z", 2016, 367 - 1.0 / 86400).find(" 16366.99998843 "),
            std::string::npos);
  EXPECT_NE(written_at("2017-01-01T00:00:00Z", 2017, 1).find(" 17001.00000000 "),
            std::string::npos);
}

// A Latin-1 byte and an escape sequence: a warning, and every form can be written.
TEST(Elements, NamesThatAreNotPrintableAreReplacedWithAWarning) {
  std::string text = *read_file(folder + "omm.kvn");
  const std::string name = "ISS (ZARYA)";
  text.replace(text.find(name), name.size(), "CAF\xE9 \x1B[31m");
  Diagnostics said;
  const auto sets = read_elements(text, "sets", {}, said);
  ASSERT_TRUE(sets) << sets.error().text();
  EXPECT_EQ(sets->front().name, "CAF? ?[31m");
  ASSERT_EQ(said.warnings().size(), 1u);
  EXPECT_NE(said.warnings()[0].text().find("OBJECT_NAME holds bytes"), std::string::npos);
  for (const ElementsForm form : all_forms)
    EXPECT_EQ(read_text(*write_elements(*sets, form, sets->front().epoch, said))->front().name,
              sets->front().name);
  // A set that a program made: the writer must not throw either.
  ElementSet set = sets->front();
  set.name = "CAF\xE9";
  EXPECT_TRUE(write_elements({set}, ElementsForm::OmmJson, set.epoch, said));
}

TEST(Elements, NamesWithEverySignSurvive) {
  ElementSet set = read_sample("omm.kvn")[0];
  set.name = "A<B> & \"C\", D";
  Diagnostics said;
  for (const ElementsForm form : all_forms)
    EXPECT_EQ(read_text(*write_elements({set}, form, set.epoch, said))->front().name, set.name);
}

} // namespace
} // namespace umov
