#include <cmath>
#include <gtest/gtest.h>
#include <umov/io/observations_file.h>
#include <umov/io/table.h>

namespace umov {
namespace {

Result<ObservationsFile> read(const std::string &text) {
  Diagnostics diagnostics;
  return read_observations_text(text, "obs.csv", diagnostics);
}

constexpr const char *stokes_head = "# pol_frame: altaz\ntime_utc,band,I,I_err,q,u,q_err,u_err\n";

TEST(Observations, OfOurOwnTablesAreReadBack) {
  Table table;
  table.add("time_utc", "", "", std::vector<std::string>{"2018-01-21T05:10:00Z"});
  table.add("band", "", "", std::vector<std::string>{"Bessell.V"});
  table.add("I_obs", "W / (m2 nm)", "", std::vector<double>{1.5e-12});
  table.add("I_err", "W / (m2 nm)", "", std::vector<double>{1e-14});
  table.add("q", "%", "", std::vector<double>{3.0});
  table.add("u", "%", "", std::vector<double>{-1.0});
  table.add("cov_qq", "", "", std::vector<double>{4.0});
  table.add("cov_uu", "", "", std::vector<double>{9.0});
  table.add("cov_qu", "", "", std::vector<double>{-1.0});
  table.note("pol_frame", "equatorial");
  for (const std::string &text : {to_ecsv(table), [&] {
                                    std::string csv = csv_header(table);
                                    append_csv_rows(table, 0, 1, csv);
                                    return csv;
                                  }()}) {
    const auto file = read(text);
    ASSERT_TRUE(file) << file.error().text();
    ASSERT_EQ(file->rows.size(), 1u);
    const ObservedRow &row = file->rows.front();
    EXPECT_EQ(row.band, "Bessell.V");
    EXPECT_TRUE(file->is_absolute);
    EXPECT_EQ(file->frame, PolarizationFrame::Equatorial);
    EXPECT_DOUBLE_EQ(row.flux, 1.5e-12);
    EXPECT_DOUBLE_EQ(row.q, 0.03); // per cent by the header
    EXPECT_DOUBLE_EQ(row.u, -0.01);
    EXPECT_DOUBLE_EQ(row.cov_uu, 9e-4);
    EXPECT_DOUBLE_EQ(row.cov_qu, -1e-4);
  }
}

TEST(Observations, PerCentIsTakenAsFitsHasIt) {
  Table table;
  table.add("time_utc", "", "", std::vector<std::string>{"2018-01-21T05:10:00Z"});
  table.add("q", "10**-2", "", std::vector<double>{3.0});
  table.add("u", "10**-2", "", std::vector<double>{-1.0});
  table.note("pol_frame", "equatorial");
  const auto file = read(to_ecsv(table));
  ASSERT_TRUE(file) << file.error().text();
  EXPECT_DOUBLE_EQ(file->rows.front().q, 0.03);
}

TEST(Observations, GapsAreNotMeasured) {
  const auto file = read(std::string(stokes_head) + "2018-01-21T05:10:00Z,V,2,0.1,,,,\n"
                                                    "2018-01-21T05:10:10Z,V,,,0.1,0.2,0.01,0.01\n"
                                                    "2018-01-21T05:10:20Z,V,,nan,,,,\n");
  ASSERT_TRUE(file) << file.error().text();
  ASSERT_EQ(file->rows.size(), 2u); // the last says nothing
  EXPECT_TRUE(std::isnan(file->rows[0].q));
  EXPECT_TRUE(std::isnan(file->rows[1].flux));
  EXPECT_DOUBLE_EQ(file->rows[1].cov_qq, 1e-4);
}

TEST(Observations, RowsAreInOrderOfTime) {
  const auto file = read("mjd_utc,band,mag\n58139.5,V,7\n58139.25,V,6\n");
  ASSERT_TRUE(file) << file.error().text();
  EXPECT_DOUBLE_EQ(file->rows.front().mag, 6);
  EXPECT_EQ(to_iso(file->rows.front().time), "2018-01-21T06:00:00.000Z"); // 0.25 d
}

TEST(Observations, ModifiedJulianDatesAreTakenInCapitals) {
  const auto file = read("MJD,mag\n58139.25,7\n");
  ASSERT_TRUE(file) << file.error().text();
  EXPECT_EQ(to_iso(file->rows.front().time), "2018-01-21T06:00:00.000Z");
}

TEST(Observations, EveryFaultHasItsPlace) {
  struct Case {
    std::string text, message;
  };
  const std::string h = stokes_head;
  const std::string t = "2018-01-21T05:10:00Z";
  for (const Case &c : {
           Case{"", "obs.csv: no row of observations"},
           Case{"band,I\nV,1\n", "obs.csv:1: no column of time"},
           Case{"# a note\n\nband,I\nV,1\n", "obs.csv:3: no column of time"},
           Case{"time_utc;mag\n" + t + ";1,5\n",
                "obs.csv:1: the names of the columns are parted by semicolons"},
           Case{"58139.5,7.1,V\n58139.6,7.2,V\n", "obs.csv:1: numbers where the names"},
           Case{"JD,mag\n2458139.5,7\n",
                "obs.csv:1: no column of time: \"time_utc\" (ISO 8601 with Z) or \"mjd_utc\" (a "
                "Julian "
                "date in UTC less 2400000.5) was expected in the line of names; there are JD, mag. "
                "Name yours so when it holds that: take 2400000.5 off Julian dates, and 69.184 s "
                "(since 2017) off TT"},
           Case{"time_utc,band\n" + t + ",V\n", "obs.csv:1: nothing measured"},
           Case{"time_utc,q\n" + t + ",1\n", "obs.csv:1: nothing measured"},
           Case{"time_utc,I,q\n" + t + ",1,0.1\n", "obs.csv:1: q and u go together"},
           Case{"time_utc,I,q,u\n" + t + ",1,0.1,0\n", "obs.csv: pol_frame of the header is \"\""},
           Case{h + t + ",V,bright,0.1,,,,\n", "obs.csv:3:24: I = \"bright\": a number"},
           Case{h + t + ",V,1,-0.1,,,,\n", "obs.csv:3:26: I_err = -0.1: an error is 0 or more"},
           Case{h + "2018-01-21T05:10:00,V,1,,,,,\n", "obs.csv:3:1: "},
           Case{h + t + ",V,1,,,,,\n" + t + ",V,2,,,,,\n", "obs.csv:4: a second row for"},
           Case{h + t + ",V,1\n", "obs.csv:3: 3 cells in a table of 8"},
           Case{h + t + ",V,,,,,,\n", "obs.csv: no row holds a measurement"},
           Case{"mjd_utc,I\n2458139.5,1\n", "obs.csv:2:1: mjd_utc = \"2458139.5\""},
           Case{"time_utc,name,I\n" + t + ",a,1\n" + t + ",b,1\n",
                "obs.csv:3:22: a row of \"b\" after rows of \"a\""},
           Case{"# pol_frame: altaz\ntime_utc,q,u,cov_qq,cov_uu,cov_qu\n" + t + ",0,0,1,1,2\n",
                "obs.csv:3:30: cov_qu = 2 is larger"},
       }) {
    const auto file = read(c.text);
    ASSERT_FALSE(file) << c.text;
    EXPECT_TRUE(file.error().text().starts_with(c.message)) << file.error().text();
    EXPECT_EQ(file.error().code, ErrorCode::BadInput);
  }
}

TEST(Observations, ValuesThatAreHardlyMeasuredAreToldOf) {
  const std::string t = "2018-01-21T05:10:0";
  Diagnostics diagnostics;
  const auto file =
      read_observations_text(std::string(stokes_head) + t + "0Z,V,1,.1,1.04,0,.01,.01\n" + t +
                                 "1Z,V,1,.1,0,-1.06,.01,.01\n" + t + "2Z,V,1,.1,1.06,0,,\n" + t +
                                 "3Z,V,1,0,.1,0,.01,.01\n",
                             "obs.csv", diagnostics);
  ASSERT_TRUE(file) << file.error().text();
  ASSERT_EQ(diagnostics.warnings().size(), 3u);
  const auto begins = [&](std::size_t k, const char *words) {
    const std::string told = diagnostics.warnings()[k].text();
    return told.starts_with(words) ? "" : told;
  };
  EXPECT_EQ(begins(0, "obs.csv:4: 1 row with |q| or |u| above 1 by more than five"), "");
  EXPECT_EQ(begins(1, "obs.csv:5: 1 row with |q| or |u| above 1.01 and no error"), "");
  EXPECT_EQ(begins(2, "obs.csv:6: 1 row with an error of 0"), "");
}

TEST(Observations, SaturatedRowsAreLeftOutWithAWarning) {
  Diagnostics diagnostics;
  const auto file = read_observations_text("time_utc,I,flags\n2018-01-21T05:10:00Z,1,saturated\n"
                                           "2018-01-21T05:10:01Z,1,\n",
                                           "obs.csv", diagnostics);
  ASSERT_TRUE(file) << file.error().text();
  EXPECT_EQ(file->rows.size(), 1u);
  ASSERT_EQ(diagnostics.warnings().size(), 1u);
  EXPECT_NE(diagnostics.warnings()[0].message.find("1 row flagged as saturated"),
            std::string::npos);
}

} // namespace
} // namespace umov
