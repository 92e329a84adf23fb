// After the list of Embree's own verification: what rays must survive.

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <gtest/gtest.h>
#include <limits>
#include <sys/resource.h>
#include <umov/core/parallel.h>
#include <umov/core/quantity.h>
#include <umov/core/random.h>
#include <umov/core/result.h>
#include <umov/shape/occluder.h>
#include <umov/shape/primitives.h>
#include <unistd.h>

namespace umov {
namespace {

Vec3<Body> random_direction(std::uint64_t i) {
  const auto u = uniform4(8, 1, i);
  const double z = 2 * u[0] - 1, s = std::sqrt(1 - z * z);
  return {s * std::cos(2 * pi * u[1]), s * std::sin(2 * pi * u[1]), z};
}

TEST(Occluder, NoRayLeavesAClosedBody) {
  const Occluder occluder(make_sphere(1, 2000));
  unsigned char free = 1;
  for (std::uint64_t i = 0; i < 100000; ++i) {
    const Vec3<Body> origin = 0.5 * random_direction(2 * i);
    occluder.is_free({&origin, 1}, random_direction(2 * i + 1), {&free, 1});
    ASSERT_EQ(free, 0) << i;
  }
}

// What rays for grids may lose: seams, which at most one of a hundred thousand meets here.
TEST(Occluder, RaysOfGridsFindWhatEachRayFinds) {
  const Mesh mesh = make_sphere(1, 2000);
  const Occluder each(mesh), grid(mesh, Occluder::Rays::Grid);
  std::size_t other = 0, free_ones = 0;
  for (std::uint64_t i = 0; i < 2000; ++i) {
    std::vector<Occluder::Point> from(50), to(50);
    for (std::size_t k = 0; k < 50; ++k) {
      // Inside, where none is free, and outside.
      from[k] = each.to_point((k % 2 == 0 ? 0.5 : 1.1) * random_direction(4 * i));
      const Vec3<Body> d = random_direction(50 * i + k);
      to[k] = {static_cast<float>(d.x), static_cast<float>(d.y), static_cast<float>(d.z)};
    }
    std::vector<unsigned char> a(50), b(50);
    each.is_free(from, to, a);
    grid.is_free(from, to, b);
    for (std::size_t k = 0; k < 50; ++k) {
      other += a[k] != b[k] ? 1 : 0;
      free_ones += b[k];
    }
  }
  EXPECT_LE(other, 1u);
  // From 1.1 radii a sphere fills (1 - sqrt(1 - 1/1.21))/2 = .29 of all directions.
  EXPECT_NEAR(static_cast<double>(free_ones) / 50'000, 0.71, 0.01);
}

TEST(Occluder, TakesAnyNumberOfOriginsAndBothSidesStop) {
  const Occluder occluder(make_plate(2, 2, false));
  for (const std::size_t count : {0u, 1u, 15u, 16u, 17u, 100u})
    for (const double side : {1.0, -1.0}) {
      std::vector<Vec3<Body>> origins(count);
      std::vector<unsigned char> free(count, 9);
      for (std::size_t i = 0; i < count; ++i)
        origins[i] = {i % 2 == 0 ? 0.1 : 5.0, 0, side};
      occluder.is_free(origins, {0, 0, -side}, free);
      for (std::size_t i = 0; i < count; ++i)
        EXPECT_EQ(free[i], i % 2 == 0 ? 0 : 1);
    }
}

TEST(Occluder, NonFiniteRaysAreNeverFree) {
  const Occluder occluder(make_sphere(1, 100));
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = INFINITY;
  for (const double bad : {nan, inf, -inf}) {
    const std::vector<Vec3<Body>> origins{{bad, 0, 0}, {0, 5, 0}};
    std::vector<unsigned char> free(2);
    occluder.is_free(origins, {0, 1, 0}, free);
    EXPECT_EQ(free[0], 0);
    EXPECT_EQ(free[1], 1);
    occluder.is_free(origins, {bad, 1, 0}, free);
    EXPECT_EQ(free[1], 0);
    EXPECT_EQ(occluder.nearest({0, 0, bad}, {0, 0, 1}).triangle, no_index);
  }
}

// In a process of its own, which the limit stays in. A tree that is not there must not be taken for
// one that hides nothing.
TEST(OccluderDeathTest, OutOfMemoryIsAFailureAndNotAFreeSky) {
#if defined(UMOV_SANITIZED)
  GTEST_SKIP() << "address sanitizer needs the address space";
#endif
  testing::GTEST_FLAG(death_test_style) = "threadsafe";
  const auto build = [] {
    const Mesh mesh = make_sphere(1, 400000);
    const Occluder small(make_sphere(1, 100)); // threads and caches of Embree are there
    std::size_t pages = 0;
    std::ifstream("/proc/self/statm") >> pages;
    const std::size_t bytes = pages * static_cast<std::size_t>(::getpagesize()) + (24u << 20);
    const rlimit limit{bytes, bytes};
    ::setrlimit(RLIMIT_AS, &limit);
    try {
      const Occluder big(mesh);
    } catch (const Failure &failure) {
      std::fprintf(stderr, "%s\n", failure.what());
      std::_Exit(static_cast<int>(failure.error().code));
    }
    std::_Exit(0);
  };
  EXPECT_EXIT(build(), testing::ExitedWithCode(6), "triangles: out of memory");
}

TEST(Occluder, AnEmptyMeshHidesNothing) {
  const Occluder occluder(Mesh{});
  const Vec3<Body> origin{};
  unsigned char free = 0;
  occluder.is_free({&origin, 1}, {0, 0, 1}, {&free, 1});
  EXPECT_EQ(free, 1);
}

TEST(Occluder, NearestGivesDistanceAndTriangle) {
  const Mesh plate = make_plate(2000, 2000, false); // scaled inside: metres must come out
  const auto hit = Occluder(plate).nearest({10, 20, 300}, {0, 0, -1});
  EXPECT_NE(hit.triangle, no_index);
  EXPECT_NEAR(hit.distance_m, 300, 1e-3);
}

TEST(Occluder, ManyBuildsAndTwoThreadsGiveTheSame) {
  const Mesh mesh = make_sphere(1, 80);
  std::vector<int> counts(200);
  parallel_for(counts.size(), 2, [&](std::size_t k) {
    const Occluder occluder(mesh);
    for (std::uint64_t i = 0; i < 50; ++i) {
      const Vec3<Body> origin = 2.0 * random_direction(i);
      unsigned char free = 0;
      occluder.is_free({&origin, 1}, random_direction(i + 1000), {&free, 1});
      counts[k] += free;
    }
  });
  EXPECT_EQ(counts, std::vector<int>(counts.size(), counts[0]));
}

} // namespace
} // namespace umov
