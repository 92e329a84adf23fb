// Scenarios and their locks (TOML), with what --set puts over them: lines after a NUL.

#include "fuzz/target.h"

#include <umov/io/scenario.h>
#include <vector>

namespace {

std::vector<std::string> lines_of(std::string_view text) {
  std::vector<std::string> out;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    out.emplace_back(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return out;
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
  using namespace umov;
  const std::string_view bytes = fuzz::text_of(data, size);
  const std::size_t nul = std::min(bytes.find('\0'), size);
  const auto overrides = lines_of(bytes.substr(std::min(nul + 1, size)));
  const auto read = read_scenario_text(std::string(bytes.substr(0, nul)), fuzz::nowhere, overrides);
  if (!fuzz::is_read(read))
    return 0;
  fuzz::require(!read->objects.empty(), "a scenario has an object");
  check_complete_for_run(*read);
  const std::string lock = locked_scenario(*read);
  const auto back =
      fuzz::must(read_scenario_text(lock, fuzz::nowhere, {}), "a lock can be read:\n" + lock);
  fuzz::require(locked_scenario(back) == lock, "a lock is its own lock");
  return 0;
}
