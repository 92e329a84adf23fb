#include <umov/scale/shard_work.h>

#include "scale/this_process.h"

#include <algorithm>
#include <chrono>
#include <fmt/format.h>
#include <new>
#include <sys/resource.h>
#include <umov/scale/rows_file.h>

namespace umov::scale {
namespace {

/// What a process was held to; lets it have enough more to say so, as there may be nothing left.
std::string out_of_memory() {
  constexpr rlim_t enough = 64'000'000;
  struct rlimit most {};
  ::getrlimit(RLIMIT_DATA, &most);
  if (most.rlim_cur != RLIM_INFINITY) {
    const struct rlimit more { std::min(most.rlim_max, most.rlim_cur + enough), most.rlim_max };
    ::setrlimit(RLIMIT_DATA, &more);
  }
  return fmt::format("it needs more memory than the {} MB of its process. Shorter shards "
                     "(--per-shard, in a new folder) take less; fewer --workers, or --memory-mb, "
                     "give each more.",
                     most.rlim_cur / 1'000'000);
}

/// Computes, writes and names the file.
Result<void> fill(const JobFolder &folder, jobs::RangedJob &job, const jobs::Monitor &monitor,
                  ShardRecord &record) {
  const jobs::IndexRange range = folder.lock().range(record.index);
  UMOV_ASSIGN(writer, RowsWriter::open(folder.growing(record.index), job.tables(),
                                       {folder.key(), record.index, range}));
  Diagnostics told_at_the_begin;
  UMOV_TRY(job.rows(range, writer, monitor, told_at_the_begin));
  UMOV_ASSIGN(sum, writer.finish());
  const Shard shard = folder.named(record.index, sum);
  UMOV_TRY(writer.commit_as(folder.file_of(shard)));
  record.file = shard.name;
  record.sha256 = sum;
  record.rows = writer.rows();
  record.bytes = writer.bytes();
  return {};
}

} // namespace

Result<void> check_same_job(const JobFolder &folder, const jobs::RangedJob &job) {
  const std::string difference = first_difference(folder.lock().identity, job.identity());
  if (difference.empty() && folder.lock().total == job.total())
    return {};
  return fail(ErrorCode::BadInput,
              fmt::format("the job was begun with another program, instruction set or other "
                          "inputs: {}. Put them back (an instruction set: begin the job with --isa "
                          "and one that all machines have), or begin anew in another folder.",
                          difference.empty() ? "other numbers of " + job.unit() : difference),
              {(folder.path() / "job.json").string()});
}

void hold_to_memory(std::size_t megabytes) {
  const std::size_t wanted = 1'000'000 * (megabytes > 0 ? megabytes : memory_here_mb());
  struct rlimit most {};
  ::getrlimit(RLIMIT_DATA, &most);
  most.rlim_cur = std::min<rlim_t>(most.rlim_max, wanted);
  ::setrlimit(RLIMIT_DATA, &most);
}

ShardRecord do_shard(const JobFolder &folder, jobs::RangedJob &job, std::size_t index,
                     const jobs::Monitor &monitor) {
  ShardRecord out;
  out.index = index;
  if (const auto there = folder.find(index)) {
    out.status = ShardRecord::Status::There;
    out.file = there->name;
    return out;
  }
  const auto begin = std::chrono::steady_clock::now();
  const double cpu = cpu_seconds();
  auto done = Result<void>();
  try {
    done = fill(folder, job, monitor, out);
  } catch (const std::bad_alloc &) {
    out.status = ShardRecord::Status::Exhausted;
    out.code = static_cast<int>(ErrorCode::Device);
    out.message = out_of_memory();
  } catch (const Failure &lost) { // a card: the worker lives on and says so
    done = tl::unexpected(lost.error());
  }
  out.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  out.cpu_s = cpu_seconds() - cpu;
  if (!done) {
    out.status = ShardRecord::Status::Failed;
    out.code = static_cast<int>(done.error().code);
    out.message = done.error().text();
  }
  return out;
}

} // namespace umov::scale
