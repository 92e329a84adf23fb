#include <umov/scale/status.h>

#include <fmt/format.h>
#include <umov/scale/lease.h>

namespace umov::scale {

Result<JobStatus> status_of(const JobFolder &folder) {
  UMOV_ASSIGN(there, folder.shards(true));
  JobStatus out;
  out.shards = folder.lock().shards();
  out.done = there.size();
  out.total = folder.lock().total;
  out.unit = folder.lock().unit;
  out.failed = folder.failed();
  for (const auto &[index, files] : there)
    for (const Shard &shard : files)
      out.bytes += shard.bytes;
  out.holders = lease_holders(folder.path());
  return out;
}

std::string describe(const JobStatus &status) {
  std::string text = fmt::format("{} of {} shards are done ({} {} in all), {:.3g} GB\n",
                                 status.done, status.shards, status.total, status.unit,
                                 static_cast<double>(status.bytes) / 1e9);
  for (const FailedShard &one : status.failed)
    text += fmt::format("shard {} failed ({}, tried {} times): {}\n", one.index, one.code,
                        one.attempts, one.message);
  return text +
         (status.holders.empty() ? "nobody is at work\n" : "at work: " + status.holders + "\n");
}

std::string to_json(const JobStatus &status) {
  return fmt::format("{{\"shards\": {}, \"done\": {}, \"failed\": {}, \"bytes\": {}, "
                     "\"total\": {}, \"unit\": \"{}\", \"is_complete\": {}, \"is_held\": {}}}\n",
                     status.shards, status.done, status.failed.size(), status.bytes, status.total,
                     status.unit, status.done == status.shards, !status.holders.empty());
}

} // namespace umov::scale
