// Light that a search asks for, and that of its last steps.

#include "jobs/invert_light.h"

#include "jobs/curve_questions.h"
#include "jobs/tests/white_sphere.h"

#include <umov/light/poses.h>

namespace umov::jobs {
namespace {

using test::white_sphere_intensity;

class LightOfABall : public test::WhiteSphere {};

TEST_F(LightOfABall, IsSummedFastForTheSearchAndExactAtTheEnd) {
  Diagnostics diagnostics;
  auto ready = prepare_light(scenario(), {}, {}, diagnostics);
  ASSERT_TRUE(ready) << ready.error().text();
  EXPECT_FALSE(ready->coarse);
  ASSERT_TRUE(take_coarse(*ready, scenario(), {}, {}));
  EXPECT_EQ(ready->light.model().facts().method, LightMethod::Rays);
  ASSERT_TRUE(ready->masks);
  EXPECT_EQ(ready->masks->model().facts().method, LightMethod::Masks);
  ASSERT_TRUE(ready->coarse);
  EXPECT_LT(2 * ready->coarse->model().facts().classes, ready->masks->model().facts().classes);
  std::vector<Pose> poses;
  for (std::size_t k = 0; k < 60; ++k)
    poses.push_back(random_pose(1, k, Angle::degrees(10 + 2 * static_cast<double>(k))));
  StokesTable quick, first, last, joined, fast, exact;
  const Monitor monitor;
  ASSERT_TRUE(quick_lighting(*ready, 1, monitor)(poses, quick));
  ASSERT_TRUE(first_lighting(*ready, 1, monitor)(poses, first));
  ASSERT_TRUE(searched_lighting(*ready, 1, monitor)(poses, last));
  ASSERT_TRUE(lighting_of(*ready->coarse, 1, monitor)(poses, joined));
  ASSERT_TRUE(lighting_of(*ready->masks, 1, monitor)(poses, fast));
  ASSERT_TRUE(lighting_of(ready->light, 1, monitor)(poses, exact));
  EXPECT_EQ(quick.i, joined.i);
  EXPECT_EQ(first.i, fast.i);
  EXPECT_EQ(last.i, exact.i);
  EXPECT_NE(joined.i, fast.i);
  EXPECT_NE(fast.i, exact.i);
  // 1 % of the ball full of light: half of what a search takes the model for; 5000 facets give
  // .998.
  const double full = white_sphere_intensity(0);
  for (std::size_t k = 0; k < poses.size(); ++k) {
    const double expected = white_sphere_intensity(angle_between(poses[k].sun, poses[k].observer));
    EXPECT_NEAR(quick.i[k], expected, 0.01 * full) << k;
    EXPECT_NEAR(last.i[k], expected, 0.01 * full) << k;
  }
}

/// A folder of many jobs is known again by this text: rows of two different questions never meet.
TEST(InvertRequests, AreToldApartByAllThatIsAskedOfMaterials) {
  const InvertRequest plain;
  const auto with = [](double MaterialErrors::*one) {
    InvertRequest out;
    out.materials.*one += 0.5;
    return text_of(out);
  };
  for (const auto one : {&MaterialErrors::slope, &MaterialErrors::reflectance,
                         &MaterialErrors::haze, &MaterialErrors::tilt_deg})
    EXPECT_NE(with(one), text_of(plain));
  InvertRequest by_group;
  by_group.materials.is_by_group = true;
  EXPECT_NE(text_of(by_group), text_of(plain));
}

} // namespace
} // namespace umov::jobs
