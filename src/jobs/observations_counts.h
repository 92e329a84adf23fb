#pragma once
// Private: counts as observations to be inverted.

#include <umov/io/observations_file.h>

namespace umov::jobs {

/// Whether a text is a table of counts: columns counts and w0 ... w3.
bool is_counts_table(std::string_view text);
/// Counts of one object with what `reduce` makes of each set as its rows, at the time of the
/// exposure nearest to the set's middle; without `has_polarization` those rows alone, as they are.
/// Warns of what is left out: saturated counts, or sets with such. BadInput and Physics as of
/// `read_counts_text` and `reduce`, BadInput for more than one object.
Result<ObservationsFile> observations_of_counts(std::string_view text, const std::string &file,
                                                bool has_polarization, unsigned threads,
                                                Diagnostics &diagnostics);

} // namespace umov::jobs
