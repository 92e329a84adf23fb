#pragma once
#include <string>
#include <string_view>
#include <umov/io/report.h>

namespace umov {

/// make_report with the plotting script as a parameter; an empty one is the error of a build
/// without it.
Result<std::string> assemble_report(const ReportInput &input, std::string_view plotting_script);

} // namespace umov
