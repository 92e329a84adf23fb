#pragma once
// What of this machine the fast path uses.

#include <string_view>

namespace umov {

/// Name of the instruction set in use, as Highway has it ("AVX3_DL": AVX-512 with its later parts).
const char *engine_instruction_set();
/// Restricts the engine, for tests and benchmarks: "best", "avx512", "avx2", "sse4" or "baseline".
/// False, and nothing changed, if this machine lacks it or there is none of that name. Not while
/// another thread evaluates.
bool restrict_engine(std::string_view instruction_set);

} // namespace umov
