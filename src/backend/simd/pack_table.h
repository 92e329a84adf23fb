#pragma once
// For each set of eight lanes: where those that are in it stand, then the others.

#include <cstddef>
#include <cstdint>

namespace umov::backend {

struct PackTable {
  alignas(8) std::uint8_t lane[256][8];
  constexpr PackTable() : lane{} {
    for (unsigned set = 0; set < 256; ++set) {
      std::size_t next = 0;
      for (const unsigned wanted : {1u, 0u})
        for (unsigned j = 0; j < 8; ++j)
          if ((set >> j & 1u) == wanted)
            lane[set][next++] = static_cast<std::uint8_t>(j);
    }
  }
};
inline constexpr PackTable pack_table;

/// 0, 1, 2... for as many lanes as any register has.
alignas(64) inline constexpr std::uint32_t lane_number[16] = {0, 1, 2,  3,  4,  5,  6,  7,
                                                              8, 9, 10, 11, 12, 13, 14, 15};

} // namespace umov::backend
