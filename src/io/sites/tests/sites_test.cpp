#include <umov/io/sites.h>

#include <gtest/gtest.h>

namespace umov {
namespace {

TEST(Sites, ByNameAndByNumbers) {
  EXPECT_EQ(site_names().size(), 16u);
  const auto maui = site_from("Maui");
  ASSERT_TRUE(maui);
  EXPECT_NEAR(maui->latitude.degrees(), 20.7083, 1e-12);
  EXPECT_EQ(site_from("mauna-kea")->name, "mauna kea");
  const auto own = site_from(" 10, -20.5 ,30");
  ASSERT_TRUE(own);
  EXPECT_NEAR(own->longitude.degrees(), -20.5, 1e-12);
  EXPECT_EQ(own->altitude_m, 30);
  const auto low = site_from("10,-20.5");
  ASSERT_TRUE(low);
  EXPECT_EQ(low->altitude_m, 0);
  EXPECT_EQ(low->longitude.radians(), own->longitude.radians());
}

TEST(Sites, SaysWhatIsWrong) {
  EXPECT_NE(site_from("Mauii").error().message.find("Did you mean \"maui\"?"), std::string::npos);
  EXPECT_TRUE(site_from("95,0,0").error().message.starts_with("site \"95,0,0\": lat_deg = 95; "));
  EXPECT_FALSE(site_from("1,2,"));
  EXPECT_FALSE(site_from("1"));
  EXPECT_FALSE(site_from(""));
  for (const std::string &name : site_names())
    EXPECT_TRUE(site_from(name)) << name;
}

} // namespace
} // namespace umov
