#pragma once
// Private: elements as TLE, which holds fewer digits than the other forms.

#include <string>
#include <umov/core/diagnostics.h>
#include <umov/io/tle.h>
#include <vector>

namespace umov {

/// Three lines each (two without a name). Warns, per field, how many sets the columns could not
/// hold to the last digit; BadInput for a catalogue number beyond Alpha-5.
Result<std::string> tle_of(const std::vector<ElementSet> &sets, Diagnostics &diagnostics);

} // namespace umov
