#pragma once
// Private: analysers that follow each other, of which a reduction is right for a body at rest
// alone.

#include <map>
#include <umov/inverse/observed_curve.h>
#include <vector>

namespace umov::jobs {

/// Counts of each set whose exposures are of several times, by ObservedCount::set. They look into
/// the curve.
std::map<std::size_t, std::vector<const ObservedCount *>>
counts_in_sequence(const ObservedCurve &curve);

} // namespace umov::jobs
