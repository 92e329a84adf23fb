// Finished blocks of a job from a file that a kill, a full disk or a stranger left. Everyone can
// make key and checksums: they are put in, so that what is behind them is reached.

#include "fuzz/target.h"

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <umov/core/journal.h>
#include <umov/core/text.h>
#include <unistd.h>

namespace {

using namespace umov;

constexpr std::string_view job = "a job";
constexpr std::size_t block_head = 96; // mark, part, number, bytes: 8 each; a hash of 64 letters

/// The bytes behind the head of a journal of this job; the hash of every whole block is right.
std::string with_hashes(std::string_view input) {
  std::string out = "umov journal 1\n" + sha256_hex(job) + "\n";
  std::size_t at = out.size();
  out += input;
  while (out.size() - at >= block_head) {
    std::uint64_t bytes = 0;
    std::memcpy(&bytes, out.data() + at + 24, 8);
    if (bytes > out.size() - at - block_head)
      break;
    const std::string sum = sha256_hex(std::string_view(out).substr(at + block_head, bytes));
    out.replace(at + 32, sum.size(), sum);
    at += block_head + bytes;
  }
  return out;
}

/// A regular file, which a journal wants, in memory where there is such a folder.
std::filesystem::path scratch() {
  std::error_code unknown;
  const bool has_memory = std::filesystem::is_directory("/dev/shm", unknown);
  return (has_memory ? std::filesystem::path("/dev/shm") : std::filesystem::temp_directory_path()) /
         ("umov-fuzz-journal-" + std::to_string(::getpid()));
}

void try_bytes(const std::string &bytes) {
  const auto path = scratch();
  std::ofstream(path, std::ios::binary | std::ios::trunc) << bytes;
  std::size_t found = 0;
  {
    auto journal = Journal::open(path, job);
    if (!journal) {
      fuzz::check_refusal(journal.error());
      std::filesystem::remove(path);
      return;
    }
    found = journal->count();
    auto other = fuzz::must(Journal::open(path, job), "a journal in use is no error");
    fuzz::require(other.found() == Journal::Found::Busy, "one at a time has a journal");
    other.keep({1u << 30, 7}, "of the other");
    fuzz::require(other.count() == 0 && !other.problem(), "the other one keeps nothing");
    // What follows the last whole block goes; what was found stays.
    journal->keep({1u << 30, 7}, "new");
    journal->remark(1u << 30, "a word");
  }
  auto again = fuzz::must(Journal::open(path, job), "a journal that was gone on with is one");
  fuzz::require(again.count() >= found && again.find({1u << 30, 7}) == "new",
                "found blocks and the new one are there");
  fuzz::require(std::ranges::count(again.remarks(1u << 30), "a word") > 0, "and what was said");
  again.finish();
  fuzz::require(!std::filesystem::exists(path), "a finished journal goes");
}

/// A block of any bytes goes into a new journal and comes out of it; none goes into a folder.
void try_block(const std::string &bytes) {
  const auto path = Journal::name_for(scratch());
  {
    auto journal = fuzz::must(Journal::open(path, job), "a journal that is not there yet");
    journal.keep({1, 2}, bytes);
    fuzz::require(!journal.problem() && journal.find({1, 2}) == bytes, "a block is kept");
  }
  auto journal = fuzz::must(Journal::open(path, job), "a journal is one");
  fuzz::require(journal.found() == Journal::Found::Ours && journal.find({1, 2}) == bytes &&
                    !journal.find({2, 1}),
                "its block is found again, and no other");
  journal.finish();
  fuzz::require(!fuzz::is_read(Journal::open(path.parent_path(), job)), "a folder is no journal");
  auto nowhere = fuzz::must(Journal::open(fuzz::nowhere, job), "trouble shows with a block");
  nowhere.keep({1, 2}, bytes);
  fuzz::require(nowhere.problem() && nowhere.count() == 0, "and is said");
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
  const std::string_view input = fuzz::text_of(data, size);
  try_bytes(std::string(input));
  try_bytes(with_hashes(input));
  try_block(std::string(input));
  return 0;
}
