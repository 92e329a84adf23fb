#include "part_options.h"

namespace umov::cli {

void add_part(CLI::App &verb, PartOptions &part, const std::string &unit) {
  auto *shard = verb.add_option("--shard", part.shard,
                                "K/N: of N equal parts of the " + unit +
                                    " part K, from 0; its rows are those of the whole");
  verb.add_option("--range", part.range, "FIRST:COUNT of the " + unit + ", counted from 0")
      ->excludes(shard);
}

Result<jobs::JobPart> part_of(const PartOptions &part) {
  if (!part.shard.empty())
    return jobs::JobPart::shard(part.shard);
  if (!part.range.empty())
    return jobs::JobPart::range(part.range);
  return jobs::JobPart();
}

} // namespace umov::cli
