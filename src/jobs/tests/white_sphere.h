#pragma once
// A white Lambert sphere on a real orbit, as a scenario: its light has a closed form.

#include <cmath>
#include <filesystem>
#include <gtest/gtest.h>
#include <umov/core/files.h>
#include <umov/io/obj.h>
#include <umov/io/scenario.h>
#include <umov/shape/primitives.h>
#include <unistd.h>

namespace umov::test {

inline constexpr double sphere_radius_m = 2;

/// J = 2/(3 pi) r^2 (sin a + (pi - a) cos a) (Russell 1916).
inline double white_sphere_intensity(double phase_rad) {
  return 2 / (3 * pi) * sphere_radius_m * sphere_radius_m *
         (std::sin(phase_rad) + (pi - phase_rad) * std::cos(phase_rad));
}

/// A folder of the test's own, with the sphere's mesh in it.
class WhiteSphere : public ::testing::Test {
protected:
  void SetUp() override {
    const auto *info = ::testing::UnitTest::GetInstance()->current_test_info();
    folder = std::filesystem::temp_directory_path() /
             ("umov_jobs_" + std::to_string(getpid()) + "_" + info->name());
    std::filesystem::create_directories(folder);
    const ObjText obj = write_obj(make_sphere(sphere_radius_m, 5000), "sphere", MtlUse::Named);
    ASSERT_TRUE(write_file_atomically(folder / "sphere.obj", obj.obj));
    ASSERT_TRUE(write_file_atomically(folder / "sphere.mtl", obj.mtl));
  }
  void TearDown() override { std::filesystem::remove_all(folder); }

  /// Agena over Maui, 10 min of a pass at 10 s. Index 1 reflects nothing at the interface.
  [[nodiscard]] Scenario scenario(const std::vector<std::string> &overrides = {}) const {
    const std::string text = R"(umov = 1
seed = 3
[observer]
name = "Maui"
lat_deg = 20.7083
lon_deg = -156.2578
alt_m = 3058
[time]
start = 2018-01-21T05:06:00Z
stop = 2018-01-21T05:16:00Z
step_s = 10
only = { alt_min_deg = 10, sun_alt_max_deg = -6, sunlit = true }
[[object]]
name = "ball"
orbit = { file = ")" UMOV_SOURCE_DIR R"(/data/tle/agena733.tle", norad = 733 }
mesh = { file = "sphere.obj", unit = "m", up = "+Z" }
materials = { default = "white" }
attitude = { mode = "nadir" }
[bands]
set = ["nm:550"]
[material.white]
index = { n = 1, k = 0 }
distribution = { model = "blinn_phong", m = 50 }
body = { reflectance = 1.0 }
)";
    auto out = read_scenario_text(text, folder / "ball.toml", overrides);
    EXPECT_TRUE(out) << out.error().text();
    return *out;
  }

  std::filesystem::path folder;
};

} // namespace umov::test
