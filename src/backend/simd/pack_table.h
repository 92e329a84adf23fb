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

} // namespace umov::backend
