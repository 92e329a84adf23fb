#include "light/fast/pose_order.h"

#include "light/fast/octahedron.h"

#include <algorithm>
#include <numeric>
#include <umov/core/parallel.h>

namespace umov {
namespace {

/// Bytes of rows that stay in a core's second cache beside those of the other direction.
constexpr std::size_t tile_bytes = 256 << 10;

/// Bits of the curve's 24 that tell tiles of about that size apart.
unsigned tile_bits(std::size_t directions, std::size_t row_bytes) {
  unsigned bits = 0;
  while (bits < 8 && (directions * row_bytes >> bits) > tile_bytes)
    ++bits;
  return bits;
}

} // namespace

std::vector<std::uint32_t> order_for_masks(std::span<const Pose> poses, std::size_t directions,
                                           std::size_t row_bytes, unsigned threads) {
  const unsigned bits = tile_bits(directions, row_bytes);
  std::vector<std::uint32_t> tile(poses.size()), order(poses.size());
  std::vector<std::uint32_t> first((std::size_t{1} << (2 * bits)) + 1, 0);
  constexpr std::size_t block = 4096;
  parallel_for((poses.size() + block - 1) / block, threads, [&](std::size_t task) {
    for (std::size_t i = task * block; i < std::min(poses.size(), (task + 1) * block); ++i) {
      const std::uint32_t sun = curve_order(poses[i].sun) >> (24 - bits);
      const std::uint32_t observer = curve_order(poses[i].observer) >> (24 - bits);
      tile[i] = sun << bits | observer;
    }
  });
  for (const std::uint32_t t : tile)
    ++first[t + 1];
  std::partial_sum(first.begin(), first.end(), first.begin());
  for (std::uint32_t i = 0; i < poses.size(); ++i)
    order[first[tile[i]]++] = i;
  return order;
}

} // namespace umov
