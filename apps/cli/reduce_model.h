#pragma once
// What brightness over time is made of, as `umov reduce --model` says it.

#include <string>
#include <umov/jobs/reduce.h>

namespace umov::cli {

/// "static", "fourier:PERIOD_S", "fourier:PERIOD_S:HARMONICS" or "spline:KNOTS_S"; Usage for other
/// texts.
Result<void> read_reduce_model(const std::string &text, jobs::ReduceOptions &out);

} // namespace umov::cli
