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
    const std::size_t end =
        std::min<std::size_t>(table.row[direction + 1], table.row[direction] + lines_max);
    for (std::size_t block = table.row[direction]; block < end; ++block)
      __builtin_prefetch(masks.pool.data() + block);
  }
}

} // namespace

void prefetch(const Masks &masks, const GridLook &narrow_sun, const GridLook &narrow_observer,
              const GridLook &wide_sun, const GridLook &wide_observer) {
  prefetch_row(masks, masks.narrow, narrow_sun);
  prefetch_row(masks, masks.narrow, narrow_observer);
  prefetch_row(masks, masks.wide, wide_sun);
  prefetch_row(masks, masks.wide, wide_observer);
}

} // namespace umov::backend
