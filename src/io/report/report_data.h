#pragma once
#include <string>
#include <umov/io/report.h>
#include <umov/picture/colours.h>

namespace umov {

/// The JSON block of the page: valid inside a <script> element whatever texts it holds.
Result<std::string> report_data(const ReportInput &input);

} // namespace umov
