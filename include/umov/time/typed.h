#pragma once
// Times as people type them.

#include <string_view>
#include <umov/time/epoch.h>

namespace umov {

/// As utc_from_iso, and a day without a time, "2018-01-21", which stands for its 0 h UTC. Not for
/// tables, where a time that is left out is a slip.
Result<Epoch<Utc>> utc_from_iso_or_day(std::string_view text);

} // namespace umov
