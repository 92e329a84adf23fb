// The main job on an object whose light has a closed form.

#include <umov/jobs/run.h>

#include "jobs/tests/white_sphere.h"

#include <atomic>
#include <umov/optics/band.h>
#include <umov/photometry/radiometry.h>

namespace umov::jobs {
namespace {

class RunJob : public test::WhiteSphere {
protected:
  RunResult run(const Scenario &of, const JobOptions &options, const Monitor &monitor = {}) {
    auto objects = load_run(of, options, monitor, diagnostics);
    EXPECT_TRUE(objects) << objects.error().text();
    auto out = compute_run(std::move(*objects), of, options, monitor, diagnostics);
    EXPECT_TRUE(out) << out.error().text();
    return std::move(*out);
  }
  Diagnostics diagnostics;
};

TEST_F(RunJob, RowsOfALambertSphereFollowItsPhaseFunction) {
  const RunResult result = run(scenario(), {});
  EXPECT_FALSE(result.stopped);
  ASSERT_EQ(result.objects.size(), 1u);
  const Table table = run_tables(result).light_curve;
  ASSERT_GT(table.rows(), 20u);
  const PhotometricBand band =
      photometric_bands(*bands_from({"nm:550"}), MagnitudeSystem::AB)->front();
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const double phase = table.number("phase_angle", row);
    const double intensity = test::white_sphere_intensity(phase * pi / 180);
    // 5000 facets: 2e-3 of I (second order in their size).
    EXPECT_NEAR(table.number("intensity", row) / intensity, 1, 2e-3) << phase;
    EXPECT_NEAR(table.number("p", row), 0, 1e-9);
    const LightPath path{result.objects[0].outcome.curve.epochs[row].geometry.sun_distance_km,
                         table.number("range", row), table.number("sunlit", row)};
    EXPECT_NEAR(table.number("mag", row), observed_light(intensity, band, path).magnitude, 3e-3);
  }
}

TEST_F(RunJob, BytesDoNotDependOnThreads) {
  const auto text = [&](unsigned threads) {
    JobOptions options;
    options.threads = threads;
    return to_csv(run_tables(run(scenario(), options)).light_curve);
  };
  const std::string one = text(1);
  EXPECT_EQ(one, text(2));
  EXPECT_EQ(one, text(7));
}

TEST_F(RunJob, AStoppedRunKeepsItsRowsAndGoesOnToTheSameBytes) {
  const Scenario of = scenario({"time.step_s=0.5", "render.method=rays"});
  const std::string whole = to_csv(run_tables(run(of, {})).light_curve);
  JobOptions options;
  options.journal = folder / "journal";
  options.threads = 1;
  std::atomic<bool> cancel{false};
  Monitor monitor;
  monitor.cancel = &cancel;
  monitor.progress = [&](const std::string &, std::size_t done, std::size_t total) {
    if (2 * done > total)
      cancel = true;
  };
  {
    const RunResult part = run(of, options, monitor);
    ASSERT_TRUE(part.stopped);
    EXPECT_EQ(part.stopped->code, ErrorCode::Interrupted);
    const Table kept = run_tables(part).light_curve;
    ASSERT_GT(kept.rows(), 0u);
    // What is kept is the beginning of the whole.
    const std::string last = kept.text("time_utc", kept.rows() - 1);
    EXPECT_NE(whole.find(last), std::string::npos);
  }
  EXPECT_TRUE(std::filesystem::exists(options.journal));
  cancel = false;
  monitor.progress = {};
  EXPECT_EQ(to_csv(run_tables(run(of, options, monitor)).light_curve), whole);
}

TEST_F(RunJob, SaysWhenThereWouldBeRows) {
  // At noon of the site the sky is never dark.
  const Scenario of =
      scenario({"time.start=2018-01-21T22:00:00Z", "time.stop=2018-01-21T22:10:00Z"});
  auto objects = load_run(of, {}, {}, diagnostics);
  ASSERT_TRUE(objects);
  const auto none = compute_run(std::move(*objects), of, {}, {}, diagnostics);
  ASSERT_FALSE(none);
  EXPECT_NE(none.error().text().find("2018-01-2"), std::string::npos) << none.error().text();
}

TEST_F(RunJob, AFileThatIsNotThereIsNamed) {
  std::filesystem::remove(folder / "sphere.obj");
  const auto objects = load_run(scenario(), {}, {}, diagnostics);
  ASSERT_FALSE(objects);
  EXPECT_NE(objects.error().text().find("sphere.obj"), std::string::npos);
}

} // namespace
} // namespace umov::jobs
