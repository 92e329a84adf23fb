#pragma once
#include <umov/orbit/elements.h>
#include <vector>

namespace umov {

/// The set of `norad` (0: the only object of the file) to use for a span that begins at `start`:
/// the newest one before it, else the first one after it. BadInput if the object is not there, or
/// if `norad` is 0 and the file holds several; the message lists them.
Result<ElementSet> choose_elements(const std::vector<ElementSet> &sets, int norad, Epoch<Utc> start,
                                   const std::string &file);

/// Warns if some epoch of the span is more than 7 days from the elements'; BadInput past 30 days
/// unless `allow_old`.
Result<void> check_element_age(const ElementSet &set, Epoch<Utc> start, Epoch<Utc> stop,
                               bool allow_old, const std::string &file, Diagnostics &diagnostics);

} // namespace umov
