#include <umov/jobs/tallies.h>

#include <algorithm>
#include <fmt/format.h>
#include <umov/core/text.h>

namespace umov::jobs {

Result<std::vector<std::string>> sentences(const std::vector<Tally> &tallies,
                                           const std::vector<std::size_t> &counts,
                                           std::size_t total) {
  std::vector<std::string> out;
  for (std::size_t k = 0; k < std::min(tallies.size(), counts.size()); ++k) {
    const Tally &tally = tallies[k];
    if (counts[k] == 0)
      continue;
    if (counts[k] == total && !tally.all.empty())
      return fail(ErrorCode::Physics, tally.all);
    out.push_back(tally.unit.empty() ? fmt::format("{} of {} {}", counts[k], total, tally.words)
                                     : counted(counts[k], tally.unit) + " " + tally.words);
  }
  return out;
}

void note_warnings(Table &table, const std::vector<std::string> &warnings) {
  constexpr std::size_t most = 20;
  for (std::size_t k = 0; k < std::min(most, warnings.size()); ++k)
    table.note(fmt::format("warning_{}", k + 1), warnings[k]);
}

} // namespace umov::jobs
