// CubeSats, boxes with wings, stages and dishes of given sizes.

#include <cmath>
#include <gtest/gtest.h>
#include <umov/core/quantity.h>
#include <umov/shape/primitives.h>
#include <umov/shape/topology.h>

namespace umov {
namespace {

double area_of(const Mesh &mesh, const std::string &group) {
  const MeshReport report = inspect(mesh, false);
  double out = 0;
  for (std::size_t g = 0; g < mesh.groups.size(); ++g)
    if (mesh.groups[g] == group)
      out += report.group_area_m2[g];
  return out;
}

TEST(Spacecraft, EveryShapeIsClosed) {
  for (const Mesh &mesh : {make_cubesat({3, 4}), make_cubesat({12, 2}), make_satellite(),
                           make_rocket_body(), make_dish()}) {
    const MeshReport report = inspect(mesh, false);
    EXPECT_EQ(report.open_edges, 0u);
    EXPECT_EQ(report.degenerate, 0u);
    EXPECT_GT(report.volume_m3, 0); // winding outwards
  }
}

TEST(Spacecraft, FacesHaveTheSizesAskedFor) {
  // CubeSat Design Specification: 3 units are 100 x 100 x 340.5 mm.
  const Mesh cubesat = make_cubesat({3, 2});
  EXPECT_NEAR(area_of(cubesat, "body_pz"), 0.01, 1e-12);
  EXPECT_NEAR(area_of(cubesat, "body_px"), 0.03405, 1e-12);
  EXPECT_NEAR(area_of(cubesat, "panel_px_front"), 0.03405, 1e-12);
  EXPECT_NEAR(area_of(cubesat, "panel_mx_back"), 0.03405, 1e-12);
  const Mesh satellite = make_satellite({{2, 1.5, 3}, 7, 2, 0.4});
  EXPECT_NEAR(area_of(satellite, "bus_py"), 6, 1e-12);
  EXPECT_NEAR(area_of(satellite, "wing_py_front"), 14, 1e-12);
  EXPECT_NEAR(area_of(satellite, "wing_my_back"), 14, 1e-12);
}

TEST(Spacecraft, CellsFaceUpAndTheBowlOpensUp) {
  const Mesh mesh = make_satellite();
  for (const Triangle &t : mesh.triangles)
    if (mesh.groups[t.front] == "wing_py_front")
      EXPECT_GT(cross(mesh.positions[t.vertex[1]] - mesh.positions[t.vertex[0]],
                      mesh.positions[t.vertex[2]] - mesh.positions[t.vertex[0]])
                    .z,
                0);
  // Area of a paraboloid of radius R and focal length f: (8 pi/3) f^2 ((1 + R^2/(4 f^2))^(3/2) -
  // 1); 48 flat sides and 12 rings lie inside it by 1 %.
  const double f = 0.8, k = 1 + 1 / (4 * f * f);
  const double exact = 8 * pi / 3 * f * f * (std::pow(k, 1.5) - 1);
  EXPECT_NEAR(area_of(make_dish(), "dish_front"), exact, 0.01 * exact);
}

} // namespace
} // namespace umov
