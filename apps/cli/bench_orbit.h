#pragma once
#include <umov/core/diagnostics.h>
#include <umov/io/table.h>

namespace umov::cli {

/// Rates of SGP4 over a catalogue: one state at a time and in lanes, for every instruction set.
Result<Table> bench_orbit(const std::string &file, Diagnostics &diagnostics);

} // namespace umov::cli
