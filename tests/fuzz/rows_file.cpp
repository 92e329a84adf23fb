// Shards of a job in parts, and the text that says what the job is.

#include "fuzz/target.h"

#include <umov/scale/job_folder.h>
#include <umov/scale/rows_file.h>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
  using namespace umov;
  const std::string_view text = fuzz::text_of(data, size);
  const auto file = scale::RowsFile::read(text, "input");
  for (std::size_t table = 0; file && table < file->tables().size(); ++table)
    for (std::size_t block = 0; block < file->blocks(table); ++block)
      (void)file->block(table, block);
  (void)scale::lock_from_json(std::string(text), "input");
  return 0;
}
