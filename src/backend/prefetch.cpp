#include "backend/scene_data.h"

#include <algorithm>

namespace umov::backend {
namespace {

constexpr std::size_t line = 64;      ///< bytes of a cache line
constexpr std::size_t lines_max = 96; ///< per direction: more would push out what came first

void prefetch_row(const Masks &masks, const MaskTable &table, const GridLook &look) {
  if (table.entries == 0)
    return;
  for (const std::uint32_t direction : look.direction) {
    const std::uint32_t *offset = table.offset.data() + direction * table.entries;
    for (std::size_t i = 0; i < table.entries; i += line / sizeof(std::uint32_t))
      __builtin_prefetch(offset + i);
    const MaskRow row = table.row[direction];
    const std::size_t count = std::min<std::size_t>(row.count, lines_max);
    for (std::size_t block = 0; block < count; ++block)
      __builtin_prefetch(masks.pool.data() + row.first + block);
  }
}

} // namespace

void prefetch(const Masks &masks, const GridLook &small_sun, const GridLook &small_observer,
              const GridLook &large_sun, const GridLook &large_observer) {
  prefetch_row(masks, masks.small, small_sun);
  prefetch_row(masks, masks.small, small_observer);
  prefetch_row(masks, masks.large, large_sun);
  prefetch_row(masks, masks.large, large_observer);
}

} // namespace umov::backend
