#pragma once
// Private: whether the angles of analysers and the weights of their rows say the same.

#include <string>
#include <umov/core/diagnostics.h>
#include <umov/io/counts_file.h>
#include <vector>

namespace umov {

/// Warns where analyser_deg and the axis of w1, w2 stand apart: of one row against the others of
/// its exposure, or of its set where analysers follow each other and x_axis_pa is told
/// (`has_axis`). Plates and mirrors turn light before an analyser: rows behind them are taken as
/// they are. `lines` are those of the rows in `name`.
void warn_of_analysers(const CountsFile &file, const std::vector<std::size_t> &lines, bool has_axis,
                       const std::string &name, Diagnostics &diagnostics);

} // namespace umov
