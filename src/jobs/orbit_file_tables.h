#pragma once
// Private: rows of files of orbits.

#include <umov/io/ccsds.h>
#include <umov/io/table.h>
#include <umov/orbit/elements.h>
#include <vector>

namespace umov::jobs {

/// A row per set of mean elements.
Table elements_table(const std::vector<ElementSet> &sets);
/// A row per segment of a message.
Table segments_table(const ccsds::Message &message);

} // namespace umov::jobs
