#include <gtest/gtest.h>
#include <umov/light/stokes_table.h>

namespace umov {
namespace {

StokesTable example() {
  StokesTable out;
  out.resize(2, 3);
  for (std::size_t k = 0; k < 6; ++k)
    out.put(k / 3, k % 3,
            {{1 / (static_cast<double>(k) + 3), -0.25, 1e-300, 0}, {1e-9, 0.5, 0, 3}});
  out.is_dark = {0, 1};
  out.method = {PoseMethod::Rays, PoseMethod::Mended};
  out.glint_share = {0.75, 0};
  out.indirect.resize(6, {1, 2, 3, 4});
  return out;
}

TEST(StokesBytes, GiveTheSameTableBackBitForBit) {
  const StokesTable table = example();
  StokesTable back;
  ASSERT_TRUE(from_bytes(to_bytes(table), back));
  EXPECT_EQ(to_bytes(back), to_bytes(table));
  EXPECT_EQ(back.bands, 3u);
  EXPECT_EQ(back.i, table.i);
  EXPECT_EQ(back.u, table.u);
  EXPECT_EQ(back.method, table.method);
  EXPECT_TRUE(back.material_i.empty());
}

TEST(StokesBytes, AnythingElseIsRefused) {
  const std::string bytes = to_bytes(example());
  StokesTable back;
  for (std::size_t cut = 0; cut < bytes.size(); ++cut)
    EXPECT_FALSE(from_bytes(std::string_view(bytes).substr(0, cut), back)) << cut;
  EXPECT_FALSE(from_bytes(bytes + "x", back));
  std::string huge = bytes; // a column of 2^64 - 1 numbers
  huge.replace(8, 8, 8, '\xff');
  EXPECT_FALSE(from_bytes(huge, back));
  std::string other_bands = bytes;
  other_bands[0] = 4;
  EXPECT_FALSE(from_bytes(other_bands, back));
  StokesTable no_rows; // 2 poses and 2^63 bands: 0 numbers, if products may wrap
  no_rows.resize(2, 0);
  std::string wrapped = to_bytes(no_rows);
  ASSERT_TRUE(from_bytes(wrapped, back));
  wrapped[7] = '\x80';
  EXPECT_FALSE(from_bytes(wrapped, back));
  StokesTable wrong = example();
  wrong.indirect.pop_back();
  EXPECT_FALSE(from_bytes(to_bytes(wrong), back));
  wrong = example();
  wrong.glint_share.push_back(0);
  EXPECT_FALSE(from_bytes(to_bytes(wrong), back));
  wrong = example();
  wrong.material_i.resize(7);
  EXPECT_FALSE(from_bytes(to_bytes(wrong), back));
  wrong = example();
  wrong.method[1] = static_cast<PoseMethod>(200);
  EXPECT_FALSE(from_bytes(to_bytes(wrong), back));
}

} // namespace
} // namespace umov
