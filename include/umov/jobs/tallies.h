#pragma once
// Warnings that count rows: told once for a whole job, however many parts it was done in.

#include <cstddef>
#include <string>
#include <umov/core/result.h>
#include <umov/io/table.h>
#include <vector>

namespace umov::jobs {

/// What is said of rows of one kind. Each part of a job says how many it has.
struct Tally {
  std::string unit;  ///< in the singular, told as "3 frames WORDS"; "": "3 of 80 WORDS"
  std::string words; ///< what is the matter with them
  std::string all;   ///< the error (Physics) that it is where all rows are such; "": none
};

/// A sentence for each of which there are any, in their order. `counts`: of each tally; `total`:
/// rows of the job. Physics where all are such as make the job useless.
Result<std::vector<std::string>> sentences(const std::vector<Tally> &tallies,
                                           const std::vector<std::size_t> &counts,
                                           std::size_t total);

/// Warnings in a table's header, the first twenty: who is given the table alone reads them.
void note_warnings(Table &table, const std::vector<std::string> &warnings);

} // namespace umov::jobs
