#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <gtest/gtest.h>
#include <stdexcept>
#include <sys/resource.h>
#include <umov/core/parallel.h>
#include <vector>

namespace umov {
namespace {

TEST(ParallelFor, EveryIndexOnceAndExceptionsComeThrough) {
  for (const unsigned threads : {1u, 2u, 7u}) {
    std::vector<int> hits(1000, 0);
    parallel_for(hits.size(), threads, [&](std::size_t i) { ++hits[i]; });
    EXPECT_EQ(std::count(hits.begin(), hits.end(), 1), 1000);
    EXPECT_THROW(parallel_for(100, threads,
                              [](std::size_t i) {
                                if (i == 50)
                                  throw std::runtime_error("body");
                              }),
                 std::runtime_error);
  }
}

// A container's limit: 1000 stacks do not fit. In a process of its own, which the limit stays in.
TEST(ParallelForDeathTest, GoesOnWithTheThreadsThatThereAre) {
#if defined(UMOV_SANITIZED)
  GTEST_SKIP() << "address sanitizer needs the address space";
#endif
  testing::GTEST_FLAG(death_test_style) = "threadsafe";
  const auto run = [] {
    const rlimit limit{std::size_t{1} << 30, std::size_t{1} << 30};
    ::setrlimit(RLIMIT_AS, &limit);
    std::atomic<int> done{0};
    parallel_for(5000, 1000, [&](std::size_t) { ++done; });
    std::_Exit(done == 5000 ? 0 : 1);
  };
  EXPECT_EXIT(run(), testing::ExitedWithCode(0), "");
}

} // namespace
} // namespace umov
