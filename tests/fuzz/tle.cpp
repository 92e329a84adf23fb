// TLE and 3LE. Their columns hold fewer digits than numbers have: what was written once is written
// the same again.

#include "fuzz/elements.h"

#include <umov/io/tle.h>

namespace {

void check_written_twice(const std::vector<umov::ElementSet> &sets) {
  using namespace umov;
  Diagnostics diagnostics;
  const auto first = write_elements(sets, ElementsForm::Tle, {}, diagnostics);
  if (!fuzz::is_read(first))
    return;
  const auto read = fuzz::must(read_tle(*first, "written", {}, diagnostics),
                               "a TLE is written so that it can be read");
  const auto second = fuzz::must(write_elements(read, ElementsForm::Tle, {}, diagnostics),
                                 "what came from a TLE goes into one");
  fuzz::require(second == *first, "a TLE is written the same again");
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
  using namespace umov;
  const std::string_view text = fuzz::text_of(data, size);
  for (const bool is_lenient : {false, true}) {
    Diagnostics diagnostics;
    TleOptions options;
    options.allow_bad_checksum = options.keep_going = is_lenient;
    // Whoever does not know the form asks so.
    fuzz::is_read(read_elements(text, "input", options, diagnostics));
    const auto sets = read_tle(text, "input", options, diagnostics);
    if (!fuzz::is_read(sets))
      continue;
    check_written_twice(*sets);
    fuzz::check_written(*sets, ElementsForm::OmmKvn);
  }
  return 0;
}
