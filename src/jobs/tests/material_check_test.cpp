#include <cmath>
#include <gtest/gtest.h>
#include <umov/jobs/material_check.h>

namespace umov::jobs {
namespace {

const std::vector<double> &numbers(const Table &table, const char *name) {
  return std::get<std::vector<double>>(table.find(name)->cells);
}

// Mirrors give all light away once where the surface is smooth: at slope 0.02 next to no ray meets
// a second facet, so that traced and modelled fractions are 1 within the slope itself.
TEST(RoughSurface, AlmostSmoothScattersOnce) {
  RoughSurfaceRequest request;
  request.slope = 0.02, request.cells = 64, request.realisations = 2, request.rays = 4000;
  request.theta_deg = {0, 40};
  std::size_t told = 0;
  Monitor monitor;
  monitor.progress = [&](const std::string &, std::size_t done, std::size_t) { told = done; };
  const auto table = rough_surface_table(request, 1, monitor);
  ASSERT_TRUE(table) << table.error().text();
  EXPECT_EQ(table->rows(), 2u);
  EXPECT_EQ(told, 4u);
  for (const char *name : {"once", "once_ashikhmin", "once_smith", "once_smith_dir"})
    for (const double once : numbers(*table, name))
      EXPECT_NEAR(once, 1, request.slope) << name;
}

TEST(RoughSurface, BadNumbersAndAStopAreSaid) {
  RoughSurfaceRequest request;
  request.theta_deg = {90};
  EXPECT_EQ(rough_surface_table(request, 1, {}).error().code, ErrorCode::BadInput);
  request.theta_deg = {30};
  request.realisations = 0;
  EXPECT_EQ(rough_surface_table(request, 1, {}).error().code, ErrorCode::BadInput);
  request.realisations = 1;
  const std::atomic<bool> stop{true};
  Monitor monitor;
  monitor.cancel = &stop;
  EXPECT_EQ(rough_surface_table(request, 1, monitor).error().code, ErrorCode::Interrupted);
}

TEST(MaterialCheck, GoldIsPhysicalAndAnUnknownNameIsRefused) {
  const auto found = check_materials({{"gold", "aluminium"}, 200, 1}, 1);
  ASSERT_TRUE(found) << found.error().text();
  EXPECT_EQ(found->bad, 0u);
  ASSERT_EQ(found->table.rows(), 2u);
  for (const double albedo : numbers(found->table, "albedo_max"))
    EXPECT_LE(albedo, 1 + 1e-4); // energy: nothing gives more light than it takes
  EXPECT_EQ(check_materials({{"no such thing"}, 10, 0}, 1).error().code, ErrorCode::BadInput);
}

} // namespace
} // namespace umov::jobs
