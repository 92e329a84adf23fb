// What a worker tells of a shard, and what is kept of one that failed: there and back.

#include "fuzz/target.h"

#include <umov/scale/job_folder.h>
#include <umov/scale/shard_work.h>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
  using namespace umov;
  const std::string text(fuzz::text_of(data, size));
  // A worker is ours: whatever else it says is called a bug of ours, with a message.
  if (const auto record = scale::record_from_json(text)) {
    const auto again = fuzz::must(scale::record_from_json(scale::to_json(*record)),
                                  "a record that was read can be written and read");
    fuzz::require(again.index == record->index && again.status == record->status &&
                      again.code == record->code && again.rows == record->rows &&
                      again.bytes == record->bytes,
                  "the same record");
  } else {
    fuzz::require(!record.error().message.empty(), "a refusal has a message");
  }
  if (const auto failed = scale::failed_from_json(text)) {
    const auto again = scale::failed_from_json(scale::to_json(*failed, {0, 1}));
    fuzz::require(again && again->index == failed->index && again->code == failed->code &&
                      again->attempts == failed->attempts && again->message == failed->message,
                  "the same failure");
  }
  return 0;
}
