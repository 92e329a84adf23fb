// Light without an orbit: block by block, wherever the rows go.

#include <umov/jobs/signature.h>

#include "jobs/tests/white_sphere.h"

#include <atomic>
#include <umov/jobs/pose_light.h>

namespace umov::jobs {
namespace {

/// Rows kept in memory.
class MemorySink : public TableSink {
public:
  Result<void> add(Table &&rows) override {
    blocks += 1;
    table.append(std::move(rows));
    return {};
  }
  Result<void> note(const std::string &key, const std::string &value) override {
    table.note(key, value);
    return {};
  }
  Result<void> finish() override {
    is_finished = true;
    return {};
  }
  Error stop(const Error &stopped) override { return stopped; }
  Table table;
  std::size_t blocks = 0;
  bool is_finished = false;
};

class SignatureJob : public test::WhiteSphere {
protected:
  Diagnostics diagnostics;
};

TEST_F(SignatureJob, RandomPosesOfASphereHaveOneLight) {
  const auto poses = random_poses(5, {30, 60, 120}, 1);
  ASSERT_TRUE(poses);
  ASSERT_EQ(poses->count, 15u);
  MemorySink sink;
  const auto done = signature(scenario(), *poses, {}, sink, {}, {}, diagnostics);
  ASSERT_TRUE(done) << done.error().text();
  EXPECT_TRUE(sink.is_finished);
  ASSERT_EQ(sink.table.rows(), 15u);
  for (std::size_t row = 0; row < 15; ++row) {
    const double phase = sink.table.number("phase_angle", row);
    EXPECT_NEAR(sink.table.number("intensity", row) /
                    test::white_sphere_intensity(phase * pi / 180),
                1, 3e-3)
        << phase; // 5000 facets
  }
}

TEST_F(SignatureJob, APoseIsTheSameWhateverElseIsAskedFor) {
  const auto few = random_poses(3, {60}, 9), many = random_poses(1000, {60}, 9);
  ASSERT_TRUE(few && many);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_EQ(few->at(k).sun.x, many->at(k).sun.x);
    EXPECT_EQ(few->at(k).observer.z, many->at(k).observer.z);
  }
  EXPECT_NE(random_poses(3, {60}, 10)->at(0).sun.x, few->at(0).sun.x);
}

TEST_F(SignatureJob, RowsAreThoseOfPoseLight) {
  const auto poses = random_poses(4, {45, 90}, 2);
  MemorySink sink;
  ASSERT_TRUE(signature(scenario(), *poses, {}, sink, {}, {}, diagnostics));
  const auto light = PoseLight::make(scenario(), {}, {}, diagnostics);
  ASSERT_TRUE(light) << light.error().text();
  std::vector<Pose> list;
  for (std::size_t k = 0; k < poses->count; ++k) {
    list.push_back(poses->at(k));
    list.back().sun_radius_rad = light->sun_radius_rad();
  }
  StokesTable stokes;
  ASSERT_TRUE(light->evaluate(list, stokes, {}));
  for (std::size_t k = 0; k < list.size(); ++k)
    EXPECT_EQ(sink.table.number("intensity", k), stokes.i[k]);
}

TEST_F(SignatureJob, ManyPosesAreAskedForLessUnlessSomebodySaysHowWell) {
  const auto accuracy = [&](const std::vector<std::string> &overrides,
                            const SignatureRequest &request) {
    const auto light = PoseLight::make(scenario(overrides), request, {}, diagnostics);
    EXPECT_TRUE(light) << light.error().text();
    return light ? light->options().accuracy : 0;
  };
  SignatureRequest asked, rays;
  asked.accuracy = 0.002;
  rays.method = LightMethod::Rays;
  EXPECT_EQ(accuracy({}, {}), 0.05);
  EXPECT_EQ(accuracy({"render.accuracy=0.005"}, {}), 0.005);
  EXPECT_EQ(accuracy({}, asked), 0.002);
  EXPECT_EQ(accuracy({}, rays), 0.005);
  EXPECT_EQ(accuracy({"render.bounces=3"}, {}), 0.005);
}

TEST_F(SignatureJob, AStopKeepsFinishedBlocksAndTheSameJobGoesOn) {
  const Scenario of = scenario({"render.method=masks"});
  const auto poses = random_poses(400'000, {60}, 4);
  MemorySink whole;
  ASSERT_TRUE(signature(of, *poses, {}, whole, {}, {}, diagnostics));
  ASSERT_GT(whole.blocks, 2u);
  std::atomic<bool> cancel{false};
  Monitor monitor;
  monitor.cancel = &cancel;
  monitor.progress = [&](const std::string &, std::size_t done, std::size_t total) {
    if (2 * done > total)
      cancel = true;
  };
  JobOptions options;
  options.journal = folder / "journal";
  MemorySink part;
  const auto stopped = signature(of, *poses, {}, part, options, monitor, diagnostics);
  ASSERT_FALSE(stopped);
  EXPECT_EQ(stopped.error().code, ErrorCode::Interrupted);
  EXPECT_FALSE(part.is_finished);
  EXPECT_LT(part.table.rows(), whole.table.rows());
  EXPECT_TRUE(std::filesystem::exists(options.journal));
  MemorySink rest;
  ASSERT_TRUE(signature(of, *poses, {}, rest, options, {}, diagnostics));
  ASSERT_EQ(rest.table.rows(), whole.table.rows());
  for (const std::size_t row : {std::size_t{0}, part.table.rows(), whole.table.rows() - 1000}) {
    std::string again, once;
    append_csv_rows(rest.table, row, row + 1000, again);
    append_csv_rows(whole.table, row, row + 1000, once);
    EXPECT_EQ(again, once);
  }
  EXPECT_FALSE(std::filesystem::exists(options.journal));
}

TEST_F(SignatureJob, RefusesWhatDoesNotGoTogether) {
  const auto poses = random_poses(1, {60}, 1);
  const auto code_of = [&](const SignatureRequest &request) {
    MemorySink sink;
    const auto done = signature(scenario(), *poses, request, sink, {}, {}, diagnostics);
    EXPECT_FALSE(done);
    EXPECT_EQ(sink.blocks, 0u);
    return done ? ErrorCode{} : done.error().code;
  };
  SignatureRequest laser;
  laser.source = SignatureRequest::Source::Laser;
  laser.method = LightMethod::Masks;
  EXPECT_EQ(code_of(laser), ErrorCode::Usage);
  SignatureRequest cold;
  cold.source = SignatureRequest::Source::Thermal;
  EXPECT_EQ(code_of(cold), ErrorCode::Usage);
  SignatureRequest overpolarized;
  overpolarized.source = SignatureRequest::Source::Laser;
  overpolarized.state = {1, 1, 1, 0};
  EXPECT_EQ(code_of(overpolarized), ErrorCode::Usage);
  EXPECT_EQ(random_poses(1, {181}, 1).error().code, ErrorCode::Usage);
}

} // namespace
} // namespace umov::jobs
