// CCSDS messages: every sample read (tests/data/ccsds/README.md), the two forms of one message
// against each other, and written and read again without a character lost.

#include <umov/io/ccsds.h>

#include <algorithm>
#include <filesystem>
#include <gtest/gtest.h>
#include <umov/core/files.h>

namespace umov::ccsds {
namespace {

const std::string folder = UMOV_SOURCE_DIR "/tests/data/ccsds/";

Message read(const std::string &text) {
  Diagnostics diagnostics;
  auto message = read_message(text, "m", diagnostics);
  EXPECT_TRUE(message) << message.error().text();
  return message ? *message : Message{};
}
std::string refusal(const std::string &text) {
  Diagnostics diagnostics;
  const auto message = read_message(text, "m", diagnostics);
  return message ? std::string() : message.error().text();
}

void expect_same(const std::vector<Field> &a, const std::vector<Field> &b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t k = 0; k < a.size(); ++k) {
    EXPECT_EQ(a[k].key, b[k].key);
    EXPECT_EQ(a[k].text, b[k].text) << a[k].key;
    EXPECT_EQ(a[k].unit, b[k].unit) << a[k].key;
  }
}
void expect_same(const Message &a, const Message &b) {
  EXPECT_EQ(a.kind, b.kind);
  EXPECT_EQ(a.version, b.version);
  expect_same(a.header, b.header);
  ASSERT_EQ(a.segments.size(), b.segments.size());
  for (std::size_t s = 0; s < a.segments.size(); ++s) {
    expect_same(a.segments[s].metadata, b.segments[s].metadata);
    ASSERT_EQ(a.segments[s].data.size(), b.segments[s].data.size());
    for (std::size_t r = 0; r < a.segments[s].data.size(); ++r) {
      EXPECT_EQ(a.segments[s].data[r].name, b.segments[s].data[r].name);
      expect_same(a.segments[s].data[r].fields, b.segments[s].data[r].fields);
    }
  }
}

std::vector<std::string> samples() {
  std::vector<std::string> out;
  for (const auto &entry : std::filesystem::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (is_message(*read_file(entry.path().string())))
      out.push_back(name);
  }
  std::sort(out.begin(), out.end());
  return out;
}

TEST(CcsdsMessages, EverySampleComesBackFromBothForms) {
  const auto names = samples();
  EXPECT_EQ(names.size(), 33u); // 9 OPM, 6 OEM and one TDM in both forms, one OEM without indents
  for (const std::string &name : names) {
    SCOPED_TRACE(name);
    const Message first = read(*read_file(folder + name));
    for (const Form form : {Form::Kvn, Form::Xml}) {
      const auto text = write_message(first, form);
      ASSERT_TRUE(text) << text.error().text();
      expect_same(first, read(*text));
      EXPECT_EQ(*write_message(read(*text), form), *text);
    }
  }
}

TEST(CcsdsMessages, BothFormsOfOneMessageSayTheSame) {
  // The pairs differ in date and, in OPM, in digits: the states are compared.
  for (const char *name : {"oem", "oem_cov", "oem_cov_qsw", "oem_double", "oem_interplanetary",
                           "oem_minimal", "tdm"}) {
    SCOPED_TRACE(name);
    const Message kvn = read(*read_file(folder + name + ".kvn")),
                  xml = read(*read_file(folder + name + ".xml"));
    ASSERT_EQ(kvn.segments.size(), xml.segments.size());
    for (std::size_t s = 0; s < kvn.segments.size(); ++s) {
      ASSERT_EQ(kvn.segments[s].data.size(), xml.segments[s].data.size());
      for (std::size_t r = 0; r < kvn.segments[s].data.size(); ++r)
        expect_same(kvn.segments[s].data[r].fields, xml.segments[s].data[r].fields);
    }
  }
}

TEST(CcsdsMessages, UnitsOfXmlDataLinesAreTheStandardOnes) {
  Message m = read(*read_file(folder + "oem_minimal.kvn"));
  m.segments[0].data[3].fields[1].unit = "m";
  EXPECT_NE(write_message(m, Form::Kvn).error().message.find("X is in m"), std::string::npos);
  const auto xml = write_message(m, Form::Xml);
  ASSERT_TRUE(xml);
  EXPECT_EQ(read(*xml).segments[0].data[3].fields[1].unit, "m");
  EXPECT_EQ(read(*xml).segments[0].data[3].fields[2].unit, ""); // km, as always
}

// Attitude messages in the form of 504.0-B; the values are made up.
constexpr const char *aem_head = "CCSDS_AEM_VERS = 1.0\n"
                                 "CREATION_DATE = 2018-01-20T00:00:00\nORIGINATOR = UMOV\n"
                                 "META_START\nOBJECT_NAME = A\nOBJECT_ID = 2018-001A\n"
                                 "REF_FRAME_A = EME2000\nREF_FRAME_B = SC_BODY_1\n"
                                 "ATTITUDE_DIR = A2B\nTIME_SYSTEM = UTC\n"
                                 "START_TIME = 2018-01-21T00:00:00\n"
                                 "STOP_TIME = 2018-01-21T00:01:00\n";

TEST(CcsdsMessages, EveryTypeOfAttitude) {
  const std::pair<const char *, const char *> types[] = {
      {"QUATERNION", "0.5 0.5 0.5 0.5"},
      {"QUATERNION/DERIVATIVE", "0.5 0.5 0.5 0.5 1e-3 0 0 0"},
      {"QUATERNION/RATE", "0.5 0.5 0.5 0.5 1 2 3"},
      {"QUATERNION/ANGVEL", "0.5 0.5 0.5 0.5 1 2 3"},
      {"EULER_ANGLE", "10 20 30"},
      {"EULER_ANGLE/RATE", "10 20 30 1 2 3"},
      {"SPIN", "268.6 68.4 159.7 -110.0"},
      {"SPIN/NUTATION", "268.6 68.4 159.7 -110.0 2.0 13.5 40"}};
  for (const auto &[type, values] : types)
    for (const char *order : {"", "QUATERNION_TYPE = FIRST\n"}) {
      SCOPED_TRACE(type);
      const Message first = read(std::string(aem_head) + "ATTITUDE_TYPE = " + type + "\n" + order +
                                 "META_STOP\nDATA_START\nCOMMENT one\n2018-01-21T00:00:00 " +
                                 values + "\n2018-01-21T00:01:00 " + values + "\nDATA_STOP\n");
      for (const Form form : {Form::Kvn, Form::Xml}) {
        const Message again = read(*write_message(first, form));
        ASSERT_EQ(again.segments[0].data.size(), 2u);
        for (const Field &field : first.segments[0].data[0].fields)
          EXPECT_EQ(find(again.segments[0].data[0].fields, field.key)->text, field.text);
        EXPECT_EQ(*write_message(again, Form::Kvn), *write_message(first, Form::Kvn));
      }
    }
}

std::string replaced(std::string text, const std::string &from, const std::string &to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

TEST(CcsdsMessages, RefusesWithPlaceAndKeyword) {
  const std::string oem = *read_file(folder + "oem.kvn"), opm = *read_file(folder + "opm.kvn"),
                    xml = *read_file(folder + "oem.xml"), opm_xml = *read_file(folder + "opm.xml");
  const std::tuple<std::string, const char *> cases[] = {
      {replaced(oem, "REF_FRAME            = TEME\n", ""), "no REF_FRAME"},
      {replaced(oem, "META_STOP", "META_STOP\nFOO = 1"), "m:16: FOO"},
      {replaced(oem, " -993.632000", ""), "a data line has 6 entries"},
      {replaced(oem, "-993.632000", "nan"), "Y is \"nan\", expected a finite number"},
      {replaced(oem, "-993.632000", "1e400"), "Y is \"1e400\""},
      {replaced(oem, "CCSDS_OEM_VERS", "CCSDS_XYZ_VERS"), "m:1: \"CCSDS_XYZ_VERS\""},
      {replaced(oem, "META_STOP\n", ""), "has no '='"},
      {replaced(opm, "X                    =", "X_                   ="), "is no keyword"},
      {replaced(opm, "Y_DOT ", "Z_DOT "), "Z_DOT stands twice"},
      {replaced(opm, "Y_DOT                =     7.255240 [km/s]\n", ""), "has no Y_DOT"},
      {replaced(xml, "<oem", "<!DOCTYPE oem [<!ENTITY a \"b\">]><oem"), "document type"},
      {xml.substr(0, xml.size() / 2), "is no XML"},
      {replaced(opm_xml, "<Y_DOT units=\"km/s\"", "<Y_DOT units=\"km/[\""),
       "the unit of Y_DOT is \"km/[\""},
      {"CCSDS_OEM_VERS = 2.0\n", "holds no segment"},
      {"", "holds no CCSDS message"},
  };
  for (const auto &[text, expected] : cases) {
    const std::string message = refusal(text);
    EXPECT_NE(message.find(expected), std::string::npos) << expected << ": " << message;
  }
}

std::string without(std::string text, const std::string &line) { return replaced(text, line, ""); }

TEST(CcsdsMessages, RefusesPartsThatDoNotStandWhereTheyBelong) {
  const std::string oem = *read_file(folder + "oem.kvn"),
                    covariances = *read_file(folder + "oem_cov.kvn"),
                    opm = *read_file(folder + "opm.kvn");
  const std::string row = "2018-01-20T00:00:00 1 2 3 4 5 6\n";
  const std::tuple<std::string, const char *> cases[] = {
      {"CCSDS_OEM_VERS = 2.0\nMETA_STOP\n" + row, "m:2: META_STOP was found, META_START"},
      {"CCSDS_OEM_VERS = 2.0\nDATA_START\n" + row, "m:2: DATA_START was found, META_START"},
      {"CCSDS_AEM_VERS = 1.0\nMETA_STOP\n" + row, "m:2: META_STOP was found"},
      {"CCSDS_AEM_VERS = 1.0\nDATA_START\n" + row, "m:2: DATA_START was found"},
      {"CCSDS_OEM_VERS = 2.0\nDATA_STOP\n", "m:2: DATA_STOP was found"},
      {"CCSDS_OEM_VERS = 2.0\nCOVARIANCE_START\nEPOCH = 2018-01-20T00:00:00\n1\nCOVARIANCE_STOP\n",
       "m:2: COVARIANCE_START was found, META_START and META_STOP"},
      {replaced(oem, "META_START\n", "META_START\nMETA_START\n"), "META_START was found"},
      {replaced(oem, "META_STOP\n", "META_STOP\nMETA_STOP\n"), "META_STOP was found"},
      {without(covariances, "COVARIANCE_START\n"), "stands among the data lines"},
      {replaced(covariances, "COVARIANCE_STOP\n", "META_START\n"),
       "COVARIANCE_STOP of what stands"},
      {replaced(opm, "X_DOT ", "COVARIANCE_START\nX_DOT "), "COVARIANCE_START was found"},
  };
  for (const auto &[text, expected] : cases) {
    const std::string message = refusal(text);
    EXPECT_NE(message.find(expected), std::string::npos) << expected << ": " << message;
  }
}

TEST(CcsdsMessages, RefusesCovariancesOfAnotherShape) {
  const std::string head = "CCSDS_OEM_VERS = 2.0\nMETA_START\nMETA_STOP\nCOVARIANCE_START\n";
  const std::string epoch = "EPOCH = 2018-01-20T00:00:00\n";
  const std::string rows = "1\n1 2\n1 2 3\n1 2 3 4\n1 2 3 4 5\n1 2 3 4 5 6\n";
  const std::tuple<std::string, const char *> cases[] = {
      // Two keywords that begin with C would move every row by two elements, past the last one.
      {head + epoch + "CA = 1\nCB = 1\n" + rows.substr(2), "m:6: \"CA\" was found in a block of"},
      {head + epoch + rows + "1\n", "m:12: a covariance matrix has more than 6 rows"},
      {head + epoch + "1\n1 2 3\n", "m:7: row 2 of a covariance matrix has 3 numbers, expected 2"},
      {head + rows, "m:5: a row of a covariance matrix stands before its EPOCH"},
      {head + "COV_REF_FRAME = RTN\n", "m:5: COV_REF_FRAME stands before the EPOCH"},
  };
  for (const auto &[text, expected] : cases) {
    const std::string message = refusal(text);
    EXPECT_NE(message.find(expected), std::string::npos) << expected << ": " << message;
  }
}

TEST(CcsdsMessages, RefusesRecordsThatTheKindDoesNotHave) {
  const std::string oem = *read_file(folder + "oem.xml"), tdm = *read_file(folder + "tdm.xml"),
                    opm = *read_file(folder + "opm.xml");
  const std::tuple<std::string, const char *> cases[] = {
      {replaced(tdm, "<EPOCH>2008-09-20T18:16:03.690790</EPOCH>", ""),
       "an observation has no EPOCH"},
      {replaced(tdm, "<RANGE>4304.325558</RANGE>", ""), "an observation has an EPOCH and no value"},
      {replaced(tdm, "4304.325558", ""), "RANGE of an observation is empty"},
      {replaced(tdm, "2008-09-20T18:16:03.690790</EPOCH>", "2008-09-20 18:16</EPOCH>"), "blanks"},
      {replaced(oem, "<data>", "<data><extra><X>1</X></extra>"),
       "<extra> was found among the data"},
      {replaced(oem, "<data>", "<data><comment><X>1</X></comment>"),
       "\"X\" is no keyword of a comment"},
      {replaced(oem, "<stateVector>", "<stateVector><X_DDOT>1</X_DDOT>"), "has no Y_DDOT"},
      {replaced(oem, "<stateVector>", "<stateVector><MASS>1</MASS>"), "\"MASS\" is no keyword"},
      {replaced(opm, "<stateVector>", "<stateVector><MASS>1</MASS>"), "\"MASS\" is no keyword"},
  };
  for (const auto &[text, expected] : cases) {
    const std::string message = refusal(text);
    EXPECT_NE(message.find(expected), std::string::npos) << expected << ": " << message;
  }
  const std::string aem =
      *write_message(read(std::string(aem_head) + "ATTITUDE_TYPE = EULER_ANGLE\nMETA_STOP\n"
                                                  "DATA_START\n2018-01-21T00:00:00 1 2 3\n"
                                                  "2018-01-21T00:01:00 1 2 3\nDATA_STOP\n"),
                     Form::Xml);
  EXPECT_NE(refusal(replaced(aem, "<data>", "<data><extra><X>1</X></extra>"))
                .find("<extra> was found among the data, where an AEM"),
            std::string::npos);
}

// Messages made by hand may lack anything: an error, no crash.
TEST(CcsdsMessages, WritersNameWhatIsMissing) {
  const Record empty{"stateVector", {{"X", "1", "", 0}}, 7};
  for (const Kind kind : {Kind::Oem, Kind::Aem, Kind::Tdm}) {
    Message message;
    message.kind = kind;
    message.file = "m";
    message.segments.push_back({{}, {empty}});
    const auto text = write_message(message, Form::Kvn);
    ASSERT_FALSE(text);
    EXPECT_NE(text.error().message.find(kind == Kind::Aem ? "no ATTITUDE_TYPE" : "has no EPOCH"),
              std::string::npos)
        << text.error().text();
  }
  Message message;
  message.kind = Kind::Aem;
  message.segments.push_back({{{"ATTITUDE_TYPE", "QUATERNION", "", 0}}, {empty}});
  for (const Form form : {Form::Kvn, Form::Xml})
    EXPECT_FALSE(write_message(message, form));
  message.kind = Kind::Oem;
  message.segments[0].data[0] = {"covarianceMatrix", {{"EPOCH", "2018-01-20T00:00:00", "", 0}}, 0};
  EXPECT_NE(write_message(message, Form::Kvn).error().message.find("has no CX_X"),
            std::string::npos);
}

/// Refused, or written in both forms and read again.
void expect_whole(const std::string &text) {
  Diagnostics diagnostics;
  const auto message = read_message(text, "m", diagnostics);
  if (!message)
    return;
  for (const Form form : {Form::Kvn, Form::Xml})
    if (const auto written = write_message(*message, form)) {
      const auto again = read_message(*written, "w", diagnostics);
      EXPECT_TRUE(again) << again.error().text() << "\n" << text.substr(0, 2000);
    }
}

// A text of XML must not become another line of KVN, nor a keyword of KVN an element of XML.
TEST(CcsdsMessages, TextsAndKeywordsStayWhatTheyAre) {
  const std::string xml = *read_file(folder + "oem.xml"), kvn = *read_file(folder + "oem.kvn");
  const std::string broken = replaced(xml, "ISS (ZARYA)", "ISS\nCENTER_NAME = MARS &#27;[31m");
  Diagnostics diagnostics;
  const auto message = read_message(broken, "m", diagnostics);
  ASSERT_TRUE(message) << message.error().text();
  EXPECT_EQ(find(message->segments[0].metadata, "OBJECT_NAME")->text,
            "ISS CENTER_NAME = MARS ?[31m");
  EXPECT_EQ(diagnostics.warnings().size(), 1u);
  EXPECT_EQ(
      find(read(*write_message(*message, Form::Kvn)).segments[0].metadata, "CENTER_NAME")->text,
      "EARTH");
  EXPECT_NE(refusal(replaced(kvn, "META_STOP", "A><evil/><B = 1\nMETA_STOP")).find("is no keyword"),
            std::string::npos);
}

// What happens to files on their way: a line is lost, doubled or changes places with the next.
TEST(CcsdsMessages, LinesLostDoubledOrExchangedNeverCrash) {
  for (const std::string &name : samples()) {
    SCOPED_TRACE(name);
    const std::string text = *read_file(folder + name);
    std::vector<std::string> lines;
    for (std::size_t begin = 0; begin < text.size();) {
      const std::size_t end = std::min(text.find('\n', begin), text.size() - 1) + 1;
      lines.push_back(text.substr(begin, end - begin));
      begin = end;
    }
    // The first 60 lines have every part of a message; after them the same kind of line repeats.
    for (std::size_t k = 0; k < std::min<std::size_t>(lines.size(), 60); ++k)
      for (const int change : {0, 1, 2}) {
        std::vector<std::string> list = lines;
        const auto at = list.begin() + static_cast<std::ptrdiff_t>(k);
        if (change == 0)
          list.erase(at);
        else if (change == 1)
          list.insert(at, lines[k]);
        else if (k + 1 < list.size())
          std::iter_swap(at, at + 1);
        std::string changed;
        for (const std::string &line : list)
          changed += line;
        expect_whole(changed);
      }
  }
}

TEST(CcsdsMessages, EpochsOfXmlAreDates) { // in KVN the second line would be a comment, and lost
  const std::string state =
      "<X>7000</X><Y>0</Y><Z>0</Z><X_DOT>0</X_DOT><Y_DOT>7.5</Y_DOT><Z_DOT>0</Z_DOT>";
  const auto message = [&](const std::string &epoch) {
    return "<oem id=\"CCSDS_OEM_VERS\" version=\"2.0\"><header><CREATION_DATE>2018-01-21T00:00:00"
           "</CREATION_DATE><ORIGINATOR>u</ORIGINATOR></header><body><segment><metadata>"
           "<OBJECT_NAME>A</OBJECT_NAME><OBJECT_ID>2018-001A</OBJECT_ID><CENTER_NAME>EARTH</"
           "CENTER_NAME>"
           "<REF_FRAME>GCRF</REF_FRAME><TIME_SYSTEM>UTC</"
           "TIME_SYSTEM><START_TIME>2018-01-20T00:00:00"
           "</START_TIME><STOP_TIME>2018-01-20T00:01:00</STOP_TIME></"
           "metadata><data><stateVector><EPOCH>" +
           epoch + "</EPOCH>" + state + "</stateVector></data></segment></body></oem>";
  };
  EXPECT_EQ(refusal(message("2018-020T00:00:00.5Z")), "");
  for (const char *epoch : {"COMMENT2018-01-20T00:00:00", "META_STOP", "2018-01-20 00:00:00", ""})
    EXPECT_NE(refusal(message(epoch)), "") << epoch;
}

} // namespace
} // namespace umov::ccsds
