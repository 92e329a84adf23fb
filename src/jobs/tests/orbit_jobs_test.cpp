// Ephemerides, catalogues and passes as jobs: what the layers below say, and how they end.

#include <umov/jobs/ephemeris.h>
#include <umov/jobs/passes.h>

#include "jobs/tests/white_sphere.h"

#include <atomic>
#include <umov/jobs/brdf.h>
#include <umov/orbit/passes.h>

namespace umov::jobs {
namespace {

const std::string agena = UMOV_SOURCE_DIR "/data/tle/agena733.tle";
const std::string catalogue = UMOV_SOURCE_DIR "/tests/data/tle/mixed_979_2018-01-20.tle";
const std::string oem = UMOV_SOURCE_DIR "/tests/data/ccsds/oem.kvn";

Epoch<Utc> utc(const char *text) { return *utc_from_iso(text); }
Site maui() { return *make_site("Maui", 20.7083, -156.2578, 3058); }

TEST(EphemerisJob, RowsAreWhatIsObserved) {
  Diagnostics diagnostics;
  EphemerisRequest request;
  request.orbit = agena;
  request.site = maui();
  request.start = utc("2018-01-21T05:06:00Z");
  request.stop = utc("2018-01-21T05:16:00Z");
  const auto done = ephemeris(request, {}, {}, diagnostics);
  ASSERT_TRUE(done) << done.error().text();
  ASSERT_EQ(done->table.rows(), 11u);
  EXPECT_FALSE(done->is_partial);
  for (std::size_t row = 0; row < 11; ++row) {
    // Distance and altitude say the same as the positions: the law of cosines on the ITRS vectors.
    const Vec3<Itrs> at{done->table.number("itrs_x", row), done->table.number("itrs_y", row),
                        done->table.number("itrs_z", row)};
    EXPECT_NEAR(norm(at - itrs_position_km(request.site)), done->table.number("range", row), 1e-6);
    const Vec3<Teme> teme{done->table.number("teme_x", row), done->table.number("teme_y", row),
                          done->table.number("teme_z", row)};
    EXPECT_NEAR(norm(teme), norm(at), 1e-6); // a rotation
  }
}

TEST(EphemerisJob, AnOrbitThatEndsGivesTheRowsBefore) {
  Diagnostics diagnostics;
  EphemerisRequest request;
  request.orbit = oem; // until 14:25:40
  request.site = maui();
  request.start = utc("2008-09-20T14:20:00Z");
  request.stop = utc("2008-09-20T14:30:00Z");
  const auto done = ephemeris(request, {}, {}, diagnostics);
  ASSERT_TRUE(done) << done.error().text();
  EXPECT_TRUE(done->is_partial);
  EXPECT_EQ(done->table.rows(), 6u);
  ASSERT_TRUE(done->error);
  EXPECT_EQ(done->error->code, ErrorCode::Physics);
}

TEST(EphemerisJob, StopsWithWhatIsDone) {
  Diagnostics diagnostics;
  EphemerisRequest request;
  request.orbit = agena;
  request.site = maui();
  request.start = utc("2018-01-21T04:00:00Z");
  request.stop = utc("2018-01-21T05:00:00Z");
  request.step_s = 0.1;
  std::atomic<bool> cancel{false};
  Monitor monitor;
  monitor.cancel = &cancel;
  monitor.progress = [&cancel](const std::string &, std::size_t, std::size_t) { cancel = true; };
  const auto part = ephemeris(request, {}, monitor, diagnostics);
  ASSERT_TRUE(part) << part.error().text();
  ASSERT_TRUE(part->error);
  EXPECT_EQ(part->error->code, ErrorCode::Interrupted);
  const std::size_t rows = part->table.rows();
  ASSERT_GT(rows, 0u);
  ASSERT_LT(rows, 36'001u);
  const auto whole = ephemeris(request, {}, {}, diagnostics);
  ASSERT_TRUE(whole);
  ASSERT_EQ(whole->table.rows(), 36'001u);
  for (const char *name : {"az", "teme_z", "sunlit"})
    EXPECT_EQ(part->table.number(name, rows - 1), whole->table.number(name, rows - 1)) << name;
}

TEST(CatalogueJob, EveryObjectHasItsTimesInOrder) {
  Diagnostics diagnostics;
  StatesRequest request;
  request.orbit = catalogue;
  request.times = {utc("2018-01-21T00:00:00Z"), utc("2018-01-21T06:00:00Z")};
  const auto states = propagate_catalogue(request, {}, {}, diagnostics);
  ASSERT_TRUE(states) << states.error().text();
  const std::size_t objects = states->norad_cat_id.size();
  EXPECT_EQ(objects, 979u); // lines of the file, counted by its README
  ASSERT_EQ(states->states.size(), 2 * objects);
  const auto table = catalogue_states(request, {}, {}, diagnostics);
  ASSERT_TRUE(table);
  ASSERT_EQ(table->table.rows(), 2 * objects);
  for (const std::size_t row : {std::size_t{0}, objects, 2 * objects - 1}) {
    EXPECT_EQ(table->table.number("norad_cat_id", row), states->norad_cat_id[row / 2]);
    EXPECT_EQ(table->table.number("teme_x", row), states->states[row].position_km.x);
  }
}

TEST(CatalogueJob, StopsWithWhatIsDone) {
  Diagnostics diagnostics;
  StatesRequest request;
  request.orbit = catalogue;
  request.times = {utc("2018-01-21T00:00:00Z")};
  const std::atomic<bool> cancel{true};
  Monitor monitor;
  monitor.cancel = &cancel;
  const auto states = propagate_catalogue(request, {}, monitor, diagnostics);
  ASSERT_TRUE(states);
  EXPECT_TRUE(states->is_partial);
  ASSERT_TRUE(states->error);
  EXPECT_EQ(states->error->code, ErrorCode::Interrupted);
}

TEST(PassesJob, FindsWhatTheFinderFinds) {
  Diagnostics diagnostics;
  PassesRequest request;
  request.orbit = agena;
  request.site = maui();
  request.start = utc("2018-01-21T04:00:00Z");
  request.stop = utc("2018-01-21T17:00:00Z");
  const auto result = passes(request, {}, {}, diagnostics);
  ASSERT_TRUE(result) << result.error().text();
  ASSERT_EQ(result->orbits.size(), 1u);
  const auto direct =
      find_passes(result->orbits[0], request.site, request.start, request.stop, PassSearch{});
  ASSERT_TRUE(direct);
  ASSERT_EQ(result->found.size(), direct->passes.size());
  const Table table = passes_table(request, *result);
  ASSERT_EQ(table.rows(), direct->passes.size());
  for (std::size_t k = 0; k < direct->passes.size(); ++k) {
    EXPECT_EQ(seconds_between(result->found[k].pass.rise.time, direct->passes[k].rise.time), 0);
    EXPECT_EQ(result->found[k].object, 0u);
  }
}

TEST(PassesJob, AnObjectThatIsNotInTheFileIsNamed) {
  Diagnostics diagnostics;
  PassesRequest request;
  request.orbit = agena;
  request.norad = {99999};
  request.site = maui();
  request.start = utc("2018-01-21T04:00:00Z");
  request.stop = utc("2018-01-21T05:00:00Z");
  const auto result = passes(request, {}, {}, diagnostics);
  ASSERT_FALSE(result);
  EXPECT_NE(result.error().text().find("99999"), std::string::npos) << result.error().text();
}

TEST(PassesJob, AYearMistypedIsAQuestion) {
  Diagnostics diagnostics;
  PassesRequest request;
  request.orbit = agena;
  request.site = maui();
  request.start = utc("2018-01-21T04:00:00Z");
  request.stop = utc("2999-01-21T05:00:00Z");
  JobOptions options;
  options.allow_old_elements = true;
  const auto result = passes(request, options, {}, diagnostics);
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().code, ErrorCode::Usage);
  EXPECT_NE(result.error().text().find("981 years"), std::string::npos) << result.error().text();
}

TEST(BrdfJob, ALambertSurfaceIsItsReflectanceOverPi) {
  BrdfRequest request;
  request.material.name = "white";
  request.material.index.n = Tabulated{{}, {1.0}};
  request.material.body = BodyLobe{{{}, {0.8}}, false};
  for (const double theta : {0.0, 30.0, 75.0})
    request.rows.push_back({550, theta, 20, 40, 0});
  const auto table = brdf_table(request);
  ASSERT_TRUE(table) << table.error().text();
  for (std::size_t row = 0; row < table->rows(); ++row) {
    EXPECT_NEAR(table->number("m00", row), 0.8 / pi, 1e-12);
    EXPECT_NEAR(table->number("m10", row), 0, 1e-15);
  }
  request.rows.push_back({550, 95, 0, 0, 0});
  EXPECT_FALSE(brdf_table(request));
}

} // namespace
} // namespace umov::jobs
