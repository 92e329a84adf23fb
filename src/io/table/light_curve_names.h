#pragma once
// Private: tables as readers of light curves want them.

#include <umov/io/table.h>

namespace umov {

/// The table; where it has time_utc, I and I_err, with them once more as time (MJD, UTC), flux and
/// flux_err, the names that lightkurve and others look for.
Table with_light_curve(Table table);

} // namespace umov
