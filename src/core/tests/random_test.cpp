#include <gtest/gtest.h>
#include <umov/core/parallel.h>
#include <umov/core/random.h>
#include <vector>

namespace umov {
namespace {

TEST(Philox, MatchesTheKnownAnswers) {
  // Random123 distribution, kat_vectors, philox4x32 10 rounds.
  const std::array<std::uint32_t, 4> zero = philox({0, 0, 0, 0}, {0, 0});
  EXPECT_EQ(zero, (std::array<std::uint32_t, 4>{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}));
  const std::uint32_t f = 0xffffffff;
  EXPECT_EQ(philox({f, f, f, f}, {f, f}),
            (std::array<std::uint32_t, 4>{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}));
}

TEST(ParallelFor, VisitsEveryIndexOnceForAnyThreadCount) {
  for (const unsigned threads : {1u, 2u, 8u}) {
    std::vector<int> seen(1000, 0);
    parallel_for(seen.size(), threads, [&](std::size_t i) { seen[i] += 1; });
    EXPECT_EQ(seen, std::vector<int>(1000, 1));
  }
}

} // namespace
} // namespace umov
