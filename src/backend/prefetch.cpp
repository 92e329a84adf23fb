#include "backend/scene_data.h"

namespace umov::backend {
namespace {

constexpr std::size_t line = 64; ///< bytes of a cache line

void prefetch_row(const MaskTable &table, const GridLook &look) {
  if (table.entries == 0)
    return;
  for (const std::uint32_t direction : look.direction) {
    const std::uint32_t *offset = table.offset.data() + direction * table.entries;
    for (std::size_t i = 0; i < table.entries; i += line / sizeof(std::uint32_t))
      __builtin_prefetch(offset + i);
  }
}

} // namespace

void prefetch(const Masks &masks, const GridLook &small_sun, const GridLook &small_observer,
              const GridLook &large_sun, const GridLook &large_observer) {
  prefetch_row(masks.small, small_sun);
  prefetch_row(masks.small, small_observer);
  prefetch_row(masks.large, large_sun);
  prefetch_row(masks.large, large_observer);
}

} // namespace umov::backend
