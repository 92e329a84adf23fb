#pragma once
// The probes over lanes of the instruction set in use.

#include <cstddef>
#include <cstdint>
#include <vector>

namespace umov::test {

/// First lane of every result; all lanes hold x. Empty if some lane differs from the first.
std::vector<double> lane_values(std::size_t family, float x);

/// Runs `body(name)` with each instruction set that was compiled and that this machine has.
void for_each_instruction_set(void (*body)(const char *name, void *data), void *data);

} // namespace umov::test
