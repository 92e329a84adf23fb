#pragma once
// What the page needs to show how a turning object's light repeats.

#include <nlohmann/json.hpp>
#include <umov/io/report.h>

namespace umov {

/// {"periods": [{name, seconds}], "passes": [{pass, start, span_s, bands: [{period, power, best,
/// trend}]}]}; null where the attitude does not turn by itself.
nlohmann::ordered_json turning_json(const ReportInput &input);

} // namespace umov
