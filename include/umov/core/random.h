#pragma once
// Counter-based random numbers (Philox 4x32-10: Salmon, Moraes, Dror & Shaw 2011): a value depends
// on its key and counter alone, never on a thread or on what was drawn before.

#include <array>
#include <cstdint>

namespace umov {

/// Ten rounds of Philox 4x32: four random words of `counter` under `key`.
std::array<std::uint32_t, 4> philox(std::array<std::uint32_t, 4> counter,
                                    std::array<std::uint32_t, 2> key);

/// Four uniform numbers in (0, 1) for a seed, a stream (what for) and an index.
std::array<double, 4> uniform4(std::uint64_t seed, std::uint32_t stream, std::uint64_t index);

} // namespace umov
