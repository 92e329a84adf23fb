#include "surface/tests/distributions/distribution_cases.h"

namespace umov {
namespace {

TEST(MirrorNormals, HoldAllTheirAreaAtTheNormal) {
  const auto d = *make_distribution({"mirror", {}, {}, {}});
  EXPECT_TRUE(d->is_mirror());
  EXPECT_EQ(d->beyond(1), 1);
  EXPECT_EQ(d->beyond(1 - 1e-12), 0);
  EXPECT_EQ(d->masking(tilted(0.1)), 1);
}

TEST(Models, AreFoundByNameAndTheirNumbersChecked) {
  EXPECT_EQ(distribution_models().size(), 6u);
  const auto says = [](const DistributionChoice &choice, const char *word) {
    const auto d = make_distribution(choice);
    return !d && d.error().message.find(word) != std::string::npos;
  };
  EXPECT_TRUE(says({"beckman", {}, {}, {}}, "Did you mean \"beckmann\"?"));
  EXPECT_TRUE(says({"ggx", {}, {}, {}}, "needs alpha"));
  EXPECT_TRUE(says({"ggx", {{"alpha", 0}}, {}, {}}, "alpha = 0"));
  EXPECT_TRUE(says({"ggx", {{"alpha", 1}, {"m", 3}}, {}, {}}, "m has no meaning"));
}

} // namespace
} // namespace umov
