// Shards of a job in parts, and the text that says what the job is. Everyone can make the key of
// such a text: it is put in, so that what is behind it is reached.

#include "fuzz/target.h"
#include "scale/whole_number.h"

#include <umov/scale/job_folder.h>
#include <umov/scale/rows_file.h>

namespace {

using namespace umov;

void try_rows(std::string_view bytes) {
  const auto file = scale::RowsFile::read(bytes, "input");
  if (!fuzz::is_read(file))
    return;
  fuzz::require(file->bytes() == bytes.size() && file->head().key.size() <= bytes.size(),
                "a file of its bytes");
  for (std::size_t table = 0; table < file->tables().size(); ++table) {
    std::size_t rows = 0;
    const std::vector<std::size_t> widths = file->widths(table);
    for (std::size_t block = 0; block < file->blocks(table); ++block) {
      const auto read = file->block(table, block);
      if (!fuzz::is_read(read))
        return;
      rows += read->rows();
      fuzz::require(read->columns().size() == widths.size(), "a block has all columns");
      for (std::size_t c = 0; c < widths.size(); ++c)
        if (const auto *texts = std::get_if<std::vector<std::string>>(&read->columns()[c].cells))
          for (const std::string &text : *texts)
            fuzz::require(text.size() <= widths[c], "no text is longer than the longest");
    }
    fuzz::require(widths.empty() || rows == file->rows(table), "as many rows as it says");
  }
}

/// The text with the key that fits what it says; as it is where it says too little.
std::string with_key(const std::string &text) {
  try {
    auto all = nlohmann::json::parse(text);
    scale::JobLock lock;
    all.at("verb").get_to(lock.verb);
    all.at("job").get_to(lock.identity);
    lock.total = scale::whole_at(all, "total");
    lock.per_shard = scale::whole_at(all, "per_shard");
    all["key"] = lock.key();
    return all.dump();
  } catch (const std::exception &) {
    return text;
  }
}

void try_lock(const std::string &text) {
  const auto lock = scale::lock_from_json(text, "input");
  if (!fuzz::is_read(lock))
    return;
  const std::string written = scale::to_json(*lock);
  const auto again = fuzz::must(scale::lock_from_json(written, "again"), "what is written is read");
  fuzz::require(scale::to_json(again) == written, "a job comes back as it was");
  fuzz::require(scale::first_difference(lock->identity, again.identity).empty(), "the same job");
  fuzz::require(!scale::first_difference(lock->identity, lock->identity + "\nx").empty(),
                "another job");
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
  const std::string_view bytes = fuzz::text_of(data, size);
  try_rows(bytes);
  const std::string text(bytes);
  try_lock(text);
  try_lock(with_key(text));
  return 0;
}
